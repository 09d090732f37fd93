// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"
#include "sink/image/module/encode.hpp"
#include "sink/image/series_sink.hpp"

// Pictures: single ones, and OpenEXR also as the slices of a volume.

namespace mc::sink {

std::unique_ptr<PictureSink> open_exr_picture(const std::string& path, const SinkOptions& options);
std::unique_ptr<PictureSink> open_png_picture(const std::string& path, const SinkOptions& options);

inline constexpr SinkFormat kExrFormat{.name = "exr",
                                       .display = "OpenEXR",
                                       .extensions = "exr",
                                       .package = "libopenexr-dev",
                                       .built_in = MC_WITH_EXR != 0,
                                       .open_volume = open_exr_series,
                                       .open_picture = open_exr_picture};

inline constexpr SinkFormat kPngFormat{.name = "png",
                                       .display = "PNG",
                                       .extensions = "png",
                                       .package = "libpng-dev",
                                       .built_in = MC_WITH_PNG != 0,
                                       .open_picture = open_png_picture,
                                       .greys = true};

/// The row of a kind of pictures.
[[nodiscard]] constexpr const SinkFormat& format_of(ImageKind kind) {
  return kind == ImageKind::exr ? kExrFormat : kPngFormat;
}

}  // namespace mc::sink
