// SPDX-License-Identifier: MIT
#include "source/stream/unpack.hpp"

// gzip (RFC 1952) by zlib, member after member.

#if MC_WITH_GZIP

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

#include "mc/base.hpp"
#include "source/stream/packed_bytes.hpp"

namespace mc::source {

namespace {

class GzipStream final : public ByteStream {
 public:
  GzipStream(std::unique_ptr<ByteStream> packed, std::string place)
      : packed_(std::move(packed)), place_(std::move(place)) {
    constexpr int kGzipOnly = 16;
    if (::inflateInit2(&state_, kGzipOnly + MAX_WBITS) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~GzipStream() override { ::inflateEnd(&state_); }
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  std::size_t read(std::span<std::byte> out) override {
    std::size_t n = 0;
    while (n < out.size() && !(between_ && !next_member())) {
      n += inflate_some(out.subspan(n));
    }
    return n;
  }

 private:
  [[noreturn]] void damaged(std::string_view fault) const {
    throw Error(ErrorKind::input, place_, "damaged gzip data: " + std::string(fault),
                "the file is cut off or was changed");
  }

  /// Whether another member follows. Zeros may fill up the last block of a device.
  bool next_member() {
    std::span<std::byte> ahead = packed_.ahead();
    while (!first_ && !ahead.empty() && ahead.front() == std::byte{0}) {
      const auto zeros = std::ranges::find_if(ahead, [](std::byte b) { return b != std::byte{0}; });
      packed_.use(static_cast<std::size_t>(zeros - ahead.begin()));
      ahead = packed_.ahead();
      zeros_ = true;
    }
    if (ahead.empty()) {
      return false;
    }
    if (zeros_) {
      damaged("more follows the padding after its end");
    }
    ::inflateReset(&state_);
    between_ = first_ = false;
    return true;
  }

  std::size_t inflate_some(std::span<std::byte> out) {
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    const std::span<std::byte> in = packed_.ahead();
    if (in.empty()) {
      damaged("it ends early");
    }
    state_.next_in = reinterpret_cast<Bytef*>(in.data());
    state_.avail_in = static_cast<uInt>(in.size());
    state_.next_out = reinterpret_cast<Bytef*>(out.data());
    const std::size_t room = std::min(out.size(), kMost);
    state_.avail_out = static_cast<uInt>(room);
    const int result = ::inflate(&state_, Z_NO_FLUSH);
    packed_.use(in.size() - state_.avail_in);
    if (result == Z_MEM_ERROR) {
      throw std::bad_alloc();
    }
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) {
      damaged(state_.msg != nullptr ? state_.msg : "it cannot be unpacked");
    }
    between_ = result == Z_STREAM_END;
    return room - state_.avail_out;
  }

  PackedBytes packed_;
  std::string place_;
  z_stream state_{};
  bool between_ = true;  ///< members
  bool first_ = true;
  bool zeros_ = false;  ///< follow the last member
};

}  // namespace

std::unique_ptr<ByteStream> unpacked_gzip(std::unique_ptr<ByteStream> packed, std::string place) {
  return std::make_unique<GzipStream>(std::move(packed), std::move(place));
}

}  // namespace mc::source

#endif
