// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace mc::test {

/// How often any thread has called operator new so far.
std::uint64_t n_allocations();

}  // namespace mc::test
