// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/edit_report.hpp"
#include "cli/resolve_edit.hpp"
#include "mc/base.hpp"
#include "mc/edit.hpp"
#include "mc/pipe.hpp"
#include "mc/source.hpp"

// Hands the chunks of an edited surface to who follows: as GLB files in a folder, or as GLBs on
// stdout, each after a line that tells its length.

namespace mc::cli {

/// How the surface of `plan` is made in chunks of GLB: one origin, frame and unit for all of them,
/// those that `mc extract` would give a GLB of the volume as it was opened.
/// Errors   limit, usage: positions that cannot be told apart.
ChunkOptions chunk_options(const EditPlan& plan, const Source& source);

class ChunkEmitter {
 public:
  /// Keeps references to `plan` and `store`. Errors   output: the folder is missing or holds chunks
  /// already (without --force), stdout is a terminal.
  ChunkEmitter(const EditPlan& plan, const Source& source, const EditStore& store);

  /// Every chunk that has a surface. Removes files of chunks that have none.
  ChunkChanges emit_all();
  /// Those that changed with the samples in the boxes.
  ChunkChanges emit_changes(std::span<const IndexBox> dirty, std::uint64_t record);
  /// Vertices whose material is no number of 16 bits, in all chunks so far.
  [[nodiscard]] std::uint64_t n_materials_held() const { return n_materials_held_; }

 private:
  void look_at_folder();
  void take(const SurfaceChunk& chunk, std::uint64_t record, ChunkChanges& changes);
  std::uint64_t write_file(const SurfaceChunk& chunk, const std::string& name);
  std::uint64_t send(const SurfaceChunk& chunk, std::uint64_t record);
  void put(const SurfaceChunk& chunk, const std::string& path, const SinkOptions& to) const;
  void remove(const std::string& name) const;
  [[nodiscard]] std::string path_of(const std::string& name) const;

  const EditPlan& plan_;
  ChunkOptions options_;
  SinkOptions sink_;
  ChunkMesher mesher_;
  std::map<Index3, std::uint64_t> hashes_;  // of the chunks that there are
  std::set<std::string> found_;  // files that another run left, until all chunks are there
  Buffer<std::byte> glb_;        // on its way to stdout
  std::uint64_t n_materials_held_ = 0;
};

}  // namespace mc::cli
