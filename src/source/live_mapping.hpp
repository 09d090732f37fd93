// SPDX-License-Identifier: MIT
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <span>
#include <string>

#include "mc/base.hpp"

// Files that are mapped, and what becomes of them meanwhile: InputWatch and recover_input() of
// mc/source.hpp look at these.

namespace mc::source {

/// The fault of a file that ends before bytes that were there when it was opened.
[[nodiscard]] Error became_shorter(const std::string& place);

/// Notes a mapping from here to its end. What changes under it is found out then at the latest.
class LiveMapping {
 public:
  struct Entry;

  LiveMapping() = default;
  /// `bytes` are mapped from the file that `status` tells of; `place` is its path, or "<stdin>".
  LiveMapping(std::span<const std::byte> bytes, const struct stat& status,
              const std::string& place);
  ~LiveMapping();
  LiveMapping(LiveMapping&& other) noexcept;
  LiveMapping& operator=(LiveMapping&& other) noexcept;
  LiveMapping(const LiveMapping&) = delete;
  LiveMapping& operator=(const LiveMapping&) = delete;

 private:
  Entry* entry_ = nullptr;
};

}  // namespace mc::source
