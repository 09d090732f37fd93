// SPDX-License-Identifier: MIT
#include "base/module.hpp"

#include <dlfcn.h>
#include <sys/mman.h>

#include <cstddef>
#include <new>

// Modules: what needs a library that is slow to load, loaded by the runs that need it.

namespace mc::base {

namespace {

/// Whether so much address space is left. Libraries that run out of it while they are loaded end
/// the process or hang: log4cplus, which OpenVDB needs, starts threads then.
bool room_for(std::size_t n_bytes) {
  void* probe =
      ::mmap(nullptr, n_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe == MAP_FAILED) return false;
  ::munmap(probe, n_bytes);
  return true;
}

}  // namespace

void* module_symbol(const char* file, const char* symbol, std::string& why) {
  constexpr std::size_t kMostLoaded = std::size_t{160} << 20U;  // OpenVDB with threads' stacks: 120
  if (!room_for(kMostLoaded)) throw std::bad_alloc();
  void* module = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  void* found = module == nullptr ? nullptr : ::dlsym(module, symbol);
  if (found == nullptr) {
    const char* text = ::dlerror();
    why = text == nullptr ? "" : text;
  }
  return found;
}

}  // namespace mc::base
