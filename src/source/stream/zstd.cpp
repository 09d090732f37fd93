// SPDX-License-Identifier: MIT
#include "source/stream/unpack.hpp"

// Zstandard (RFC 8878) by libzstd, frame after frame.

#if MC_WITH_ZSTD

#include <zstd.h>
#include <zstd_errors.h>

#include <memory>
#include <new>
#include <utility>

#include "mc/base.hpp"
#include "source/stream/packed_bytes.hpp"

namespace mc::source {

namespace {

/// Windows of at most 128 MiB, which are all that `zstd` makes without --long or --ultra.
constexpr int kMostWindowLog = 27;

struct FreeContext {
  void operator()(ZSTD_DCtx* context) const { ::ZSTD_freeDCtx(context); }
};

class ZstdStream final : public ByteStream {
 public:
  ZstdStream(std::unique_ptr<ByteStream> packed, std::string place)
      : packed_(std::move(packed)), place_(std::move(place)), context_(::ZSTD_createDCtx()) {
    if (!context_) {
      throw std::bad_alloc();
    }
    ::ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMostWindowLog);
  }

  std::size_t read(std::span<std::byte> out) override {
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    while (to.pos < to.size) {
      const std::span<std::byte> ahead = packed_.ahead();
      if (ahead.empty() && between_) break;
      ZSTD_inBuffer from{ahead.data(), ahead.size(), 0};
      const std::size_t before = to.pos;
      const std::size_t hint = ::ZSTD_decompressStream(context_.get(), &to, &from);
      if (::ZSTD_isError(hint) != 0U) {
        fail(hint);
      }
      packed_.use(from.pos);
      between_ = hint == 0;
      if (ahead.empty() && to.pos == before) {
        damaged("it ends early");
      }
    }
    return to.pos;
  }

 private:
  [[noreturn]] void damaged(std::string_view fault) const {
    throw Error(ErrorKind::input, place_, "damaged zstd data: " + std::string(fault),
                "the file is cut off or was changed");
  }
  [[noreturn]] void fail(std::size_t result) const {
    switch (::ZSTD_getErrorCode(result)) {
      case ZSTD_error_memory_allocation:
        throw std::bad_alloc();
      case ZSTD_error_frameParameter_windowTooLarge:
        throw Error(ErrorKind::input, place_,
                    "packed by zstd with a window of more than 128 MiB, too much to unpack",
                    "unpack it first, or pack it without --long and --ultra");
      default:
        damaged(::ZSTD_getErrorName(result));
    }
  }

  PackedBytes packed_;
  std::string place_;
  std::unique_ptr<ZSTD_DCtx, FreeContext> context_;
  bool between_ = true;  ///< frames
};

}  // namespace

std::unique_ptr<ByteStream> unpacked_zstd(std::unique_ptr<ByteStream> packed, std::string place) {
  return std::make_unique<ZstdStream>(std::move(packed), std::move(place));
}

}  // namespace mc::source

#endif
