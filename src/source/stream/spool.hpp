// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "mc/base.hpp"
#include "source/stream/byte_stream.hpp"

// Copies on disk of what can be read only once.

namespace mc::source {

/// An unlinked file in $TMPDIR (/tmp): it goes when its descriptor is closed.
class Spool {
 public:
  /// Says in a detail that `place` is copied and where, `reason` behind it.
  /// Errors   output: no file can be made there.
  Spool(const std::string& place, std::string_view reason, Progress& progress);
  /// Errors   output: no room.
  void write(std::span<const std::byte> bytes);
  [[nodiscard]] Descriptor release() { return std::move(file_); }

 private:
  std::string place_;
  Progress& progress_;
  Descriptor file_;
};

/// Copies a stream up to `most_bytes` and one more, which tells that it is longer.
void copy_stream(ByteStream& stream, std::uint64_t most_bytes, Spool& spool);

}  // namespace mc::source
