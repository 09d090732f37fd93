// SPDX-License-Identifier: MIT
#include "sink/partial_names.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <new>
#include <thread>

#include "mc/host.hpp"

// A map that is there from the start, since a signal may come before the first name and its handler
// must not allocate, and that is never destroyed, so that it outlives every static object.

namespace mc {

namespace {

using namespace std::chrono_literals;

std::mutex names_mutex;

/// Each name, and what is to have it again; empty: it is to be unlinked.
std::map<std::string, std::string>& names = *new std::map<std::string, std::string>();

void note(const std::string& name, const std::string& target) noexcept {
  try {
    names[name] = target;
  } catch (const std::bad_alloc&) {
    return;
  }
}

}  // namespace

namespace sink {

PartialNames::PartialNames() : lock_(names_mutex) {}

void PartialNames::add(const std::string& name) noexcept { note(name, {}); }

void PartialNames::add_former(const std::string& name, const std::string& target) noexcept {
  note(name, target);
}

void PartialNames::forget(const std::string& name) noexcept { names.erase(name); }

}  // namespace sink

void unlink_partials() noexcept {
  // A rename that the system has blocked must not keep the process from ending: nothing changes the
  // names while it is blocked. (GCC 12's ThreadSanitizer does not see try_lock_for().)
  for (int tries = 0; tries < 100 && !names_mutex.try_lock(); ++tries) {
    std::this_thread::sleep_for(1ms);
  }
  for (const auto& [name, target] : names) {
    if (!target.empty()) std::rename(name.c_str(), target.c_str());
    ::unlink(name.c_str());  // also where both were one file, which rename() leaves alone
  }
}

}  // namespace mc
