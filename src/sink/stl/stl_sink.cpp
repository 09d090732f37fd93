// SPDX-License-Identifier: MIT
#include "sink/stl/stl_sink.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <optional>

#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
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

using Triple = std::array<float, 3>;

/// Unit normal by the right hand, zero where the facet has no area or is not finite.
Triple facet_normal(const std::array<Triple, 3>& corner) {
  Vec3 u{}, v{};
  for (std::size_t a = 0; a < 3; ++a) {
    u[a] = static_cast<double>(corner[1][a]) - static_cast<double>(corner[0][a]);
    v[a] = static_cast<double>(corner[2][a]) - static_cast<double>(corner[0][a]);
  }
  const Vec3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0) || !std::isfinite(length)) {
    return {};
  }
  Triple unit{};
  for (std::size_t a = 0; a < 3; ++a) {
    unit[a] = static_cast<float>(n[a] / length) + 0.0F;  // no negative zero
  }
  return unit;
}

class StlSink final : public MeshSink {
 public:
  StlSink(const std::string& path, const SinkOptions& options)
      : options_(options), out_(path, {.force = options.force, .binary = !options.ascii}) {}

  void begin_object(const MeshObject& object) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  void check_limits(std::uint64_t n_vertices, std::uint64_t n_triangles) const;
  [[nodiscard]] std::string header() const;
  void write_facets();
  void write_facets_as_text();
  template <class Each>
  void for_facets(Each each);

  SinkOptions options_;
  OutputFile out_;
  MeshObject object_;
  bool begun_ = false;
  ObjectCounts counts_;
  std::optional<SpoolFile> positions_, triangles_;
  Buffer<std::byte> block_;
};

void StlSink::check_limits(std::uint64_t n_vertices, std::uint64_t n_triangles) const {
  check_limit(out_.place(), n_triangles, "triangles", "STL", kMostFacets,
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
    throw Error(ErrorKind::usage, out_.place(), "STL holds one mesh, but there are several",
                "write .glb, .gltf or .obj, or one iso a file");
  }
  begun_ = true;
  object_ = object;
  check_limits(object.n_vertices.value_or(0), object.n_triangles.value_or(0));
  positions_.emplace(out_);
  triangles_.emplace(out_);
}

void StlSink::place(const MeshChunk& chunk, std::size_t /*slot*/) {
  assert(begun_);
  counts_.add(object_, chunk);
  check_limits(counts_.n_vertices, counts_.n_triangles);
  const auto rounded = [&](std::size_t k) {
    return chunk.positions_f64.empty() ? chunk.positions[k]
                                       : static_cast<float>(chunk.positions_f64[k]);
  };
  put_records(
      chunk.n_vertices(), sizeof(Triple), block_,
      [&](std::size_t i, std::byte* at) {
        const Triple p{rounded(3 * i), rounded(3 * i + 1), rounded(3 * i + 2)};
        std::memcpy(at, p.data(), sizeof p);
      },
      [this](std::span<const std::byte> bytes) { positions_->append(bytes); });
  put_records(
      chunk.indices.size(), sizeof(std::uint32_t), block_,
      [&](std::size_t i, std::byte* at) {
        const auto id = static_cast<std::uint32_t>(chunk.index_base + chunk.indices[i]);
        std::memcpy(at, &id, sizeof id);
      },
      [this](std::span<const std::byte> bytes) { triangles_->append(bytes); });
}

void StlSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
}

/// Calls each(corners) for every triangle in order. Triangles are read block by block; positions
/// are mapped, since they are wanted in any order (in practice near one another).
template <class Each>
void StlSink::for_facets(Each each) {
  const std::span<const std::byte> positions = positions_->map();
  constexpr std::size_t kPerBlock = (std::size_t{64} << 10) / sizeof(std::array<std::uint32_t, 3>);
  Buffer<std::array<std::uint32_t, 3>> ids(kPerBlock);
  std::array<Triple, 3> corner{};
  for (std::uint64_t first = 0; first < counts_.n_triangles; first += kPerBlock) {
    const auto n =
        static_cast<std::size_t>(std::min<std::uint64_t>(kPerBlock, counts_.n_triangles - first));
    triangles_->read(first * sizeof ids[0], std::as_writable_bytes(std::span(ids).first(n)));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (ids[i][c] >= counts_.n_vertices) {
          throw Error(ErrorKind::internal, out_.place(), "a triangle names no vertex");
        }
        std::memcpy(corner[c].data(), &positions[ids[i][c] * sizeof(Triple)], sizeof(Triple));
      }
      each(corner);
    }
  }
}

void StlSink::write_facets() {
  out_.append(header());
  const auto n = static_cast<std::uint32_t>(counts_.n_triangles);
  out_.append(std::as_bytes(std::span(&n, 1)));
  for_facets([this](const std::array<Triple, 3>& corner) {
    std::array<std::byte, kFacetBytes> facet{};
    const Triple normal = facet_normal(corner);
    std::memcpy(facet.data(), normal.data(), sizeof normal);
    std::memcpy(facet.data() + sizeof normal, corner.data(), sizeof corner);
    out_.append(facet);
  });
}

void StlSink::write_facets_as_text() {
  out_.append("solid mc\n");
  std::string text;
  for_facets([&](const std::array<Triple, 3>& corner) {
    text = "facet normal";
    append_triple(text, facet_normal(corner).data());
    text += "\n outer loop\n";
    for (const Triple& p : corner) {
      text += "  vertex";
      append_triple(text, p.data());
      text += '\n';
    }
    text += " endloop\nendfacet\n";
    out_.append(text);
  });
  out_.append("endsolid mc\n");
}

void StlSink::finish() {
  if (!begun_) {
    begin_object({});
  }
  if (options_.ascii) {
    write_facets_as_text();
  } else {
    write_facets();
  }
  out_.commit();
}

}  // namespace

std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options) {
  return std::make_unique<StlSink>(path, options);
}

}  // namespace mc::sink
