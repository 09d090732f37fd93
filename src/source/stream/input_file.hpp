// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "source/stream/byte_stream.hpp"
#include "source/stream/unpack.hpp"

// A file, pipe or device that has been opened, and looked at, but not read.

namespace mc::source {

class InputFile {
 public:
  /// What is packed is unpacked as it is read, or taken as it is stored.
  enum class Bytes : std::uint8_t { unpacked, stored };

  /// "-" is stdin. Errors   input: missing, a folder, unreadable, empty.
  explicit InputFile(const std::string& path, Bytes bytes = Bytes::unpacked);

  /// How messages name it: the path, or "<stdin>".
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] bool is_stdin() const { return is_stdin_; }
  [[nodiscard]] Packing packing() const { return packing_; }
  /// Whether its bytes, as they are read, lie in a file and can be mapped.
  [[nodiscard]] bool mappable() const { return whole_file_ && packing_ == Packing::none; }
  /// Of a file, as it is stored; 0: not known.
  [[nodiscard]] std::uint64_t stored_bytes() const { return stored_bytes_; }

  /// Its first n bytes, fewer where it has not so many.
  [[nodiscard]] std::string_view head(std::size_t n) { return stream_->peek(n); }

  /// For who reads to the end. Errors   input: it is a device, which may have none.
  void refuse_device() const;

  /// All of its bytes, in order.
  [[nodiscard]] std::unique_ptr<ByteStream> stream() && { return std::move(stream_); }
  /// The file to map. Precondition: mappable().
  [[nodiscard]] Descriptor descriptor() && { return stored_->release(); }

 private:
  std::string place_;
  bool is_stdin_ = false, whole_file_ = false, is_device_ = false;
  std::uint64_t stored_bytes_ = 0;
  Packing packing_ = Packing::none;
  DescriptorStream* stored_ = nullptr;  ///< below stream_
  std::unique_ptr<PeekStream> stream_;
};

}  // namespace mc::source
