// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// Kinds of files: those that can be read, and those that are known by name only, so that they can
// be refused by it.

namespace mc::source {

enum class Format : std::uint8_t {
  raw,
  nrrd,
  vdb,
  spec,
  exr,
  meta,
  nifti,
  dicom,
  tiff,
  png,
  mesh,
};

/// "OpenEXR", "DICOM": as messages call it.
[[nodiscard]] std::string_view display_name(Format format);
/// Whether this version reads volumes of that kind.
[[nodiscard]] bool is_readable(Format format);

/// What `--from` calls it. nullopt: no such name.
[[nodiscard]] std::optional<Format> format_named(std::string_view name);
/// What the file's bytes say; never raw. nullopt: nothing.
[[nodiscard]] std::optional<Format> format_of_content(std::string_view bytes);
/// What the extension says, given in lower case without its dot. nullopt: nothing.
[[nodiscard]] std::optional<Format> format_of_extension(std::string_view extension);

}  // namespace mc::source
