// SPDX-License-Identifier: MIT
#pragma once

#include <string>

// The names of this process's partial files, so that a signal thread can remove them.

namespace mc::sink {

void register_partial(const std::string& name) noexcept;
void rename_partial(const std::string& name, const std::string& now) noexcept;
void forget_partial(const std::string& name) noexcept;

}  // namespace mc::sink
