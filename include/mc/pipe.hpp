// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>

#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"

// Drives a volume through the engine into a sink, slab by slab.

namespace mc {

/// Whether exact counts come before the mesh, at the price of one more read of the scalars.
enum class CountFirst : std::uint8_t {
  no,
  yes,
  if_large,  ///< where a sixteenth of the slabs says that a sink would rather not spool the faces
};

struct RunOptions {
  ExtractOptions extract;
  std::optional<Affine> to_world;  ///< instead of the volume's own
  MeshObject object;  ///< counts are filled in by the run where it makes a counting pass
  std::uint64_t memory_bytes = 1ULL << 30;  ///< the run's own buffers stay within it
  std::int32_t slab_layers = 0;             ///< cell layers a task; 0: chosen from the plane's size
  std::uint64_t chunk_bytes = 0;            ///< a chunk at most; 0: chosen from memory_bytes
  CountFirst count_first = CountFirst::no;  ///< no, where the reader reads once
  bool skip = true;     ///< let the reader leave out samples far from the surface; same mesh
  Formatted formatted;  ///< MeshNeeds::formatted of the sink
};

/// What a run of these options over this volume will hold at most, in bytes, without mapped input.
/// Sparse: the index and the layers' classification. Chunks are estimated, white noise aside.
std::uint64_t memory_needed(const VolumeReader& reader, const RunOptions& options);

/// Refuses, before anything is read, a dense run that cannot keep its budget. What a sparse run
/// needs shows when it is planned, in run(). Errors   limit.
void check_memory(const VolumeReader& reader, const RunOptions& options);

/// Extracts one iso of `reader` into `sink`: begin_object, chunks in order, end_object.
/// The sink is not touched until the first triangle exists; `allow_empty` hands it an empty object.
/// Errors   empty: no surface (unless allow_empty); limit: memory; those of reader and sink.
/// Threads  uses the caller's arena; what the sink receives does not depend on the thread count or
///          slab thickness but for where chunks are cut.
/// Cancel   looked at once a slab; throws Cancelled.
MeshTotals run(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
               MeshSink& sink, Progress& progress, const std::stop_token& stop);

}  // namespace mc
