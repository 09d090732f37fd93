// SPDX-License-Identifier: MIT
#include "sink/obj/obj_sink.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/part.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// Wavefront OBJ: of every object all `v`, then all `vn`, then all `f`; indices start at 1 and run
// on through the file. No count comes first, so `v` lines go out as they come, to a stream as well.
// Normals and ids are spooled as they are in memory, a third of what their text takes, and become
// lines at the end, block by block. Numbers are the shortest that read back the same.

namespace mc::sink {

namespace {

constexpr LineBytes vertex_line(Precision precision) {
  return {kMostTriple + 3, (precision == Precision::f64 ? kMostTriple : kFloatTriple) + 3};
}
constexpr LineBytes kNormalLine{kMostTriple + 4, kFloatTriple + 4};
constexpr LineBytes kFaceLine{2 + 3 * (1 + kMostDigits + 2 + kMostDigits),
                              2 + 3 * (1 + kLargeIdDigits + 2 + kLargeIdDigits)};

// The lines of a block stay in the second-level cache until they are written.
constexpr std::size_t kNormalsAtOnce = 4096;
constexpr std::size_t kFacesAtOnce = 4096;

using Ids = std::array<std::uint32_t, 3>;

/// Triangles of the spool whose ids count from the same vertex.
struct IdRun {
  std::uint64_t first_triangle, n_triangles;
  std::uint64_t base;
};

/// Part of a run that becomes lines at once.
struct FaceBlock {
  std::uint64_t first_triangle, base;
  std::size_t n_triangles;
};

/// Where the ids of `f` lines count from.
struct FirstIds {
  std::uint64_t vertex = 1;
  std::uint64_t normal = 1;  ///< less than `vertex` after an object without normals
};

/// Prints the id of a corner's vertex, and that of its normal if there are some.
char* print_corner(char* at, std::uint64_t id, const FirstIds& first, bool has_normals) {
  const std::uint64_t vertex = first.vertex + id;
  const std::uint64_t normal = first.normal + id;
  if (vertex < kFastIntegers && vertex == normal) {
    const ShortText text = small_text(static_cast<std::uint32_t>(vertex));
    at = print_short(at, text);
    return has_normals ? print_short(print_text(at, "//"), text) : at;
  }
  at = print_number(at, vertex);
  return has_normals ? print_number(print_text(at, "//"), normal) : at;
}

class ObjSink final : public MeshSink {
 public:
  ObjSink(const std::string& path, const SinkOptions& options)
      : out_(path, output_options(options, false)) {
    for (const auto& [key, value] : options.provenance) {
      out_.append("# " + on_one_line(key) + ": " + on_one_line(value) + "\n");
    }
  }

  void set_slots(std::size_t n_slots) override { slots_.resize(n_slots); }
  void begin_object(const MeshObject& object) override;
  void format(const MeshChunk& chunk, std::size_t slot) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override { out_.commit(); }

 private:
  /// Of a chunk.
  struct Slot {
    Piece vertices, normals, ids;
    std::uint32_t max_index = 0;
    std::uint32_t id_shift = 0;  ///< from indices to ids in the spool
  };
  /// Of the lines at the end of an object.
  struct Block {
    Buffer<float> normals;
    Buffer<Ids> ids;
    Piece lines;
  };

  void print_vertices(const MeshChunk& chunk, Piece& piece) const;
  void place_ids(const MeshChunk& chunk, std::uint64_t first_triangle, Slot& s);
  template <class Make>
  void write_blocks(std::size_t n_blocks, Make make);
  void write_normals();
  void write_faces();

