// SPDX-License-Identifier: MIT
#include "source/format.hpp"

#include <algorithm>
#include <array>

#include "source/text.hpp"
#include "source/vdb/layout.hpp"

namespace mc::source {

namespace {

struct Row {
  Format format;
  std::string_view option;  ///< of --from; empty: none
  std::string_view display;
  std::string_view extensions;  ///< each between blanks
};

constexpr std::array<Row, 11> kRows{{
    {Format::raw, "raw", "raw data", " raw "},
    {Format::nrrd, "nrrd", "NRRD", " nrrd nhdr "},
    {Format::vdb, "vdb", "VDB", " vdb "},
    {Format::spec, "spec", "mc-volume", " json "},
    {Format::exr, "exr", "OpenEXR", " exr "},
    {Format::meta, "meta", "MetaImage", " mhd mha "},
    {Format::nifti, "nifti", "NIfTI", " nii "},
    {Format::dicom, "dicom", "DICOM", " dcm dicom ima "},
    {Format::tiff, "tiff", "TIFF", " tif tiff "},
    {Format::png, "png", "PNG", " png "},
    {Format::mesh, "", "a mesh as a volume", " ply obj stl gltf glb "},
}};

constexpr std::size_t kDicomMagicAt = 128;
constexpr std::size_t kNiftiMagicAt = 344;

bool has(std::string_view bytes, std::size_t at, std::string_view magic) {
  return bytes.size() >= at && bytes.substr(at, magic.size()) == magic;
}

/// Text headers of MetaImage begin with one of its keys.
bool looks_like_meta(std::string_view bytes) {
  const std::string_view line = bytes.substr(0, bytes.find('\n')).substr(0, 80);
  const std::string_view key = trimmed(line.substr(0, line.find('=')));
  return line.find('=') != std::string_view::npos &&
         (key == "ObjectType" || key == "NDims" || key == "Comment");
}

bool looks_like_tiff(std::string_view bytes) {
  return has(bytes, 0, {"II*\0", 4}) || has(bytes, 0, {"MM\0*", 4}) ||
         has(bytes, 0, {"II+\0", 4}) || has(bytes, 0, {"MM\0+", 4});
}

}  // namespace

std::string_view display_name(Format format) {
  return kRows[static_cast<std::size_t>(format)].display;
}

bool is_readable(Format format) { return format <= Format::exr || format == Format::png; }

std::optional<Format> format_named(std::string_view name) {
  const auto* row = std::ranges::find(kRows, name, &Row::option);
  return row == kRows.end() || name.empty() ? std::nullopt : std::optional(row->format);
}

std::optional<Format> format_of_content(std::string_view bytes) {
  if (looks_like_vdb(bytes)) return Format::vdb;
  if (has(bytes, 0, "NRRD000")) return Format::nrrd;
  if (has(bytes, kDicomMagicAt, "DICM")) return Format::dicom;
  if (has(bytes, kNiftiMagicAt, {"n+1\0", 4}) || has(bytes, kNiftiMagicAt, {"ni1\0", 4})) {
    return Format::nifti;
  }
  if (has(bytes, 0, "\x76\x2f\x31\x01")) return Format::exr;
  if (has(bytes, 0, "\x89PNG\r\n\x1a\n")) return Format::png;
  if (looks_like_tiff(bytes)) return Format::tiff;
  if (has(bytes, 0, "ply\n") || has(bytes, 0, "ply\r\n") || has(bytes, 0, "glTF")) {
    return Format::mesh;
  }
  if (looks_like_meta(bytes)) return Format::meta;
  return std::nullopt;
}

std::optional<Format> format_of_extension(std::string_view extension) {
  for (const Row& row : kRows) {
    if (!extension.empty() &&
        row.extensions.find(" " + std::string(extension) + " ") != std::string_view::npos) {
      return row.format;
    }
  }
  return std::nullopt;
}

}  // namespace mc::source
