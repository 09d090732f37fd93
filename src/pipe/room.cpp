// SPDX-License-Identifier: MIT
#include "pipe/room.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include "base/parallel.hpp"
#include "extract/components/selection.hpp"
#include "mesh/chunk_room.hpp"
#include "process/cube_stage_list.hpp"
#include "process/stage_list.hpp"

namespace mc::pipe {

namespace {

/// Larger pieces are no faster.
constexpr std::uint64_t kMostPieceBytes = 8U << 20U;
/// Part of the memory that one piece takes where it is scarce.
constexpr std::uint64_t kPieceShare = 64;
/// Chunks that are smaller than so many pieces are not worth a thread.
constexpr std::uint64_t kPiecesAChunk = 2;

/// A buffer that moves is there with one twice as large.
constexpr std::uint64_t kMostGrowth = 3;

/// Bytes of a vertex's attributes in its chunk.
std::uint64_t attribute_bytes(const RunOptions& options) {
  std::uint64_t sum = 0;
  for (const AttributeReader* reader : options.attributes) sum += reader->info().bytes();
  return sum;
}

/// bytes * by / part, without overflow.
std::uint64_t scaled(std::uint64_t bytes, std::uint64_t by, std::uint64_t part) {
  return bytes / part * by + bytes % part * by / part;
}

/// How a chunk and what stages and the sink make of it divide their memory.
class Shares {
 public:
  explicit Shares(const RunOptions& o) : Shares(o, process::StageList(o.stages)) {}

  /// A chunk of so many bytes with what is made of it, whether it is all vertices or all triangles.
  [[nodiscard]] std::uint64_t with_made(std::uint64_t chunk_bytes) const {
    return chunk_bytes + made(chunk_bytes);
  }
  /// The same while it grows to so much: a buffer that moves is there twice, beside what was made
  /// of the chunk before.
  [[nodiscard]] std::uint64_t growing(std::uint64_t content_bytes) const {
    return content_bytes + with_made(content_bytes);
  }
  /// The largest chunk for which that is at most `bytes`.
  [[nodiscard]] std::uint64_t chunk_of(std::uint64_t bytes) const {
    return std::min(scaled(bytes, vertex_, vertex_ + made_vertex_),
                    scaled(bytes, mesh::kTriangleBytes, mesh::kTriangleBytes + made_triangle_));
  }

 private:
  Shares(const RunOptions& o, const process::StageList& stages)
      : vertex_(mesh::vertex_bytes(o.extract.precision,
                                   stages.with_normals(o.extract.normals != Normals::none))),
        made_vertex_(o.formatted.vertex_bytes + attribute_bytes(o)),
        made_triangle_(o.formatted.triangle_bytes) {
    if (!stages.need_windows()) {  // else tasks count the scratch, for windows
      made_vertex_ += stages.vertex_bytes();
      made_triangle_ += stages.triangle_bytes();
    }
  }
  [[nodiscard]] std::uint64_t made(std::uint64_t chunk_bytes) const {
    return std::max(scaled(chunk_bytes, made_vertex_, vertex_),
                    scaled(chunk_bytes, made_triangle_, mesh::kTriangleBytes));
  }
  std::uint64_t vertex_, made_vertex_, made_triangle_;
};

std::uint64_t own_budget(const TaskList& tasks, const RunOptions& options) {
  const std::uint64_t beside = memory_beside(tasks.input_bytes(), options.memory_bytes);
  return beside - std::min(beside, tasks.kept.planned);
}

std::uint64_t piece_bytes(const TaskList& tasks, std::uint64_t budget) {
  return std::max(std::min(budget / kPieceShare, kMostPieceBytes), tasks.least_chunk_bytes());
}

std::uint64_t selection_bytes(const RunOptions& options) {
  return options.extract.selection == nullptr ? 0 : options.extract.selection->bytes();
}

/// Bytes of a run beside its input.
std::uint64_t own_bytes(const TaskList& tasks, const Room& room, const RunOptions& options) {
  const Shares shares(options);
  return kProgramBytes + selection_bytes(options) +
         process::StageList(options.stages).held_bytes() +
         tasks.held_bytes(room.n_slots, room.n_makers) +
         room.n_slots * shares.with_made(room.chunk_bytes) +
         room.n_makers * shares.with_made(room.piece_bytes);
}

/// One for each of so many slots, if there can be pieces.
std::size_t n_makers(const TaskList& tasks, std::size_t n_slots) {
  return tasks.has_pieces() ? n_slots : 0;
}

/// Bytes that are enough for the chunk of a task.
std::uint64_t enough_bytes(const TaskList& tasks, const Room& room) {
  return tasks.has_pieces() ? kPiecesAChunk * room.piece_bytes : tasks.least_chunk_bytes();
}

/// Quarters of the budget to fit tasks into, from the best on: the chunks get the rest.
std::span<const std::uint64_t> quarters_held(const TaskList& tasks) {
  static constexpr std::array<std::uint64_t, 1> kOfSlabs{2};
  static constexpr std::array<std::uint64_t, 3> kOfWindows{3, 2, 1};
  if (tasks.has_pieces()) return kOfSlabs;
  return kOfWindows;
}

/// The room of so many tasks at once, whose chunks get what is left; of no bytes where there is
/// none.
Room room_of(TaskList& tasks, std::size_t n_slots, const RunOptions& options) {
  const std::uint64_t budget = own_budget(tasks, options);
  Room room{n_slots};
  room.n_makers = n_makers(tasks, n_slots);
  room.piece_bytes = piece_bytes(tasks, budget);
  const std::uint64_t fixed = own_bytes(tasks, room, options);
  if (fixed < budget) {
    room.chunk_bytes = Shares(options).chunk_of((budget - fixed) / n_slots);
  }
  return room;
}

std::string allowed(std::uint64_t bytes) {
  return bytes < 1U << 20U ? std::to_string(bytes >> 10U) + " KiB"
                           : std::to_string(bytes >> 20U) + " MiB";
}

std::string run_name(const RunOptions& options) {
  const std::string names = names_of_rereading(options);
  return names.empty() ? "this run" : "this run with " + names;
}

}  // namespace

std::string names_of_rereading(const RunOptions& options) {
  std::string names = process::StageList(options.stages).window_names();
  if (!names.empty() && !options.cube_stages.empty()) names += ", ";
  return names + process::CubeStageList(options.cube_stages).names();
}

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1U << 20U) - 1) >> 20U) + " MiB";
}

