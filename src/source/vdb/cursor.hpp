// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "mc/base.hpp"

// Walking the bytes of a VDB file. No length in it is believed before the bytes are there.

namespace mc::source {

[[noreturn]] inline void damaged_vdb(std::string_view place, std::string_view what) {
  throw Error(ErrorKind::input, place, fmt::format("damaged VDB file: {}", what),
              "fetch or write the file again");
}

/// The number at the beginning of `bytes`, which need not be aligned.
template <class T>
T number_at(const std::byte* bytes) {
  static_assert(std::endian::native == std::endian::little, "VDB files are little-endian");
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// A position in a file's bytes that cannot leave them.
class VdbCursor {
 public:
  VdbCursor(std::span<const std::byte> bytes, std::size_t at, std::string_view place)
      : bytes_(bytes), at_(at), place_(place) {}

  /// Errors   input: the file ends before.
  std::span<const std::byte> take(std::size_t n_bytes, std::string_view what) {
    if (at_ > bytes_.size() || n_bytes > bytes_.size() - at_) {
      throw Error(ErrorKind::input, place_,
                  fmt::format("cut off after {} bytes, within {}", bytes_.size(), what),
                  "fetch or write the file again");
    }
    const std::span<const std::byte> taken = bytes_.subspan(at_, n_bytes);
    at_ += n_bytes;
    return taken;
  }
  template <class T>
  T number(std::string_view what) {
    return number_at<T>(take(sizeof(T), what).data());
  }
  /// A 32-bit length and as many bytes.
  std::string text(std::string_view what) {
    const auto length = number<std::uint32_t>(what);
    const std::span<const std::byte> bytes = take(length, what);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::string_view place() const { return place_; }
  void move_to(std::size_t at) { at_ = at; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_;
  std::string_view place_;
};

}  // namespace mc::source
