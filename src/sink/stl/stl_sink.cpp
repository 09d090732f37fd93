// SPDX-License-Identifier: MIT
#include "sink/stl/stl_sink.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "sink/formats.hpp"
#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/part.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// STL (3D Systems, 1988): three positions a facet, no vertices. A triangle may name a vertex of a
// later chunk, so positions and triangles are spooled and joined at the end. Facet normals are
// those of the positions as stored, computed in double and rounded once.

namespace mc::sink {

namespace {

constexpr std::uint64_t kMostFacets = 0xFFFFFFFF;
constexpr std::uint64_t kMostVertices = std::uint64_t{1} << 32;  // of a spooled index
constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFacetBytes = 50;  // normal, three positions, two bytes of attributes

// A block is just larger than what the file layer would gather first.
constexpr std::size_t kFacetsAtOnce = kBufferBytes / kFacetBytes + 1;

using Triple = std::array<float, 3>;
using Facet = std::array<Triple, 3>;
using Ids = std::array<std::uint32_t, 3>;

/// Unit normal by the right hand, zero where the facet has no area or is not finite.
Triple facet_normal(const Facet& corner) {
  const auto widened = [](const Triple& p) { return Vec3{p[0], p[1], p[2]}; };
  const Vec3 first = widened(corner[0]);
  const Vec3 n = cross(minus(widened(corner[1]), first), minus(widened(corner[2]), first));
  const double area = length(n);  // of the parallelogram
  if (!(area > 0) || !std::isfinite(area)) return {};
  Triple unit{};
  for (std::size_t a = 0; a < 3; ++a) {
    unit[a] = static_cast<float>(n[a] / area) + 0.0F;  // no negative zero
  }
  return unit;
}

/// The positions of all vertices as stored, and what a message calls the output.
struct Joined {
  std::span<const std::byte> positions;
  std::uint64_t n_vertices;
  const std::string& place;

  [[nodiscard]] Facet facet(const Ids& ids) const {
    Facet corner{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (ids[c] >= n_vertices) {
        throw Error(ErrorKind::internal, place, "a triangle names no vertex");
      }
      std::memcpy(corner[c].data(), &positions[ids[c] * sizeof(Triple)], sizeof(Triple));
    }
    return corner;
  }
};

void encode_facets(const Joined& joined, std::span<const Ids> ids, Buffer<std::byte>& to) {
  make_records(ids.size(), kFacetBytes, to, [&](std::size_t i, std::byte* at) {
    const Facet corner = joined.facet(ids[i]);
    const Triple normal = facet_normal(corner);
    std::memcpy(at, normal.data(), sizeof normal);
    std::memcpy(at + sizeof normal, corner.data(), sizeof corner);
    std::memset(at + sizeof normal + sizeof corner, 0, kFacetBytes - sizeof normal - sizeof corner);
  });
}

void print_facets(const Joined& joined, std::span<const Ids> ids, Buffer<std::byte>& to) {
  constexpr LineBytes kFacet{100 + 4 * kMostTriple, 100 + 4 * kFloatTriple};
  make_lines(ids.size(), kFacet, to, [&](std::size_t i, char* at) {
    const Facet corner = joined.facet(ids[i]);
    at = print_triple(print_text(at, "facet normal "), facet_normal(corner).data());
    at = print_text(at, "\n outer loop\n");
    for (const Triple& p : corner) {
      at = print_triple(print_text(at, "  vertex "), p.data());
      *at++ = '\n';
    }
    return print_text(at, " endloop\nendfacet\n");
  });
}

class StlSink final : public MeshSink {
 public:
  StlSink(const std::string& path, const SinkOptions& options, std::uint64_t most_facets)
      : options_(options),
        most_facets_(most_facets),
        out_(path, output_options(options, !options.ascii)) {}

  void set_slots(std::size_t n_slots) override { slots_.resize(n_slots); }
  void begin_object(const MeshObject& object) override;
  void format(const MeshChunk& chunk, std::size_t slot) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  void check_limits(std::uint64_t n_vertices, std::uint64_t n_triangles) const;
  [[nodiscard]] std::string header() const;
  void write_facets();

  struct Slot {
    Piece positions, triangles;
  };

