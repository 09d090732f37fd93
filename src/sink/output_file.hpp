// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>

// Files that appear whole or not at all. An output is written as NAME.partial-XXXX beside its name
// and renamed by commit(); what is no regular file (a device, a FIFO, stdout) is written in place.

namespace mc::sink {

class OutputFile {
 public:
  struct Options {
    bool force = false;  ///< replace an existing file; allow binary on a terminal
    bool binary = true;
  };

  /// Opens the partial file (or the device). "-" is stdout. A symlink is followed: its target is
  /// replaced. Errors: output (exists without force, folder missing or read-only, binary to a
  /// terminal).
  OutputFile(const std::string& path, Options options);
  /// Without commit(): the partial file is removed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] bool seekable() const;
  [[nodiscard]] const std::string& place() const;
  [[nodiscard]] std::uint64_t size() const;  ///< bytes appended so far

  void append(std::span<const std::byte> bytes);
  void append(std::string_view text);
  template <class T>
  void append_array(std::span<const T> values) {
    append(std::as_bytes(values));
  }
  /// Overwrites bytes that are already there, or writes past the end. Precondition: seekable().
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Flushes, closes, renames.
  void commit();
  /// Commits several files that belong together; the one that names the others comes last.
  static void commit_all(std::initializer_list<OutputFile*> files);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// An unlinked temporary file beside an output (or in $TMPDIR when that is a stream).
class SpoolFile {
 public:
  explicit SpoolFile(const OutputFile& beside);
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  void append(std::span<const std::byte> bytes);
  [[nodiscard]] std::uint64_t size() const;
  /// All that was appended, mapped; valid until the next append.
  std::span<const std::byte> map();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mc::sink
