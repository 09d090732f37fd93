// SPDX-License-Identifier: MIT
#include "support/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

// The program's own operator new, which counts. The forms for arrays and for no exceptions end
// here as well.

namespace {
std::atomic<std::uint64_t> count{0};
}  // namespace

void* operator new(std::size_t n_bytes) {
  ++count;
  if (void* memory = std::malloc(n_bytes == 0 ? 1 : n_bytes)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*n_bytes*/) noexcept { std::free(memory); }

namespace mc::test {

std::uint64_t n_allocations() { return count; }

}  // namespace mc::test
