// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "mc/convert.hpp"

// Hands out the chunks of an edited surface: as GLB files in a folder, or to an observer.

namespace mc::conversion {

/// What chunks are written as: a format that can be written to memory.
[[nodiscard]] const SinkFormat& chunk_format();

/// How the surface is made in chunks of GLB: one origin, frame and unit for all of them, those that
/// convert() would give a GLB of the volume as it was opened.
/// Errors   limit, usage: positions that cannot be told apart.
ChunkOptions chunk_options(const ConvertOptions& base, std::int32_t n_cells, const Source& source,
                           const Surface& surface);

class ChunkWriter {
 public:
  /// Keeps references to `output`, `store` and `observer`. Errors   output: the folder is missing
  /// or has chunks already (without options.sink.force).
  ChunkWriter(const ChunkOutput& output, const ConvertOptions& base, const Source& source,
              const Surface& surface, const EditStore& store, ScriptObserver& observer);

  /// Every chunk that has a surface. Removes files of chunks that have none.
  ChunkChanges write_all();
  /// Those that changed with the samples in the boxes.
  ChunkChanges write_changes(std::span<const IndexBox> dirty, std::uint64_t record);
  /// Of each of the store's attributes: vertices of all chunks so far whose value was clamped.
  [[nodiscard]] const std::vector<std::uint64_t>& n_clamped() const { return n_clamped_; }

 private:
  void look_at_folder(bool force);
  void take(const SurfaceChunk& chunk, std::uint64_t record, ChunkChanges& changes);
  std::uint64_t write_file(const SurfaceChunk& chunk, const std::string& name);
  std::uint64_t hand_out(const SurfaceChunk& chunk, std::uint64_t record);
  void put(const SurfaceChunk& chunk, const std::string& path, const SinkOptions& to) const;
  void remove(const std::string& name) const;
  [[nodiscard]] std::string path_of(const std::string& name) const;

  const ChunkOutput& output_;
  ScriptObserver& observer_;
  ChunkOptions options_;
  SinkOptions sink_;
  ChunkMesher mesher_;
  std::map<Index3, std::uint64_t> hashes_;  // of the chunks that exist
  std::set<std::string> found_;  // files that another run left, until all chunks are written
  Buffer<std::byte> glb_;        // on its way to the observer
  std::vector<std::uint64_t> n_clamped_;
};

}  // namespace mc::conversion
