// SPDX-License-Identifier: MIT
#include "base/machine_memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>

// Control groups of both versions: v2 has one line "0::/path" and `memory.max`, v1 one line for
// each controller and `memory.limit_in_bytes`. A group is bound by those above it. In a container
// the path may be one of the host's, which is not there: then its root is looked at.

namespace mc::base {

namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMostBudget = 1U << 30U;

/// The number in a file; no limit where there is no file or another word ("max").
std::uint64_t limit_in(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t bytes = 0;
  return file >> bytes ? bytes : kNoLimit;
}

/// The least limit from a group up to the root.
std::uint64_t limit_up_from(const std::string& root, std::string group, const std::string& name) {
  const std::string file = "/" + name;
  std::uint64_t least = limit_in(root + file);
  while (!group.empty() && group != "/") {
    least = std::min(least, limit_in(std::string(root).append(group).append(file)));
    group.resize(group.rfind('/'));
  }
  return least;
}

std::string text_of(const char* path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::uint64_t group_limit_bytes(std::string_view groups, const std::string& root) {
  std::uint64_t least = kNoLimit;
  while (!groups.empty()) {
    const std::string_view line = groups.substr(0, groups.find('\n'));
    groups.remove_prefix(std::min(groups.size(), line.size() + 1));
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string_view::npos || line.substr(second + 1, 1) != "/") continue;
    const std::string_view controllers = line.substr(first + 1, second - first - 1);
    const std::string group(line.substr(second + 1));
    if (controllers.empty()) {
      least = std::min(least, limit_up_from(root, group, "memory.max"));
    } else if (("," + std::string(controllers) + ",").find(",memory,") != std::string::npos) {
      least = std::min(least, limit_up_from(root + "/memory", group, "memory.limit_in_bytes"));
    }
  }
  return least;
}

std::uint64_t machine_bytes() {
  const std::uint64_t installed = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                  static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min(installed, group_limit_bytes(text_of("/proc/self/cgroup"), "/sys/fs/cgroup"));
}

std::uint64_t available_bytes() {
  std::ifstream file("/proc/meminfo");
  for (std::string key, rest; file >> key; std::getline(file, rest)) {
    std::uint64_t kibibytes = 0;
    if (key == "MemAvailable:" && file >> kibibytes) return kibibytes * 1024;
  }
  return machine_bytes();
}

std::uint64_t default_budget_bytes() { return std::min(kMostBudget, machine_bytes() / 4); }

std::uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t size = 0, resident = 0, of_files = 0;
  if (!(file >> size >> resident >> of_files)) return 0;
  return (resident - of_files) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string size_text(std::uint64_t n_bytes) {
  static constexpr std::array<std::string_view, 5> kNames{"B", "KiB", "MiB", "GiB", "TiB"};
  auto amount = static_cast<double>(n_bytes);
  std::size_t unit = 0;
  while (amount >= 1024 && unit + 1 < kNames.size()) {
    amount /= 1024;
    ++unit;
  }
  return unit == 0 ? fmt::format("{} B", n_bytes) : fmt::format("{:.1f} {}", amount, kNames[unit]);
}

}  // namespace mc::base
