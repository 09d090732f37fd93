// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "mc/source.hpp"

// Formats of volumes that are recognised only so that they can be refused by name.

namespace mc::source {

[[nodiscard]] Recognition recognise_dicom(std::string_view head);
[[nodiscard]] Recognition recognise_nifti(std::string_view head);
[[nodiscard]] Recognition recognise_tiff(std::string_view head);
/// Text headers of MetaImage begin with one of its keys.
[[nodiscard]] Recognition recognise_meta(std::string_view head);

inline constexpr SourceFormat kDicomFormat{.name = "dicom",
                                           .display = "DICOM",
                                           .extensions = "dcm dicom ima",
                                           .recognise = recognise_dicom};

inline constexpr SourceFormat kNiftiFormat{
    .name = "nifti", .display = "NIfTI", .extensions = "nii", .recognise = recognise_nifti};

inline constexpr SourceFormat kTiffFormat{
    .name = "tiff", .display = "TIFF", .extensions = "tif tiff", .recognise = recognise_tiff};

inline constexpr SourceFormat kMetaFormat{
    .name = "meta", .display = "MetaImage", .extensions = "mhd mha", .recognise = recognise_meta};

}  // namespace mc::source
