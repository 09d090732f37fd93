// SPDX-License-Identifier: MIT
#include "mc/method.hpp"

#include <cassert>

#include "extract/cubes/dense.hpp"
#include "extract/sparse/sparse.hpp"

// The row of the built-in method, and what a method need not write.

namespace mc {

namespace {

std::unique_ptr<SlabEngine> dense_cubes(const Volume& volume, const Affine& to_world,
                                        const ExtractOptions& options) {
  return std::make_unique<extraction::DenseExtractor>(volume, to_world, options);
}

std::unique_ptr<BlockEngine> sparse_cubes(const LeafReader& reader, const Affine& to_world,
                                          const ExtractOptions& options) {
  return std::make_unique<extraction::SparseEngine>(reader, to_world, options);
}

std::unique_ptr<SlabEngine> cubes_in_box(const Volume& volume, const Affine& to_world,
                                         const ExtractOptions& options, const IndexBox& cells) {
  return std::make_unique<extraction::DenseExtractor>(volume, to_world, options, cells);
}

constexpr Method kCubes{.name = "cubes",
                        .dense = dense_cubes,
                        .sparse = sparse_cubes,
                        .box = cubes_in_box,
                        .selects_components = true};

}  // namespace

std::unique_ptr<SlabBands> SlabEngine::bands(std::size_t /*n_makers*/) const { return nullptr; }

std::uint64_t SlabEngine::bands_bytes(std::size_t /*n_makers*/) const { return 0; }

std::uint64_t SlabEngine::count_vertices(const Slab& /*slab*/, std::int32_t /*l0*/,
                                         std::int32_t /*l1*/, bool /*with_lowest*/) {
  assert(!has_bands());
  return 0;
}

void SlabEngine::share(std::span<SlabEngine* const> /*others*/) {}

void SlabEngine::forget() {}

void SlabEngine::set_box(const IndexBox& /*cells*/) {
  assert(false);  // the method has a function `box` and its engines do not
}

IndexBox SlabEngine::samples() const {
  assert(false);
  return {};
}

const Method& cubes_method() { return kCubes; }

}  // namespace mc
