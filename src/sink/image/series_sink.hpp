// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/field.hpp"
#include "mc/sink.hpp"

namespace mc::sink {

/// One OpenEXR picture a plane: the last run of # in the file's name becomes the slice's number,
/// from 1, with zeros in front to that many digits. All appear together, or none.
/// Channel  Y, ZIP compression; samples as exr_type() says, none is rounded. The bottom row is j =
/// 0. Header   mc_to_world (m44d, of the slice), mc_slice, mc_slices, mc_name, mc_class, mc_iso,
///          mc_border, mc_frame, mc_units where the volume has them, and the provenance.
/// Errors   usage: no #, or one in a folder's name; limit: a type that OpenEXR has no room for.
/// Memory   the planes of one write(), once more; planes are packed on several threads.
std::unique_ptr<VolumeSink> open_exr_series(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
