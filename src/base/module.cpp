// SPDX-License-Identifier: MIT
#include "base/module.hpp"

#include <dlfcn.h>

// Modules: what needs a library that is slow to load, loaded by the runs that need it.

namespace mc::base {

void* module_symbol(const char* file, const char* symbol, std::string& why) {
  void* module = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  void* found = module == nullptr ? nullptr : ::dlsym(module, symbol);
  if (found == nullptr) {
    const char* text = ::dlerror();
    why = text == nullptr ? "" : text;
  }
  return found;
}

}  // namespace mc::base
