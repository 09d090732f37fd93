// SPDX-License-Identifier: MIT
#include "sink/partial_names.hpp"

#include <unistd.h>

#include <array>
#include <climits>
#include <cstring>
#include <mutex>

#include "mc/sink.hpp"

// A fixed table: it needs no memory when a signal arrives and outlives every static object. The
// mutex is held while names are compared or copied, and by unlink_partials(), never while bytes are
// written, so a writer that is blocked cannot block the signal thread.

namespace mc {

namespace {

/// More partial files than are ever open at once; one beyond that is only removed by its owner.
constexpr std::size_t kMostPartials = 64;

std::mutex names_mutex;
std::array<std::array<char, PATH_MAX>, kMostPartials> names{};  // empty: free

/// Replaces the entry `name` by `now`; an empty `name` finds a free entry.
void replace_entry(const std::string& name, const std::string& now) noexcept {
  const std::scoped_lock lock(names_mutex);
  for (auto& entry : names) {
    if (name == entry.data()) {
      if (now.size() < entry.size()) {
        std::memcpy(entry.data(), now.c_str(), now.size() + 1);
      }
      return;
    }
  }
}

}  // namespace

namespace sink {

void register_partial(const std::string& name) noexcept { replace_entry({}, name); }
void rename_partial(const std::string& name, const std::string& now) noexcept {
  replace_entry(name, now);
}
void forget_partial(const std::string& name) noexcept { replace_entry(name, {}); }

}  // namespace sink

void unlink_partials() noexcept {
  const std::scoped_lock lock(names_mutex);
  for (auto& entry : names) {
    if (entry.front() != '\0') {
      ::unlink(entry.data());
      entry.front() = '\0';
    }
  }
}

}  // namespace mc
