// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "mc/source.hpp"
#include "source/image/module/image_file.hpp"

// Pictures as the slices of a volume.

namespace mc::source {

[[nodiscard]] Recognition recognise_exr(std::string_view head);
[[nodiscard]] Recognition recognise_png(std::string_view head);

/// Opens pictures as open_slices() does.
Source open_exr_slices(SourceInput& input, const SourceOptions& options, Progress& progress);
Source open_png_slices(SourceInput& input, const SourceOptions& options, Progress& progress);

inline constexpr SourceFormat kExrFormat{.name = "exr",
                                         .display = "OpenEXR",
                                         .extensions = "exr",
                                         .package = "libopenexr-dev",
                                         .built_in = MC_WITH_EXR != 0,
                                         .recognise = recognise_exr,
                                         .takes = {.channel = true},
                                         .several_files = true,
                                         .open = open_exr_slices};

inline constexpr SourceFormat kPngFormat{.name = "png",
                                         .display = "PNG",
                                         .extensions = "png",
                                         .package = "libpng-dev",
                                         .built_in = MC_WITH_PNG != 0,
                                         .recognise = recognise_png,
                                         .takes = {.channel = true},
                                         .several_files = true,
                                         .open = open_png_slices};

/// The row of a kind of pictures.
[[nodiscard]] constexpr const SourceFormat& format_of(ImageKind kind) {
  return kind == ImageKind::exr ? kExrFormat : kPngFormat;
}
/// The kind of picture that begins with `head`. nullopt: it is none.
[[nodiscard]] std::optional<ImageKind> image_kind(std::string_view head);

}  // namespace mc::source
