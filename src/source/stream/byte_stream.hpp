// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mc/source.hpp"

// Bytes that come one after the other: of a pipe, of a file, or unpacked from either.

namespace mc::source {

/// A file descriptor that is closed at the end, standard ones excepted.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// The bytes of a descriptor from where it stands. A file's offset is left where it is, so that
/// who opens stdin again finds all of it.
class DescriptorStream final : public ByteStream {
 public:
  DescriptorStream(Descriptor descriptor, std::string place);
  std::size_t read(std::span<std::byte> out) override;
  [[nodiscard]] Descriptor release() { return std::move(descriptor_); }

 private:
  Descriptor descriptor_;
  std::string place_;
  std::int64_t offset_;  ///< of a file; -1: a pipe or device
};

/// A stream whose first bytes can be looked at before they are read.
class PeekStream final : public ByteStream {
 public:
  explicit PeekStream(std::unique_ptr<ByteStream> from) : from_(std::move(from)) {}
  /// The next n bytes; fewer at the end. Valid until the next call.
  std::string_view peek(std::size_t n);
  std::size_t read(std::span<std::byte> out) override;

 private:
  std::unique_ptr<ByteStream> from_;
  std::vector<std::byte> ahead_;  ///< read, but not handed out
  std::size_t taken_ = 0;         ///< of ahead_
};

/// Passes over n bytes. Returns how many there were.
std::uint64_t pass_over(ByteStream& stream, std::uint64_t n);

}  // namespace mc::source
