// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "mc/method.hpp"

// The built-in method as one that has no bands, boxes and sparse volumes: it makes one layer at a
// time.

namespace mc::test {

class PlainEngine final : public SlabEngine {
 public:
  explicit PlainEngine(std::unique_ptr<SlabEngine> cubes) : cubes_(std::move(cubes)) {}

  [[nodiscard]] std::int32_t n_layers() const override { return cubes_->n_layers(); }
  [[nodiscard]] std::int32_t max_layers() const override { return cubes_->max_layers(); }
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const override {
    return cubes_->planes_for(l0, l1);
  }
  std::int32_t extract(const Slab& slab, std::int32_t l0, std::int32_t l1, std::uint64_t max_bytes,
                       MeshChunk& chunk, SurfaceTotals& totals) override {
    EXPECT_EQ(l1, l0 + 1);
    EXPECT_GE(max_bytes, least_chunk_bytes());
    return cubes_->extract(slab, l0, l1, max_bytes, chunk, totals);
  }
  void count(const Slab& slab, std::int32_t l0, std::int32_t l1, SurfaceTotals& totals) override {
    cubes_->count(slab, l0, l1, totals);
  }
  [[nodiscard]] std::uint64_t scratch_bytes() const override { return cubes_->scratch_bytes(); }
  [[nodiscard]] std::uint64_t max_mesh_bytes(std::int32_t n_layers) const override {
    return cubes_->max_mesh_bytes(n_layers);
  }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override { return 3 * max_mesh_bytes(1); }

 private:
  std::unique_ptr<SlabEngine> cubes_;
};

inline std::unique_ptr<SlabEngine> plain_engine(const Volume& volume, const Affine& to_world,
                                                const ExtractOptions& options) {
  return std::make_unique<PlainEngine>(cubes_method().dense(volume, to_world, options));
}

inline constexpr Method kPlain{"plain", plain_engine};

}  // namespace mc::test
