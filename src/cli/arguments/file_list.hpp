// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mc::cli {

/// Appends the names that a file lists, "-" being stdin: one a line, or each ended by NUL. Empty
/// ones are passed over.
/// Errors   input: it cannot be read; usage: it names nothing, or holds NUL where lines are meant.
void append_listed(const std::string& path, bool end_in_nul, std::vector<std::string>& names);

}  // namespace mc::cli
