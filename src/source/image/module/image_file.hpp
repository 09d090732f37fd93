// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mc/field.hpp"

// What stands between mc and the libraries that read pictures. They are loaded when a picture is
// read: what needs them is a module. Only this header is seen from both sides.

namespace mc::source {

/// One number a pixel, in the type its samples are handed out in.
struct ImageChannel {
  std::string name;
  SampleType type = SampleType::u8;
};

/// What mc writes into a slice of a volume. The volume's map is that of this slice: it takes
/// (i, j, 0) to the world, j counted from the bottom row.
struct SliceNote {
  Volume volume;
  std::int32_t index = 0;  ///< of the slice, from 0
  std::int32_t count = 0;  ///< slices in all
};

/// One picture; a file may hold several.
struct ImagePart {
  std::string name;
  std::int32_t width = 0;
  std::int32_t height = 0;
  /// Of its lower left pixel from that of the window it is shown in; right and up.
  std::array<std::int64_t, 2> offset{};
  std::vector<ImageChannel> channels;  ///< never empty
  std::optional<SliceNote> note;
};

class ImageFile {
 public:
  virtual ~ImageFile() = default;
  [[nodiscard]] virtual const std::vector<ImagePart>& parts() const = 0;
  /// Writes one channel in native byte order. Row r, counted from the top, starts at
  /// out + r * row_stride_bytes, which may be negative.
  /// Errors   input: damaged or cut off. Threads  may be called from several threads at once.
  virtual void read(std::size_t part, std::size_t channel, std::byte* out,
                    std::ptrdiff_t row_stride_bytes) const = 0;
};

enum class ImageKind : std::uint8_t { png, exr };

/// What the module exports, by the name kOpenImageSymbol. The bytes must outlive what is returned;
/// `place` names them in messages. Precondition: built with that kind.
/// Errors   input: not such a file, damaged, or of a kind that is not read; limit: too large. Sizes
///          that the bytes claim are held against their number before memory is taken.
using OpenImage = ImageFile* (*)(ImageKind kind, const std::string& place,
                                 std::span<const std::byte> bytes);
inline constexpr const char* kOpenImageSymbol = "mc_open_image";

/// The readers behind it.
ImageFile* open_png(const std::string& place, std::span<const std::byte> bytes);
ImageFile* open_exr(const std::string& place, std::span<const std::byte> bytes);

}  // namespace mc::source

extern "C" mc::source::ImageFile* mc_open_image(mc::source::ImageKind kind,
                                                const std::string& place,
                                                std::span<const std::byte> bytes);
