// SPDX-License-Identifier: MIT
#include "sink/stl/stl_sink.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "sink/formats.hpp"
#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/part.hpp"
#include "sink/stl/facets.hpp"

// STL (3D Systems, 1988): three positions a facet, no vertices. The facets of a binary file have
// their place as soon as those before them are counted. Of each chunk
//
//     |---- head: written with the chunk ----|--- tail: written with the next chunk ---|
//
// the tail begins with the first triangle that names a vertex of a later chunk. It keeps the
// positions that it needs, and the next chunk has the others: dense volumes are written in one
// pass. What the next chunk cannot complete either (sparse volumes), text, and streams, whose count
// of facets comes first, is joined at the end: the positions of all vertices and these triangles
// are spooled.

namespace mc::sink {

namespace {

constexpr std::uint64_t kMostFacets = 0xFFFFFFFF;
constexpr std::uint64_t kMostVertices = std::uint64_t{1} << 32;  // of a spooled index
constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetsAt = kHeaderBytes + sizeof(std::uint32_t);

// A block is just larger than what the file layer would gather first.
constexpr std::size_t kFacetsAtOnce = kBufferBytes / kFacetBytes + 1;

/// The positions of all vertices as stored, and what a message calls the output.
struct Joined {
  std::span<const std::byte> positions;
  std::uint64_t n_vertices;
  const std::string& place;

  const float* operator()(std::uint32_t id) const {
    if (id >= n_vertices) {
      throw Error(ErrorKind::internal, place, "a triangle names no vertex");
    }
    return reinterpret_cast<const float*>(positions.data()) + std::size_t{3} * id;
  }
};

/// The end of a chunk, to be completed by the next.
struct Tail {
  Buffer<Ids> triangles;    ///< vertices count from the first of `positions`
  Buffer<float> positions;  ///< of the last vertices of the chunk
  std::uint64_t first_vertex = 0, first_triangle = 0;
  std::uint32_t max_id = 0;

  [[nodiscard]] bool empty() const { return triangles.empty(); }
  [[nodiscard]] std::size_t n_vertices() const { return positions.size() / 3; }
  void clear() {
    triangles.clear();
    positions.clear();
  }
};

/// The triangles of a chunk as they lie in it.
std::span<const Ids> triangles_of(const MeshChunk& chunk) {
  static_assert(sizeof(Ids) == 3 * sizeof(std::uint32_t));
  return {reinterpret_cast<const Ids*>(chunk.indices.data()), chunk.n_triangles()};
}

/// Makes room for what chunks like this one can leave.
void reserve(const MeshChunk& chunk, Tail& tail) {
  make_room(tail.triangles, chunk.indices.capacity() / 3);
  make_room(tail.positions, chunk.positions.capacity() + chunk.positions_f64.capacity());
}

/// Takes triangles [first, end) of the chunk, and of its positions those from their lowest vertex.
void take_tail(const MeshChunk& chunk, std::size_t first, std::span<const float> positions,
               Tail& tail) {
  tail.clear();
  reserve(chunk, tail);
  const std::span<const Ids> triangles = triangles_of(chunk).subspan(first);
  if (triangles.empty()) return;
  const auto [lowest, highest] = std::minmax_element(
      chunk.indices.begin() + static_cast<std::ptrdiff_t>(3 * first), chunk.indices.end());
  const std::size_t first_kept = std::min<std::size_t>(*lowest, chunk.n_vertices());
  const auto base = static_cast<std::uint32_t>(first_kept);
  for (const Ids& ids : triangles) {
    tail.triangles.push_back({ids[0] - base, ids[1] - base, ids[2] - base});
  }
  const std::span<const float> own = positions.subspan(3 * first_kept);
  tail.positions.assign(own.begin(), own.end());
  tail.first_vertex = first_kept;
  tail.first_triangle = first;
  tail.max_id = *highest - base;
}

class StlSink final : public MeshSink {
 public:
  StlSink(const std::string& path, const SinkOptions& options, std::uint64_t most_facets)
      : options_(options),
        most_facets_(most_facets),
        out_(path, output_options(options, !options.ascii)),
        in_place_(!options.ascii && out_.seekable()) {}

