// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mc::cli {

/// The whole program: from its words (without its own name) to its exit status.
int run_program(const std::vector<std::string>& words);

}  // namespace mc::cli
