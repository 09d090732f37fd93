// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <string>

// What an end of the process has to take away, or to put back.

namespace mc::sink {

/// The files of this process that do not have their final names, to be changed by who holds this.
/// It is held while a file is made, renamed or unlinked, so that no signal comes between that and
/// the note of it, and never while bytes are written. Once unlink_partials() has been called, the
/// constructor waits for the end of the process: nothing is made or renamed any more.
class PartialNames {
 public:
  PartialNames();

  /// `name` is to be unlinked. Without memory to note it, only its owner will do that.
  void add(const std::string& name) noexcept;
  /// `name` is what `target` was: to be put back under it.
  void add_former(const std::string& name, const std::string& target) noexcept;
  void forget(const std::string& name) noexcept;

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace mc::sink
