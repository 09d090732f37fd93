// SPDX-License-Identifier: MIT
#include "boxes/boxes.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

// A corner of boxes lies in the centre of a cell where solid and other samples meet: cells have one
// vertex or none, and layer l of the mesh owns those of its cells. A face lies across a lattice
// edge between a solid sample and another one; the layer of its lowest cells makes it.

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

class BoxesEngine final : public mc::SlabEngine {
 public:
  BoxesEngine(const mc::Volume& volume, const mc::Affine& to_world,
              const mc::ExtractOptions& options)
      : dims_(volume.lattice.dims()), to_world_(to_world), options_(options) {
    if (volume.type != mc::SampleType::f32 || volume.endian != std::endian::native ||
        options.region || options.border != mc::Border::open ||
        options.normals != mc::Normals::none || options.precision != mc::Precision::f32) {
      throw mc::Error(mc::ErrorKind::usage, "boxes",
                      "only whole f32 volumes can be boxes, without caps and normals");
    }
  }

  [[nodiscard]] std::int32_t n_layers() const override { return dims_[2] - 1; }
  [[nodiscard]] std::int32_t max_layers() const override { return 64; }
  /// Faces use corners of layer l1.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const override {
    return {l0, std::min(l1 + 2, dims_[2])};
  }

  std::int32_t extract(const mc::Slab& slab, std::int32_t l0, std::int32_t l1,
                       std::uint64_t /*max_bytes*/, mc::MeshChunk& chunk,
                       mc::SurfaceTotals& totals) override {
    make(slab, l0, l1, chunk, totals);
    return l1;
  }
  void count(const mc::Slab& slab, std::int32_t l0, std::int32_t l1,
             mc::SurfaceTotals& totals) override {
    make(slab, l0, l1, counted_, totals);
  }

  [[nodiscard]] std::uint64_t scratch_bytes() const override { return 8 * n_cells(); }
  [[nodiscard]] std::uint64_t max_mesh_bytes(std::int32_t n) const override {
    constexpr std::uint64_t kCellBytes = 3 * 4 + 3 * 2 * 3 * 4;  // a vertex, three faces
    return static_cast<std::uint64_t>(n) * n_cells() * kCellBytes;
  }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override { return max_mesh_bytes(1); }

 private:
  [[nodiscard]] std::uint64_t n_cells() const {
    return static_cast<std::uint64_t>(dims_[0] - 1) * static_cast<std::uint64_t>(dims_[1] - 1);
  }
  [[nodiscard]] std::size_t cell(std::int32_t i, std::int32_t j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(dims_[0] - 1) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] bool solid(const mc::Slab& slab, std::int32_t i, std::int32_t j,
                           std::int32_t k) const {
    const bool border =
        i == 0 || j == 0 || k == 0 || i == dims_[0] - 1 || j == dims_[1] - 1 || k == dims_[2] - 1;
    if (border) return false;
    float value = 0;
    std::memcpy(&value,
                slab.planes[static_cast<std::size_t>(k - slab.k0)] +
                    static_cast<std::size_t>(j) * slab.row_stride_bytes +
                    static_cast<std::size_t>(i) * sizeof value,
                sizeof value);
    return options_.inside == mc::Inside::above ? value >= options_.iso : value < options_.iso;
  }

  void make(const mc::Slab& slab, std::int32_t l0, std::int32_t l1, mc::MeshChunk& chunk,
            mc::SurfaceTotals& totals) {
    chunk.clear();
    totals.clear();
    std::uint32_t next = 0;
    number(slab, l0, next, &chunk, totals);
    for (std::int32_t l = l0; l < l1; ++l) {
      lower_.swap(upper_);
      if (l + 1 < n_layers()) number(slab, l + 1, next, l + 1 < l1 ? &chunk : nullptr, totals);
      make_faces(slab, l, chunk);
    }
    totals.n_vertices = chunk.n_vertices();
    totals.n_triangles = chunk.n_triangles();
  }

  /// Numbers the corners in layer l into upper_; puts them into the chunk, if there is one.
  void number(const mc::Slab& slab, std::int32_t l, std::uint32_t& next, mc::MeshChunk* chunk,
              mc::SurfaceTotals& totals) {
    upper_.assign(n_cells(), kNone);
    for (std::int32_t j = 0; j + 1 < dims_[1]; ++j) {
      for (std::int32_t i = 0; i + 1 < dims_[0]; ++i) {
        int n_solid = 0;
        for (int c = 0; c < 8; ++c) n_solid += solid(slab, i + c % 2, j + c / 2 % 2, l + c / 4);
        if (n_solid == 0 || n_solid == 8) continue;
        upper_[cell(i, j)] = next++;
        if (chunk == nullptr) continue;
        mc::Vec3 p = to_world_({i + 0.5, j + 0.5, l + 0.5});
        for (std::size_t a = 0; a < 3; ++a) {
          const auto stored = static_cast<float>(p[a] - options_.origin[a]);
          chunk->positions.push_back(stored);
          p[a] = stored;
        }
        totals.bounds.include(p);
      }
    }
  }

  /// Two triangles with the corners in turn, which run counter-clockwise seen from `upper`.
  void add_face(bool lower_solid, const std::array<std::uint32_t, 4>& corners,
                mc::MeshChunk& chunk) const {
    const bool flip = lower_solid != (to_world_.determinant() > 0);
    for (const std::size_t n : {0, 1, 2, 0, 2, 3}) {
      chunk.indices.push_back(corners[flip ? (4 - n) % 4 : n]);
    }
  }

  void make_faces(const mc::Slab& slab, std::int32_t l, mc::MeshChunk& chunk) const {
    for (std::int32_t j = 1; j + 1 < dims_[1]; ++j) {
      for (std::int32_t i = 1; i + 1 < dims_[0]; ++i) {
        if (const bool in = solid(slab, i, j, l); in != solid(slab, i, j, l + 1)) {
          add_face(in,
                   {lower_[cell(i - 1, j - 1)], lower_[cell(i, j - 1)], lower_[cell(i, j)],
                    lower_[cell(i - 1, j)]},
                   chunk);
        }
      }
    }
    if (l + 1 == n_layers()) return;
    for (std::int32_t j = 0; j + 1 < dims_[1]; ++j) {
      for (std::int32_t i = 0; i + 1 < dims_[0]; ++i) {
        const bool in = solid(slab, i, j, l + 1);
        if (in != solid(slab, i + 1, j, l + 1)) {
          add_face(in,
                   {lower_[cell(i, j - 1)], lower_[cell(i, j)], upper_[cell(i, j)],
                    upper_[cell(i, j - 1)]},
                   chunk);
        }
        if (in != solid(slab, i, j + 1, l + 1)) {
          add_face(in,
                   {lower_[cell(i - 1, j)], upper_[cell(i - 1, j)], upper_[cell(i, j)],
                    lower_[cell(i, j)]},
                   chunk);
        }
      }
    }
  }

  mc::Index3 dims_;
  mc::Affine to_world_;
  mc::ExtractOptions options_;
  std::vector<std::uint32_t> lower_, upper_;
  mc::MeshChunk counted_;
};

std::unique_ptr<mc::SlabEngine> boxes(const mc::Volume& volume, const mc::Affine& to_world,
                                      const mc::ExtractOptions& options) {
  return std::make_unique<BoxesEngine>(volume, to_world, options);
}

}  // namespace

constexpr mc::Method kBoxesMethod{"boxes", boxes};
