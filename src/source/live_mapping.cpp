// SPDX-License-Identifier: MIT
#include "source/live_mapping.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>
#include <mutex>
#include <optional>
#include <utility>

#include "mc/base.hpp"
#include "mc/host.hpp"

// The list of mappings only grows, and entries are used again, so that a signal handler can walk it
// at any time. A page whose bytes are gone is replaced by zeros, with all behind it: the reader
// goes on over them, and who wants to keep its result asks an InputWatch first.

namespace mc {

struct InputWatch::State {
  std::optional<Error> past_fault;  // of a file that is closed
  State* outer = nullptr;
};

namespace source {

struct LiveMapping::Entry {
  std::atomic<std::uintptr_t> begin{0};  // 0: not in use
  std::atomic<std::uintptr_t> end{0};
  std::atomic<bool> lost{false};
  Entry* next = nullptr;
  InputWatch::State* watch = nullptr;
  std::string place;
  struct stat status {};

  [[nodiscard]] std::optional<Error> fault() const;
};

namespace {

using Entry = LiveMapping::Entry;

std::atomic<Entry*> first{nullptr};
std::mutex list_mutex;  // of who adds, removes or looks through; the handler does not ask
thread_local InputWatch::State* innermost = nullptr;

constexpr std::string_view kRemedy = "run again when nothing writes to it";

Entry* free_entry() {
  for (Entry* entry = first; entry != nullptr; entry = entry->next) {
    if (entry->begin == 0) return entry;
  }
  auto* made = new Entry;
  made->next = first;
  first = made;
  return made;
}

}  // namespace

Error became_shorter(const std::string& place) {
  return {ErrorKind::input, place, "became shorter while it was read", kRemedy};
}

std::optional<Error> LiveMapping::Entry::fault() const {
  if (lost) {
    return became_shorter(place);
  }
  struct stat now {};
  const char* const path = place == "<stdin>" ? "/dev/stdin" : place.c_str();
  const bool there = status.st_nlink > 0 && ::stat(path, &now) == 0 &&
                     now.st_dev == status.st_dev && now.st_ino == status.st_ino;
  if (there && (now.st_size != status.st_size || now.st_mtim.tv_sec != status.st_mtim.tv_sec ||
                now.st_mtim.tv_nsec != status.st_mtim.tv_nsec)) {
    return Error(ErrorKind::input, place, "changed while it was read", kRemedy);
  }
  return std::nullopt;
}

LiveMapping::LiveMapping(std::span<const std::byte> bytes, const struct stat& status,
                         const std::string& place) {
  const std::lock_guard lock(list_mutex);
  entry_ = free_entry();
  entry_->place = place;
  entry_->status = status;
  entry_->watch = innermost;
  entry_->lost = false;
  entry_->end = reinterpret_cast<std::uintptr_t>(bytes.data()) + bytes.size();
  entry_->begin = reinterpret_cast<std::uintptr_t>(bytes.data());
}

LiveMapping::~LiveMapping() {
  if (entry_ == nullptr) return;
  const std::lock_guard lock(list_mutex);
  if (entry_->watch != nullptr && !entry_->watch->past_fault) {
    entry_->watch->past_fault = entry_->fault();
  }
  entry_->begin = 0;
}

LiveMapping::LiveMapping(LiveMapping&& other) noexcept
    : entry_(std::exchange(other.entry_, nullptr)) {}

LiveMapping& LiveMapping::operator=(LiveMapping&& other) noexcept {
  std::swap(entry_, other.entry_);
  return *this;
}

}  // namespace source

namespace {

void refuse_changed(const InputWatch::State& watch) {
  const std::lock_guard lock(source::list_mutex);
  if (watch.past_fault) throw Error(*watch.past_fault);
  for (const auto* entry = source::first.load(); entry != nullptr; entry = entry->next) {
    if (entry->begin == 0 || entry->watch != &watch) continue;
    if (const auto fault = entry->fault()) throw Error(*fault);
  }
}

}  // namespace

InputWatch::InputWatch() : state_(std::make_unique<State>()) {
  state_->outer = std::exchange(source::innermost, state_.get());
}

InputWatch::~InputWatch() {
  source::innermost = state_->outer;
  const std::lock_guard lock(source::list_mutex);
  for (auto* entry = source::first.load(); entry != nullptr; entry = entry->next) {
    if (entry->watch == state_.get()) entry->watch = nullptr;
  }
}

void InputWatch::refuse_changed() const { mc::refuse_changed(*state_); }

void refuse_changed_inputs() {
  if (source::innermost != nullptr) refuse_changed(*source::innermost);
}

bool recover_input(const void* address) noexcept {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  for (auto* entry = source::first.load(); entry != nullptr; entry = entry->next) {
    if (entry->begin == 0 || at < entry->begin || at >= entry->end) continue;
    const auto page_size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const std::uintptr_t page = at / page_size * page_size;
    entry->lost = true;
    return ::mmap(reinterpret_cast<void*>(page), entry->end - page, PROT_READ,
                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0) != MAP_FAILED;
  }
  return false;
}

}  // namespace mc
