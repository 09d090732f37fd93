// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mc::base {

/// What the shared object `file` exports as `symbol`; it is loaded first where it is not yet, and
/// never unloaded, which not every library bears. Looked for in the folders that the program's
/// RUNPATH names, then where the system looks for libraries. Null: it is not there, and `why` says
/// "FILE: what is wrong with it".
/// Threads  may be called from several threads at once.
[[nodiscard]] void* module_symbol(const char* file, const char* symbol, std::string& why);

}  // namespace mc::base
