// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/field.hpp"
#include "mc/sink.hpp"

namespace mc::sink {

/// One grid in a VDB file with offsets, as Houdini and Blender open it.
/// Types    f32, f16 (saved as half, which is lossless): float; f64: double; u8, i8, u16, i16, i32:
///          int32; u32, i64: int64; u8 of class mask: bool. Every sample is held exactly.
/// Dense    all samples of the box are active, equal ones are pruned to tiles. Outside is the
///          background, which is not solid at any iso between the least and the greatest sample:
///          for level sets and signed distances the greatest sample, at least one cell; for all
///          else the least sample, at most 0. Memory: the tree.
/// Sparse   leaves, tiles and active masks are written as they are, nothing is pruned.
/// Metadata class (a signed distance is a level set where its iso is 0) and name ("surface" or
///          "density" where a dense volume has none); `mc_class` where OpenVDB has no word for it,
///          `mc_iso`, `mc_border`, `mc_frame`, `mc_units` where the volume has them. Provenance is
///          metadata of the file.
/// Bytes    the same for the same volume: the file's UUID is a hash of the rest.
/// Errors   usage: built without OpenVDB; output: a map that cannot be inverted.
std::unique_ptr<VolumeSink> open_vdb(const std::string& path, const SinkOptions& options);

inline constexpr SinkFormat kVdbFormat{.name = "vdb",
                                       .display = "VDB",
                                       .extensions = "vdb",
                                       .package = "libopenvdb-dev",
                                       .built_in = MC_WITH_VDB != 0,
                                       .open_volume = open_vdb};

}  // namespace mc::sink