  SinkOptions options_;
  std::uint64_t most_facets_;
  OutputFile out_;
  MeshObject object_;
  bool begun_ = false;
  ObjectCounts counts_;
  std::optional<SpoolFile> position_spool_, triangle_spool_;
  std::optional<Part> positions_, triangles_;
  std::vector<Slot> slots_{1};
};

void StlSink::check_limits(std::uint64_t n_vertices, std::uint64_t n_triangles) const {
  check_limit(out_.place(), n_triangles, "triangles", "STL", most_facets_,
              "write .ply or .obj, or one --region at a time");
  check_limit(out_.place(), n_vertices, "vertices", "STL", kMostVertices,
              "write .obj, or one --region at a time");
}

/// 80 bytes that do not begin with "solid", by which readers tell the text form.
std::string StlSink::header() const {
  std::string text = "binary STL";
  for (const auto& [key, value] : options_.provenance) {
    const std::string more = "; " + on_one_line(key) + ": " + on_one_line(value);
    if (text.size() + more.size() <= kHeaderBytes) {
      text += more;
    }
  }
  text.resize(kHeaderBytes, ' ');
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
}

void StlSink::format(const MeshChunk& chunk, std::size_t slot) {
  auto& [positions, triangles] = slots_[slot];
  if (object_.precision == Precision::f64) {
    make_records(chunk.positions_f64.size(), sizeof(float), positions.made,
                 [p = chunk.positions_f64.data()](std::size_t i, std::byte* at) {
                   const auto rounded = static_cast<float>(p[i]);
                   std::memcpy(at, &rounded, sizeof rounded);
                 });
    positions.take_made();
  } else {
    positions.take(chunk.positions);
  }
  make_records(chunk.indices.size(), sizeof(std::uint32_t), triangles.made,
               [base = static_cast<std::uint32_t>(chunk.index_base), ids = chunk.indices.data()](
                   std::size_t i, std::byte* at) {
                 const std::uint32_t id = base + ids[i];
                 std::memcpy(at, &id, sizeof id);
               });
  triangles.take_made();
}

void StlSink::place(const MeshChunk& chunk, std::size_t slot) {
  counts_.add(object_, chunk);
  check_limits(counts_.n_vertices, counts_.n_triangles);
  positions_->place(slots_[slot].positions);
  triangles_->place(slots_[slot].triangles);
}

void StlSink::write(const MeshChunk& /*chunk*/, std::size_t slot) {
  positions_->write(slots_[slot].positions);
  triangles_->write(slots_[slot].triangles);
}

void StlSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
  positions_->end();
  triangles_->end();
}

/// Joins triangles and positions, block by block. Triangles are read; positions are mapped, since
/// they are wanted in any order (in practice near one another).
void StlSink::write_facets() {
  const Joined joined{position_spool_->map(), counts_.n_vertices, out_.place()};
  struct Block {
    Buffer<Ids> ids;
    Buffer<std::byte> facets;
  };
  slots_ = {};  // chunks are over
  std::vector<Block> blocks(base::pipeline_slots());
  const FileWriter& triangles = triangle_spool_->writer();
  const auto make = [&](std::size_t item, std::size_t slot) {
    auto& [ids, facets] = blocks[slot];
    const std::uint64_t first = std::uint64_t{item} * kFacetsAtOnce;
    ids.resize(static_cast<std::size_t>(
        std::min<std::uint64_t>(kFacetsAtOnce, counts_.n_triangles - first)));
    triangles.read_flushed(first * sizeof(Ids), std::as_writable_bytes(std::span(ids)));
    options_.ascii ? print_facets(joined, ids, facets) : encode_facets(joined, ids, facets);
  };
  const std::array<base::Step, 2> steps{
      {{false, make},
       {true, [&](std::size_t /*item*/, std::size_t slot) { out_.append(blocks[slot].facets); }}}};
  const std::uint64_t n_blocks = (counts_.n_triangles + kFacetsAtOnce - 1) / kFacetsAtOnce;
  base::pipeline(static_cast<std::size_t>(n_blocks), blocks.size(), steps);
}

void StlSink::finish() {
  if (!begun_) {
    begin_object({});
  }
  if (options_.ascii) {
    out_.append("solid mc\n");
    write_facets();
    out_.append("endsolid mc\n");
  } else {
    out_.append(header());
    const auto n = static_cast<std::uint32_t>(counts_.n_triangles);
    out_.append(std::as_bytes(std::span(&n, 1)));
    write_facets();
  }
  out_.commit();
}

}  // namespace

MeshNeeds stl_needs(const SinkOptions& /*options*/, bool /*f32_moves*/) {
  // Of a chunk: positions as floats, ids of the whole mesh.
  return {.formatted = {.vertex_bytes = 12, .triangle_bytes = 12}};
}

std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options) {
  return open_stl_of(path, options, kMostFacets);
}

std::unique_ptr<MeshSink> open_stl_of(const std::string& path, const SinkOptions& options,
                                      std::uint64_t most_facets) {
  return std::make_unique<StlSink>(path, options, most_facets);
}

}  // namespace mc::sink