  void set_slots(std::size_t n_slots) override { slots_.resize(n_slots); }
  void begin_object(const MeshObject& object) override;
  void format(const MeshChunk& chunk, std::size_t slot) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  struct Slot {
    Piece positions;         // to the spool
    Piece late_tail, late;   // triangles to the spool: of the chunk before, and of this one
    Buffer<float> rounded;   // positions that came in double precision
    std::size_t n_head = 0;  // triangles whose vertices are all in the chunk
    Tail tail;               // the others
    std::uint64_t first_triangle = 0;  // of the chunk
    Tail before;                       // of the chunk before, which this one completes
    Piece block;                       // of facets
  };
  /// Triangles that are spooled one after the other.
  struct LateRun {
    std::uint64_t first_triangle, n_triangles;
  };

  void check_limits(std::uint64_t n_vertices, std::uint64_t n_triangles) const;
  [[nodiscard]] std::string header(std::uint64_t n_triangles) const;
  [[nodiscard]] std::span<const float> positions_of(const MeshChunk& chunk, const Slot& s) const;
  void place_late(std::uint64_t first_triangle, std::uint64_t n_triangles, Piece& piece);
  void place_tail(std::uint64_t n_vertices, Slot& s);
  void spool_tail(Piece& piece);
  void write_facets(std::span<const Ids> triangles, std::uint64_t first, Piece& block,
                    const auto& position_of) const;
  void write_late_facets();

