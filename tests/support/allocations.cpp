// SPDX-License-Identifier: MIT
#include "support/allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

// The program's own operator new, which counts. The forms for arrays end here as well; those for no
// exceptions do by default, but not where a sanitizer brings its own.

namespace {
std::atomic<std::uint64_t> count{0};
}  // namespace

void* operator new(std::size_t n_bytes) {
  ++count;
  if (void* memory = std::malloc(n_bytes == 0 ? 1 : n_bytes)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t n_bytes, const std::nothrow_t& /*none*/) noexcept {
  ++count;
  return std::malloc(n_bytes == 0 ? 1 : n_bytes);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*n_bytes*/) noexcept { std::free(memory); }

namespace mc::test {

std::uint64_t n_allocations() { return count; }

}  // namespace mc::test