  OutputFile out_;
  MeshObject object_;
  ObjectCounts counts_;
  FirstIds first_;
  std::optional<SpoolFile> normal_spool_, id_spool_;
  std::optional<Part> vertices_, normals_, ids_;
  std::vector<IdRun> id_runs_;
  std::vector<Slot> slots_{1};
};

void ObjSink::begin_object(const MeshObject& object) {
  object_ = object;
  counts_ = {};
  normals_.emplace(normal_spool_.emplace(out_).writer(), 0);
  ids_.emplace(id_spool_.emplace(out_).writer(), 0);
  id_runs_.clear();
  if (!object.name.empty()) {
    std::string name = on_one_line(object.name);  // many readers end a name at the first space
    std::replace(name.begin(), name.end(), ' ', '_');
    out_.append("o " + name + "\n");
  }
  vertices_.emplace(out_.writer(), out_.size());
}

void ObjSink::print_vertices(const MeshChunk& chunk, Piece& piece) const {
  const LineBytes line = vertex_line(object_.precision);
  // As far as the chunk can grow before its own memory moves, so that this seldom moves.
  const std::size_t n_most = (chunk.positions.capacity() + chunk.positions_f64.capacity()) / 3;
  make_room(piece.made, n_most * line.usual);
  const auto print = [&](auto print_position) {
    make_lines(chunk.n_vertices(), line, piece.made, [&](std::size_t i, char* at) {
      at = print_position(print_text(at, "v "), i);
      *at++ = '\n';
      return at;
    });
  };
  if (object_.precision == Precision::f64) {
    print([&](char* at, std::size_t i) { return print_triple(at, &chunk.positions_f64[3 * i]); });
  } else {
    TripleTexts texts(chunk.positions);
    print([&](char* at, std::size_t i) { return texts.print(at, i); });
  }
  piece.take_made();
}

void ObjSink::format(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  print_vertices(chunk, s.vertices);
  s.normals.take(chunk.normals);
  s.max_index = chunk.indices.empty() ? 0 : *std::ranges::max_element(chunk.indices);
  s.ids.announce(chunk.n_triangles() * sizeof(Ids));
}

/// Gives the chunk's triangles their place in the spool.
void ObjSink::place_ids(const MeshChunk& chunk, std::uint64_t first_triangle, Slot& s) {
  if (chunk.n_triangles() == 0) return;
  const auto fits = [&](const IdRun& run) {
    return chunk.index_base >= run.base &&
           chunk.index_base - run.base + s.max_index <= std::numeric_limits<std::uint32_t>::max();
  };
  if (id_runs_.empty() || !fits(id_runs_.back())) {
    id_runs_.push_back({first_triangle, 0, chunk.index_base});
  }
  id_runs_.back().n_triangles += chunk.n_triangles();
  s.id_shift = static_cast<std::uint32_t>(chunk.index_base - id_runs_.back().base);
  ids_->place(s.ids);
}

void ObjSink::place(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  const std::uint64_t first_triangle = counts_.n_triangles;
  counts_.add(object_, chunk);
  vertices_->place(s.vertices);
  normals_->place(s.normals);
  place_ids(chunk, first_triangle, s);
}

void ObjSink::write(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  vertices_->write(s.vertices);
  normals_->write(s.normals);
  ids_->write_records(chunk.indices.size(), sizeof(std::uint32_t), s.ids,
                      id_encoder<std::uint32_t>(chunk, s.id_shift));
}

/// Writes what `make` puts into the lines of each block, in order.
template <class Make>
void ObjSink::write_blocks(std::size_t n_blocks, Make make) {
  Part lines(out_.writer(), out_.size());
  std::vector<Block> blocks(base::pipeline_slots());
  const std::array<base::Step, 3> steps{{
      {false, [&](std::size_t n, std::size_t slot) { make(n, blocks[slot]); }},
      {true, [&](std::size_t /*n*/, std::size_t slot) { lines.place(blocks[slot].lines); }},
      {false, [&](std::size_t /*n*/, std::size_t slot) { lines.write(blocks[slot].lines); }},
  }};
  base::pipeline(n_blocks, blocks.size(), steps);
  lines.end();
}

void ObjSink::write_normals() {
  const FileWriter& spool = normal_spool_->writer();
  const std::uint64_t n_normals = spool.size() / (3 * sizeof(float));
  const auto n_blocks = static_cast<std::size_t>((n_normals + kNormalsAtOnce - 1) / kNormalsAtOnce);
  write_blocks(n_blocks, [&](std::size_t block, Block& out) {
    const std::uint64_t first = std::uint64_t{block} * kNormalsAtOnce;
    const auto n =
        static_cast<std::size_t>(std::min(n_normals - first, std::uint64_t{kNormalsAtOnce}));
    out.normals.resize(3 * n);
    spool.read_flushed(first * 3 * sizeof(float), std::as_writable_bytes(std::span(out.normals)));
    TripleTexts texts(out.normals);
    make_lines(n, kNormalLine, out.lines.made, [&](std::size_t i, char* at) {
      at = texts.print(print_text(at, "vn "), i);
      *at++ = '\n';
      return at;
    });
    out.lines.take_made();
  });
}

void ObjSink::write_faces() {
  std::vector<FaceBlock> blocks;
  for (const IdRun& run : id_runs_) {
    for (std::uint64_t n = 0; n < run.n_triangles; n += kFacesAtOnce) {
      const std::uint64_t n_at_once = std::min<std::uint64_t>(kFacesAtOnce, run.n_triangles - n);
      blocks.push_back({run.first_triangle + n, run.base, static_cast<std::size_t>(n_at_once)});
    }
  }
  const FileWriter& spool = id_spool_->writer();
  write_blocks(blocks.size(), [&](std::size_t n, Block& out) {
    const FaceBlock& block = blocks[n];
    out.ids.resize(block.n_triangles);
    spool.read_flushed(block.first_triangle * sizeof(Ids),
                       std::as_writable_bytes(std::span(out.ids)));
    make_lines(block.n_triangles, kFaceLine, out.lines.made, [&](std::size_t i, char* at) {
      *at++ = 'f';
      for (const std::uint32_t id : out.ids[i]) {
        *at++ = ' ';
        at = print_corner(at, block.base + id, first_, object_.has_normals);
      }
      *at++ = '\n';
      return at;
    });
    out.lines.take_made();
  });
}

void ObjSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
  vertices_->end();
  normals_->end();
  ids_->end();
  for (Slot& s : slots_) s = {};  // blocks take their memory
  write_normals();
  write_faces();
  normal_spool_.reset();
  id_spool_.reset();
  first_.vertex += counts_.n_vertices;
  first_.normal += object_.has_normals ? counts_.n_vertices : 0;
}

}  // namespace

MeshNeeds obj_needs(const SinkOptions& /*options*/, bool f32_moves) {
  const Precision precision = f32_moves ? Precision::f64 : Precision::f32;
  return {.precision = precision,
          .formatted = {.vertex_bytes = static_cast<std::uint32_t>(vertex_line(precision).usual)}};
}

std::unique_ptr<MeshSink> open_obj(const std::string& path, const SinkOptions& options) {
  return std::make_unique<ObjSink>(path, options);
}

}  // namespace mc::sink