  SinkOptions options_;
  std::uint64_t most_facets_;
  OutputFile out_;
  bool in_place_;  // facets can be written before those that come first in the file
  MeshObject object_;
  bool begun_ = false;
  ObjectCounts counts_;
  Tail tail_;  // of the last chunk that has its place
  std::optional<SpoolFile> position_spool_, triangle_spool_;
  std::optional<Part> positions_, triangles_;
  std::optional<Part> facets_;  // if they are written in place
  std::vector<LateRun> late_runs_;
  std::vector<Slot> slots_{1};
};

void StlSink::check_limits(std::uint64_t n_vertices, std::uint64_t n_triangles) const {
  check_limit(out_.place(), n_triangles, "triangles", "STL", most_facets_,
              "write .ply or .obj, or one --region at a time");
  check_limit(out_.place(), n_vertices, "vertices", "STL", kMostVertices,
              "write .obj, or one --region at a time");
}

/// Of the binary form: 80 bytes that do not begin with "solid", by which readers tell the text
/// form, and the count.
std::string StlSink::header(std::uint64_t n_triangles) const {
  std::string text = "binary STL";
  for (const auto& [key, value] : options_.provenance) {
    const std::string more = "; " + on_one_line(key) + ": " + on_one_line(value);
    if (text.size() + more.size() <= kHeaderBytes) {
      text += more;
    }
  }
  text.resize(kHeaderBytes, ' ');
  const auto n = static_cast<std::uint32_t>(n_triangles);
  text.resize(kFacetsAt);
  std::memcpy(&text[kHeaderBytes], &n, sizeof n);
  return text;
}

void StlSink::begin_object(const MeshObject& object) {
  if (begun_) {
    refuse_second_object(kStlFormat, out_.place());
  }
  begun_ = true;
  object_ = object;
  check_limits(object.n_vertices.value_or(0), object.n_triangles.value_or(0));
  positions_.emplace(position_spool_.emplace(out_).writer(), 0);
  triangles_.emplace(triangle_spool_.emplace(out_).writer(), 0);
  if (in_place_) {
    out_.append(header(0));
    facets_.emplace(out_.writer(), kFacetsAt);
  }
}

std::span<const float> StlSink::positions_of(const MeshChunk& chunk, const Slot& s) const {
  return object_.precision == Precision::f64 ? s.rounded : chunk.positions;
}

void StlSink::format(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  if (object_.precision == Precision::f64) {
    make_room(s.rounded, chunk.positions_f64.size());
    s.rounded.resize(chunk.positions_f64.size());
    std::ranges::transform(chunk.positions_f64, s.rounded.begin(),
                           [](double x) { return static_cast<float>(x); });
    s.positions.take(s.rounded);
  } else {
    s.positions.take(chunk.positions);
  }
  s.n_head = 0;
  if (!in_place_) return;
  const std::span<const Ids> triangles = triangles_of(chunk);
  const auto is_late = [n = chunk.n_vertices()](const Ids& ids) {
    return std::max({ids[0], ids[1], ids[2]}) >= n;
  };
  s.n_head = static_cast<std::size_t>(std::ranges::find_if(triangles, is_late) - triangles.begin());
  reserve(chunk, s.before);
  take_tail(chunk, s.n_head, positions_of(chunk, s), s.tail);
}

/// Gives triangles a place in the spool.
void StlSink::place_late(std::uint64_t first_triangle, std::uint64_t n_triangles, Piece& piece) {
  if (n_triangles == 0) return;
  const bool goes_on =
      !late_runs_.empty() &&
      late_runs_.back().first_triangle + late_runs_.back().n_triangles == first_triangle;
  if (!goes_on) late_runs_.push_back({first_triangle, 0});
  late_runs_.back().n_triangles += n_triangles;
  triangles_->place(piece);
}

/// Leaves the triangles of the last tail to the end.
void StlSink::spool_tail(Piece& piece) {
  Buffer<std::byte>& to = piece.made;
  make_room(to, tail_.triangles.size() * sizeof(Ids));
  to.resize(tail_.triangles.size() * sizeof(Ids));
  const auto base = static_cast<std::uint32_t>(tail_.first_vertex);
  std::byte* at = to.data();
  for (const Ids& ids : tail_.triangles) {
    const Ids all{base + ids[0], base + ids[1], base + ids[2]};
    std::memcpy(at, all.data(), sizeof all);
    at += sizeof all;
  }
  piece.take_made();
  place_late(tail_.first_triangle, tail_.triangles.size(), piece);
  tail_.clear();
}

/// Hands the tail of the chunk before to this one, if its `n_vertices` complete it.
void StlSink::place_tail(std::uint64_t n_vertices, Slot& s) {
  s.before.clear();
  s.late_tail.announce(0);
  if (tail_.empty()) return;
  if (tail_.max_id < tail_.n_vertices() + n_vertices) {
    std::swap(tail_, s.before);
  } else {
    spool_tail(s.late_tail);
  }
}

void StlSink::place(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  const std::uint64_t first_vertex = counts_.n_vertices, first_triangle = counts_.n_triangles;
  counts_.add(object_, chunk);
  check_limits(counts_.n_vertices, counts_.n_triangles);
  positions_->place(s.positions);
  place_tail(chunk.n_vertices(), s);
  s.late.announce(0);
  if (!in_place_ || chunk.index_base != first_vertex) {
    s.n_head = 0;
    s.late.announce(chunk.n_triangles() * sizeof(Ids));
    return place_late(first_triangle, chunk.n_triangles(), s.late);
  }
  s.first_triangle = first_triangle;
  if (tail_.triangles.capacity() == 0) reserve(chunk, tail_);
  if (s.tail.empty()) return;
  s.tail.first_vertex += first_vertex;
  s.tail.first_triangle += first_triangle;
  std::swap(tail_, s.tail);
}

/// Writes facets from triangle `first` of the file on.
void StlSink::write_facets(std::span<const Ids> triangles, std::uint64_t first, Piece& block,
                           const auto& position_of) const {
  block.at = kFacetsAt + first * kFacetBytes;
  facets_->write_records(triangles.size(), kFacetBytes, block,
                         [&](std::size_t from, std::size_t to, std::byte* at) {
                           encode_facets(triangles.subspan(from, to - from), at, position_of);
                         });
}

void StlSink::write(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  positions_->write(s.positions);
  triangles_->write(s.late_tail);
  if (s.late.n_bytes != 0) {
    triangles_->write_records(chunk.indices.size(), sizeof(std::uint32_t), s.late,
                              id_encoder<std::uint32_t>(chunk));
  }
  const auto own = [p = positions_of(chunk, s).data()](std::uint32_t id) {
    return p + std::size_t{3} * id;
  };
  if (!s.before.empty()) {
    const auto either = [own, p = s.before.positions.data(),
                         n = s.before.n_vertices()](std::uint32_t id) {
      return id < n ? p + std::size_t{3} * id : own(static_cast<std::uint32_t>(id - n));
    };
    write_facets(s.before.triangles, s.before.first_triangle, s.block, either);
  }
  if (s.n_head != 0)
    write_facets(triangles_of(chunk).first(s.n_head), s.first_triangle, s.block, own);
}

void StlSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
  if (!tail_.empty()) {
    Piece& last = slots_.front().late_tail;
    spool_tail(last);
    triangles_->write(last);
  }
  positions_->end();
  triangles_->end();
}

/// Joins spooled triangles and positions, block by block. Triangles are read; positions are mapped,
/// since they are wanted in any order (in practice near one another).
void StlSink::write_late_facets() {
  if (late_runs_.empty()) return;
  const Joined joined{position_spool_->map(), counts_.n_vertices, out_.place()};
  struct Block {
    std::uint64_t first_triangle, first_spooled;
    std::size_t n_triangles;
  };
  std::vector<Block> blocks;
  std::uint64_t n_spooled = 0;
  for (const LateRun& run : late_runs_) {
    for (std::uint64_t first = 0; first < run.n_triangles; first += kFacetsAtOnce) {
      const std::uint64_t n = std::min<std::uint64_t>(kFacetsAtOnce, run.n_triangles - first);
      blocks.push_back(
          {run.first_triangle + first, n_spooled + first, static_cast<std::size_t>(n)});
    }
    n_spooled += run.n_triangles;
  }
  struct Made {
    Buffer<Ids> ids;
    Buffer<std::byte> facets;
  };
  slots_ = {};  // chunks are over
  std::vector<Made> made(base::pipeline_slots());
  const FileWriter& triangles = triangle_spool_->writer();
  const auto make = [&](std::size_t item, std::size_t slot) {
    auto& [ids, facets] = made[slot];
    ids.resize(blocks[item].n_triangles);
    triangles.read_flushed(blocks[item].first_spooled * sizeof(Ids),
                           std::as_writable_bytes(std::span(ids)));
    if (options_.ascii) return print_facets(ids, facets, joined);
    make_records(0, ids.size(), kFacetBytes, facets,
                 [&](std::size_t /*first*/, std::size_t /*last*/, std::byte* at) {
                   encode_facets(ids, at, joined);
                 });
  };
  const auto put = [&](std::size_t item, std::size_t slot) {
    if (!in_place_) return out_.append(made[slot].facets);
    out_.write_at(kFacetsAt + blocks[item].first_triangle * kFacetBytes, made[slot].facets);
  };
  const std::array<base::Step, 2> steps{{{false, make}, {true, put}}};
  base::pipeline(blocks.size(), made.size(), steps);
}

void StlSink::finish() {
  if (!begun_) {
    begin_object({});
  }
  const std::string head = options_.ascii ? "solid mc\n" : header(counts_.n_triangles);
  if (in_place_) {
    out_.skip(counts_.n_triangles * kFacetBytes);
    out_.write_at(0, std::as_bytes(std::span(head)));
  } else {
    out_.append(head);
  }
  write_late_facets();
  if (options_.ascii) out_.append("endsolid mc\n");
  out_.commit();
}

}  // namespace

MeshNeeds stl_needs(const SinkOptions& /*options*/, bool /*f32_moves*/) {
  // Of a chunk: positions as floats and ids, once more of the tail before it.
  return {.formatted = {.vertex_bytes = 24, .triangle_bytes = 24}};
}

std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options) {
  return open_stl_of(path, options, kMostFacets);
}

std::unique_ptr<MeshSink> open_stl_of(const std::string& path, const SinkOptions& options,
                                      std::uint64_t most_facets) {
  return std::make_unique<StlSink>(path, options, most_facets);
}

}  // namespace mc::sink
