// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/sink.hpp"

// What stands between mc and the libraries that write pictures; they are loaded when a picture is
// written. Only this header is seen from both sides.

namespace mc::sink {

enum class ImageKind : std::uint8_t { png, exr };

/// Which slice of a volume a picture is: what its header says besides the samples.
struct SliceOf {
  const Volume* volume = nullptr;  ///< null: it is a picture of its own
  std::int32_t index = 0;          ///< from 0
  std::int32_t count = 0;
};

/// What the module exports, by the name kEncodeImageSymbol: fills `out` with a whole file.
/// Provenance becomes text of the header. Precondition: built with that kind; a type that it holds:
/// PNG u8 or u16, EXR f16, f32 or u32. Errors   output: what the library says.
using EncodeImage = void (*)(ImageKind kind, const Picture& picture, const SliceOf& slice,
                             const SinkOptions& options, Buffer<std::byte>& out);
inline constexpr const char* kEncodeImageSymbol = "mc_encode_image";

/// The writers behind it.
void encode_png(const Picture& picture, const SinkOptions& options, Buffer<std::byte>& out);
void encode_exr(const Picture& picture, const SliceOf& slice, const SinkOptions& options,
                Buffer<std::byte>& out);

}  // namespace mc::sink

extern "C" void mc_encode_image(mc::sink::ImageKind kind, const mc::Picture& picture,
                                const mc::sink::SliceOf& slice, const mc::SinkOptions& options,
                                mc::Buffer<std::byte>& out);
