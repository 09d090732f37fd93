// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "source/spec/spec.hpp"

namespace mc::tests {

/// Loads one text and, where it is good and its planes are small, computes its first plane.
/// Returns whether it was good. Anything but Error(usage) comes out.
inline bool replay_spec(std::string_view text) {
  try {
    const auto reader = source::open_spec_text("fuzz.json", text);
    const Index3 dims = reader->volume().lattice.dims();
    if (std::int64_t{dims[0]} * dims[1] <= 4096) {
      Slab slab;
      reader->read(0, 1, slab);
    }
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) {
      throw;
    }
    return false;
  }
}

}  // namespace mc::tests
