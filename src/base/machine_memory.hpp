// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

// How much memory this process may have, and has.

namespace mc::base {

/// Bytes of memory that the machine has, or that control groups (containers) leave to this process.
[[nodiscard]] std::uint64_t machine_bytes();

/// What a run may take where nobody says: a GiB, or a quarter of machine_bytes() if that is less.
[[nodiscard]] std::uint64_t default_budget_bytes();

/// The least limit that control groups set. `groups` is the text of /proc/self/cgroup, `root` the
/// folder where the groups are mounted. No limit: all ones.
[[nodiscard]] std::uint64_t group_limit_bytes(std::string_view groups, const std::string& root);

/// Bytes that the system would give now without swapping; where it does not say, machine_bytes().
[[nodiscard]] std::uint64_t available_bytes();

/// "512 B", "40.0 MiB".
[[nodiscard]] std::string size_text(std::uint64_t n_bytes);

/// Bytes that are resident now, pages of files aside. 0 where the system does not say.
[[nodiscard]] std::uint64_t resident_bytes();

}  // namespace mc::base
