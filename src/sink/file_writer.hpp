// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

// A descriptor with a buffer before it: what outputs and spools are made of.

namespace mc::sink {

/// What is gathered before a write; larger pieces go straight through.
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

/// Throws Error(output; limit, where memory is wanting) "PLACE: cannot VERB: SYSTEM TEXT; REMEDY"
/// for errno as it is.
[[noreturn]] void cannot(std::string_view verb, const std::string& place,
                         std::string_view remedy = {});

class FileWriter {
 public:
  /// Owns `fd`, unless it is a standard stream. With `offsets` it writes by pwrite() at a position
  /// of its own, so that write_at() does not disturb appending. `remedy` is for who cannot write.
  FileWriter(int fd, bool offsets, std::string place, std::string_view remedy = {});
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] bool has_offsets() const { return offsets_; }
  [[nodiscard]] std::uint64_t size() const { return flushed_ + buffered_; }
  [[nodiscard]] const std::string& place() const { return place_; }

  void append(std::span<const std::byte> bytes);
  /// Appends all of `from`, which was made with `offsets`; the kernel copies where it can.
  void append_file(FileWriter& from);
  void flush();
  /// Preconditions of these: made with `offsets`.
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  /// The same from any thread, where the buffer holds nothing for these bytes' place.
  void put_at(std::uint64_t offset, std::span<const std::byte> bytes) const;
  void skip(std::uint64_t n_bytes);
  /// Takes away what lies behind `n_bytes`.
  void truncate(std::uint64_t n_bytes);
  void read(std::uint64_t offset, std::span<std::byte> bytes);
  /// The same from any thread, where nothing is left in the buffer.
  void read_flushed(std::uint64_t offset, std::span<std::byte> bytes) const;
  /// Flushes, and waits until all is on the disk, where there is one below.
  void sync();
  /// Flushes and closes; a network file system may only now say that it is full.
  void close();

 private:
  void put(std::uint64_t offset, std::span<const std::byte> bytes) const;
  [[nodiscard]] std::uint64_t copied_by_kernel(const FileWriter& from) const;

  int fd_;
  bool offsets_;
  std::string place_;
  std::string remedy_;
  std::uint64_t flushed_ = 0;            // where the buffer will go
  std::unique_ptr<std::byte[]> buffer_;  // none, or kBufferBytes
  std::size_t buffered_ = 0;
};

}  // namespace mc::sink
