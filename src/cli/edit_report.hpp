// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mc/edit.hpp"
#include "mc/extract.hpp"
#include "mc/mesh.hpp"
#include "mc/pipe.hpp"

// What `mc edit` says in JSON: a line for each record of the script, one for each output (see
// report.hpp), and one at the end.

namespace mc::cli {

/// A chunk of the surface that is new or other than before.
struct ChunkUpdate {
  Index3 id{};
  std::string file;  ///< in the folder; empty where it was sent to stdout
  std::uint64_t n_bytes = 0;
  std::uint64_t n_vertices = 0, n_triangles = 0;
  Bounds bounds;  ///< in the GLB's scene
};

struct ChunkChanges {
  std::vector<Index3> removed;  ///< chunks whose surface is gone
  std::vector<ChunkUpdate> updated;
  ChunkSums sums;  ///< of all chunks there are
};

/// One record, done.
struct RecordReport {
  std::uint64_t number = 0;
  std::string op;
  bool is_state = false;                ///< no record: the chunks at the start, or at the end
  EditEffect effect{};                  ///< of a group, its edits' together
  Bounds bounds{};                      ///< of what was touched, in the script's space
  std::optional<std::size_t> count{};   ///< undo, redo: steps
  std::optional<std::string> output{};  ///< write
  std::optional<ChunkChanges> chunks{};
  std::optional<std::uint64_t> n_reached{};  ///< dry run: chunks that the box reaches
  double seconds = 0;  ///< from the record's arrival until its chunks were handed out
};

struct EditTotals {
  int status = 0;
  std::optional<std::string> error;
  std::string input;
  double iso = 0;
  Inside inside = Inside::above;
  bool index_space = false;
  std::uint64_t n_records = 0;
  std::uint64_t n_edits = 0;    ///< of groups each
  std::uint64_t n_outside = 0;  ///< edits that lay wholly outside
  std::uint64_t n_changed = 0;  ///< samples, each edit's counted
  std::uint64_t n_stored_blocks = 0;
  std::uint64_t stored_bytes = 0;
  std::uint64_t peak_bytes = 0;  ///< as RunReport's
  std::vector<std::string> warnings;
};

std::string to_json(const RecordReport& report);
std::string to_json(const EditTotals& totals);

}  // namespace mc::cli
