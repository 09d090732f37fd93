// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "extract/cubes/dense_grid.hpp"
#include "extract/cubes/vertex_pass.hpp"
#include "mc/field.hpp"
#include "mc/method.hpp"

// Layers whose mesh is too large to be held, cut into bands of rows: the bits of a layer's two
// planes say how many vertices each row has, so bands are cut to size, and their ids known, before
// anything is made. Bands of one layer are made side by side. The surface is that of
// DenseExtractor, in the same order, whatever the bands.

namespace mc::extraction {

class DenseBands final : public SlabBands {
 public:
  DenseBands(DenseGrid grid, std::size_t n_makers);

  /// Bytes that a band's chunk must be allowed: of a row where every edge is crossed.
  static std::uint64_t least_bytes(const DenseGrid& grid);
  /// Bytes of scratch, with so many makers.
  static std::uint64_t scratch_bytes(const DenseGrid& grid, std::size_t n_makers);

  void start(const Slab& slab, std::int32_t l0, std::int32_t l1, bool with_lowest,
             std::uint64_t max_bytes) override;
  /// Goes to the next layer and prepares its bands.
  std::size_t next() override;
  void make(std::size_t n, std::size_t maker, MeshChunk& chunk, SurfaceTotals& totals) override;

 private:
  /// Scratch of one thread.
  struct Maker {
    EdgeBatches batches;
    std::vector<std::uint32_t> i_ids, j_ids;
  };
  /// Rows [first, last) of one of the planes, or of what lies between them.
  struct Band {
    enum class Of : std::uint8_t { lower, between, upper };
    Of of;
    std::size_t first, last;
  };
  /// How much a band may hold.
  struct Most {
    std::uint64_t vertices, indices;
  };

  [[nodiscard]] const PlaneBits& bits(std::int32_t plane) const {
    return planes_[static_cast<std::size_t>(plane) % 2];
  }
  PlaneBits& bits(std::int32_t plane) { return planes_[static_cast<std::size_t>(plane) % 2]; }
  [[nodiscard]] BitPlane view(std::int32_t plane) const {
    return grid_.classifier.view(bits(plane));
  }
  static Most most_of(const DenseGrid& grid, std::uint64_t bytes);
  void load(std::int32_t plane);
  void end_layer();
  [[nodiscard]] std::uint64_t row_crossings(std::size_t j) const;
  template <class Vertices, class Crossings>
  void cut(Band::Of of, const Vertices& vertices_in, const Crossings& crossings_in);
  void cut_plane(Band::Of of, std::int32_t plane);
  void emit(const Band& band, mesh::ChunkRoom& room) const;
  template <class T, bool Swap>
  void make_typed(const Band& band, bool is_first, Maker& maker, mesh::ChunkRoom& room,
                  SurfaceTotals& totals) const;

  DenseGrid grid_;
  std::array<PlaneBits, 2> planes_;
  std::vector<std::uint32_t> k_start_;
  const Slab* slab_ = nullptr;
  std::int32_t layer_ = 0, l1_ = 0;
  bool begun_ = false, with_lowest_ = false;
  Most most_{};
  std::uint32_t n_lower_ = 0, n_between_ = 0, n_upper_ = 0;  ///< vertices
  std::uint64_t n_before_ = 0;  ///< vertices made since start(), those of this layer aside
  std::vector<Band> bands_;
  std::vector<Maker> makers_;
};

}  // namespace mc::extraction
