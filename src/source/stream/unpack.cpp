// SPDX-License-Identifier: MIT
#include "source/stream/unpack.hpp"

#include <utility>

#include "mc/base.hpp"

namespace mc::source {

namespace {

[[noreturn, maybe_unused]] void absent(const std::string& place, std::string_view packing,
                                       std::string_view package) {
  throw Error(
      ErrorKind::input, place,
      "is packed by " + std::string(packing) + ", which this build of mc cannot unpack",
      "unpack it first, or install the package " + std::string(package) + " and build again");
}

}  // namespace

Packing packing_of(std::string_view head) {
  // The method is always 8 and the upper flags are never set (RFC 1952).
  if (head.size() >= 4 && head.starts_with("\x1f\x8b\x08") &&
      (static_cast<unsigned char>(head[3]) & 0xe0U) == 0) {
    return Packing::gzip;
  }
  return head.starts_with("\x28\xb5\x2f\xfd") ? Packing::zstd : Packing::none;  // RFC 8878
}

#if !MC_WITH_GZIP
std::unique_ptr<ByteStream> unpacked_gzip(std::unique_ptr<ByteStream> /*packed*/,
                                          std::string place) {
  absent(place, "gzip", "zlib1g-dev");
}
#endif

#if !MC_WITH_ZSTD
std::unique_ptr<ByteStream> unpacked_zstd(std::unique_ptr<ByteStream> /*packed*/,
                                          std::string place) {
  absent(place, "zstd", "libzstd-dev");
}
#endif

std::unique_ptr<ByteStream> unpacked(std::unique_ptr<ByteStream> packed, Packing packing,
                                     const std::string& place) {
  switch (packing) {
    case Packing::gzip:
      return unpacked_gzip(std::move(packed), place);
    case Packing::zstd:
      return unpacked_zstd(std::move(packed), place);
    case Packing::none:
      break;
  }
  return packed;
}

}  // namespace mc::source
