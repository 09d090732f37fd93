// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "mc/sink.hpp"

// Files that appear whole or not at all. An output is written as NAME.partial-XXXX beside its name
// and renamed by commit(); what is no regular file (a device, a FIFO, stdout) is written in place.

namespace mc::sink {

class FileWriter;

class OutputFile {
 public:
  struct Options {
    bool force = false;  ///< replace an existing file; allow binary on a terminal
    bool sync = false;   ///< commit() waits for the disk
    bool binary = true;
    Progress* progress = nullptr;         ///< is told of spools in $TMPDIR
    Buffer<std::byte>* memory = nullptr;  ///< no file is made: commit() puts the bytes there
  };

  /// Opens the partial file (or the device). "-" is stdout. A symlink is followed: its target is
  /// replaced, and keeps its permissions. Errors: output (exists without force, folder missing or
  /// read-only, binary to a terminal).
  OutputFile(const std::string& path, Options options);
  /// Without commit(): the partial file is removed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] bool seekable() const;
  [[nodiscard]] const std::string& place() const;
  [[nodiscard]] std::uint64_t size() const;  ///< bytes appended so far
  /// Where its temporary files belong: its own folder, $TMPDIR or /tmp for what is no file.
  [[nodiscard]] std::string scratch_folder() const;
  /// A spool is made in that folder: tells it once, where it is not the output's own.
  void note_spool() const;

  void append(std::span<const std::byte> bytes);
  void append(std::string_view text);
  template <class T>
  void append_array(std::span<const T> values) {
    append(std::as_bytes(values));
  }
  /// Overwrites bytes that are already there, or writes past the end, which does not move it.
  /// Precondition: seekable().
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Moves the end on by bytes that write_at() fills. Precondition: seekable().
  void skip(std::uint64_t n_bytes);
  /// What lies below, for the parts of an output.
  [[nodiscard]] FileWriter& writer();
  /// Moves the bytes from `offset` to the end up by `n_bytes`; what lies between is to be
  /// overwritten. Precondition: seekable(). Cost: reads and writes all of them once.
  void shift(std::uint64_t offset, std::uint64_t n_bytes);

  /// Flushes and closes; what is left to do is commit(). A series may be more files than a process
  /// may have open.
  void close();
  /// Flushes, closes, renames; with `sync`, its bytes are on the disk before its name is, and then
  /// that.
  void commit();
  /// Commits several files that belong together, all or none; the one that names the others comes
  /// last, with `sync` when the names of the others are on the disk.
  static void commit_all(std::span<OutputFile* const> files);
  static void commit_all(std::initializer_list<OutputFile*> files) {
    commit_all(std::span<OutputFile* const>(files.begin(), files.size()));
  }

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What the caller of a sink asked, for one of its files.
inline OutputFile::Options output_options(const SinkOptions& options, bool binary) {
  return {.force = options.force,
          .sync = options.sync,
          .binary = binary,
          .progress = options.progress,
          .memory = options.memory};
}

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
  /// Fills `bytes` with what was appended at `offset` (reading takes no address space).
  /// Precondition: offset + bytes.size() <= size().
  void read(std::uint64_t offset, std::span<std::byte> bytes);
  /// Appends all of it to `out`.
  void copy_to(OutputFile& out);
  /// What lies below, for the parts of an output.
  [[nodiscard]] FileWriter& writer();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mc::sink
