// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

// Where `--journal` goes: edits as they were made, each with hashes of the volume before and after.

namespace mc::conversion {

/// A file that grows by whole lines. What was written stays, whatever becomes of the process; a
/// line is on its way to the disk before the next edit begins.
class Journal {
 public:
  /// Makes the file and writes its header. With `sync` lines are on the disk when add() returns.
  /// Errors   output: exists and is not empty (without `force`), cannot be made.
  Journal(const std::string& path, const std::string& header, bool force, bool sync);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// `record` is one line of JSON, an object. Errors   output.
  void add(const std::string& record, std::uint64_t before, std::uint64_t after);

 private:
  void write_line(std::string line);

  std::string path_;
  int fd_ = -1;
  bool sync_ = false;
};

}  // namespace mc::conversion
