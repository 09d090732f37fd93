// SPDX-License-Identifier: MIT
#pragma once

#include "mc/base.hpp"
#include "mc/host.hpp"

namespace mc::conversion {

/// Runs `work`; where it fails because an input changed meanwhile, that becomes the error.
template <class Work>
void watching_inputs(Work&& work) {
  const InputWatch inputs;
  try {
    work();
  } catch (const Cancelled&) {
    throw;
  } catch (...) {
    inputs.refuse_changed();
    throw;
  }
}

}  // namespace mc::conversion
