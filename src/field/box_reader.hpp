// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "mc/field.hpp"

namespace mc::field {

/// What a dense reader offers besides its port if a box costs it less than the box's planes.
class BoxReader {
 public:
  virtual ~BoxReader() = default;
  /// As field::read_box(). Threads: as SlabReader::read().
  virtual void read_box(const IndexBox& box, std::span<std::byte> out) const = 0;
};

/// Copies the samples of `box` (within the volume's), x fastest, in the volume's type and byte
/// order. `out` holds them. Errors   those of SlabReader::read().
/// Cost     reading the box's planes one by one; the box alone of a BoxReader.
void read_box(const SlabReader& reader, const IndexBox& box, std::span<std::byte> out);

}  // namespace mc::field
