// SPDX-License-Identifier: MIT
#include "sink/partial_names.hpp"

#include <unistd.h>

#include <mutex>
#include <new>
#include <set>

#include "mc/sink.hpp"

// A set that is never destroyed, so that it outlives every static object. The mutex is held while
// names are looked up or changed, and by unlink_partials(), never while bytes are written: a writer
// that is blocked cannot block the signal thread.

namespace mc {

namespace {

std::mutex names_mutex;

std::set<std::string>& names() {
  static auto& all = *new std::set<std::string>();
  return all;
}

/// Without memory for a name, only its owner will remove the file.
void insert(const std::string& name) noexcept {
  try {
    names().insert(name);
  } catch (const std::bad_alloc&) {
    return;
  }
}

}  // namespace

namespace sink {

void register_partial(const std::string& name) noexcept {
  const std::scoped_lock lock(names_mutex);
  insert(name);
}

void rename_partial(const std::string& name, const std::string& now) noexcept {
  const std::scoped_lock lock(names_mutex);
  names().erase(name);
  insert(now);
}

void forget_partial(const std::string& name) noexcept {
  const std::scoped_lock lock(names_mutex);
  names().erase(name);
}

}  // namespace sink

void unlink_partials() noexcept {
  const std::scoped_lock lock(names_mutex);
  for (const std::string& name : names()) {
    ::unlink(name.c_str());
  }
  names().clear();
}

}  // namespace mc
