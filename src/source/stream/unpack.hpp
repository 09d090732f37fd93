// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "source/stream/byte_stream.hpp"

// Compressed streams, told by their first bytes and unpacked as they are read: never more in memory
// than a window of them. Members and frames that follow each other are one stream.

namespace mc::source {

enum class Packing : std::uint8_t { none, gzip, zstd };

/// What the first bytes say (kPackingBytes of them).
constexpr std::size_t kPackingBytes = 4;
[[nodiscard]] Packing packing_of(std::string_view head);

/// What `packed` unpacks to; `place` names it in errors.
/// Errors   input: this build cannot unpack it; from read(): damaged, cut off, or a zstd window of
///          more than 128 MiB.
std::unique_ptr<ByteStream> unpacked(std::unique_ptr<ByteStream> packed, Packing packing,
                                     const std::string& place);

/// Unpackers of one kind each.
std::unique_ptr<ByteStream> unpacked_gzip(std::unique_ptr<ByteStream> packed, std::string place);
std::unique_ptr<ByteStream> unpacked_zstd(std::unique_ptr<ByteStream> packed, std::string place);

}  // namespace mc::source