std::uint64_t least_bytes(TaskList& tasks, const RunOptions& options) {
  tasks.fit(1, 0);
  const std::uint64_t chunk = tasks.least_chunk_bytes();
  const std::uint64_t own =
      own_bytes(tasks, {1, chunk, n_makers(tasks, 1), chunk}, options) + tasks.kept.least;
  return own + std::min(own, tasks.input_bytes());
}

std::uint64_t bytes_of(const TaskList& tasks, const Room& room, std::uint64_t content_bytes,
                       const RunOptions& options) {
  const Shares shares(options);
  const std::uint64_t n_slots =
      std::min<std::uint64_t>(room.n_slots, std::max<std::size_t>(tasks.n_tasks(), 1));
  const std::uint64_t fixed = tasks.input_bytes() + kProgramBytes + selection_bytes(options) +
                              process::StageList(options.stages).held_bytes() + tasks.kept.planned +
                              tasks.held_bytes(n_slots, room.n_makers);
  const std::uint64_t growing = shares.growing(content_bytes);
  if (content_bytes < room.chunk_bytes / kMostGrowth) return fixed + n_slots * growing;
  const std::uint64_t slot = shares.with_made(room.chunk_bytes);
  return fixed + n_slots * std::min(slot, growing) +
         room.n_makers * shares.with_made(room.piece_bytes);
}

Room room_within(TaskList& tasks, const RunOptions& options) {
  if (options.chunk_bytes != 0) {
    const std::size_t n_slots = base::pipeline_slots();
    tasks.fit(n_slots, options.memory_bytes);
    return {n_slots, options.chunk_bytes, n_slots,
            std::max(options.chunk_bytes, tasks.least_chunk_bytes())};
  }
  for (std::size_t n_slots = base::pipeline_slots(); n_slots > 0; n_slots /= 2) {
    for (const std::uint64_t quarters : quarters_held(tasks)) {
      tasks.fit(n_slots, scaled(own_budget(tasks, options), quarters, 4));
      const Room room = room_of(tasks, n_slots, options);
      if (room.chunk_bytes != 0 && room.chunk_bytes >= enough_bytes(tasks, room)) return room;
    }
  }
  const std::uint64_t least = least_bytes(tasks, options);
  if (options.memory_bytes < least) {
    throw Error(ErrorKind::limit, {},
                run_name(options) + " needs at least " + mebibytes(least) + ", but only " +
                    allowed(options.memory_bytes) + " are allowed",
                Remedy::more_memory);
  }
  Room room{1, 0, n_makers(tasks, 1), tasks.least_chunk_bytes()};
  room.chunk_bytes = room.piece_bytes;
  return room;
}

}  // namespace mc::pipe
