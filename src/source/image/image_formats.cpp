// SPDX-License-Identifier: MIT
#include "source/image/image_formats.hpp"

#include <vector>

#include "source/image/slices.hpp"
#include "source/magic.hpp"
#include "source/source_input.hpp"

namespace mc::source {

namespace {

Source open_pictures(SourceInput& input, ImageKind kind, const SourceOptions& options,
                     Progress& progress) {
  std::vector<MappedFile> files;
  for (std::size_t n = 0; n < input.paths().size(); ++n) files.push_back(map_file(input, n));
  Source source;
  source.reader = open_slices(std::move(files), kind, options, progress);
  return source;
}

}  // namespace

Recognition recognise_exr(std::string_view head) {
  return recognised(has_magic(head, "\x76\x2f\x31\x01"));
}

Recognition recognise_png(std::string_view head) {
  return recognised(has_magic(head, "\x89PNG\r\n\x1a\n"));
}

std::optional<ImageKind> image_kind(std::string_view head) {
  if (recognise_exr(head) == Recognition::yes) return ImageKind::exr;
  if (recognise_png(head) == Recognition::yes) return ImageKind::png;
  return std::nullopt;
}

Source open_exr_slices(SourceInput& input, const SourceOptions& options, Progress& progress) {
  return open_pictures(input, ImageKind::exr, options, progress);
}

Source open_png_slices(SourceInput& input, const SourceOptions& options, Progress& progress) {
  return open_pictures(input, ImageKind::png, options, progress);
}

}  // namespace mc::source
