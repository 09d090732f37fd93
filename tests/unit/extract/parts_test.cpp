// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>
#include <utility>

#include "base/simd_target.hpp"
#include "extract/cubes/dense.hpp"
#include "support/memory_readers.hpp"
#include "support/random_fields.hpp"
#include "support/reference_extractor.hpp"

// Parts of a dense volume: each is what remains of the whole surface without the other cells.

namespace mc::test {
namespace {

Affine skewed() { return {{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}}; }

/// A copy of the box's samples, as a slab that holds nothing else.
template <class T>
Slab cut_out(const std::vector<T>& samples, const Index3& dims, const IndexBox& box) {
  Slab slab;
  slab.allocate(box, sizeof(T));
  std::byte* to = slab.storage.data();
  for (std::int32_t k = box.lo[2]; k <= box.hi[2]; ++k) {
    for (std::int32_t j = box.lo[1]; j <= box.hi[1]; ++j, to += slab.row_stride_bytes) {
      const auto row =
          static_cast<std::size_t>(j + dims[1] * k) * static_cast<std::size_t>(dims[0]);
      std::memcpy(to, samples.data() + row + static_cast<std::size_t>(box.lo[0]),
                  slab.row_stride_bytes);
    }
  }
  return slab;
}

template <class T>
void expect_bytes(const Buffer<T>& got, const void* want, std::size_t n) {
  ASSERT_EQ(got.size(), n);
  ASSERT_EQ(n == 0 || std::memcmp(got.data(), want, n * sizeof(T)) == 0, true);
}

void expect_same(const MeshChunk& got, const Mesh& want) {
  expect_bytes(got.positions, want.positions.data(), 3 * want.positions.size());
  expect_bytes(got.normals, want.normals.data(), 3 * want.normals.size());
  expect_bytes(got.indices, want.triangles.data(), 3 * want.triangles.size());
}

/// Some part of a box, with at least one cell.
IndexBox random_part(const IndexBox& box, std::mt19937_64& random) {
  IndexBox part;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n_cells = static_cast<std::uint64_t>(box.hi[a] - box.lo[a]);
    part.lo[a] = box.lo[a] + static_cast<std::int32_t>(random() % n_cells);
    const auto n_behind = static_cast<std::uint64_t>(box.hi[a] - part.lo[a]);
    part.hi[a] = part.lo[a] + 1 + static_cast<std::int32_t>(random() % n_behind);
  }
  return part;
}

/// Random parts, one after the other from one extractor, against the reference.
template <class T>
void compare_parts(const Index3& dims, std::uint64_t first_seed) {
  std::uint64_t seed = first_seed;
  for (const Border border : {Border::open, Border::closed, Border::solid}) {
    for (const Normals normals : {Normals::none, Normals::gradient, Normals::face}) {
      std::mt19937_64 random(++seed);
      SCOPED_TRACE(testing::Message() << "seed " << seed);
      const auto samples = random_field<T>(dims, Noise::with_nan, seed);
      ExtractOptions o{.iso = test_iso<T>(), .border = border, .normals = normals};
      o.inside = seed % 2 == 0 ? Inside::above : Inside::below;
      const MemorySlabs reader(samples, dims, skewed());
      extraction::DenseExtractor extractor(reader.volume(), skewed(), o);
      for (int n = 0; n < 4; ++n) {
        const IndexBox part = random_part(extractor.whole(), random);
        extractor.set_box(part);
        MeshChunk chunk;
        SurfaceTotals totals;
        extractor.extract(cut_out(samples, dims, extractor.samples()), 0, extractor.n_layers(),
                          chunk, totals);
        ReferenceExtractor<T> reference(samples, dims, o, skewed());
        expect_same(chunk, reference.extract_part(part));
        ASSERT_FALSE(testing::Test::HasFatalFailure());
      }
    }
  }
}

template <class T>
class DenseParts : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t,
                                   std::uint32_t, std::int32_t, std::int64_t, Half, float, double>;
TYPED_TEST_SUITE(DenseParts, SampleTypes);

TYPED_TEST(DenseParts, EqualTheReference) {
  compare_parts<TypeParam>({13, 11, 9}, 100);
  compare_parts<TypeParam>({140, 5, 4}, 200);
}

TEST(DensePartsFloat, EverySimdTargetGivesTheSameBytes) {
  for (const std::string& target : base::simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(base::set_simd_target(target));
    compare_parts<float>({40, 9, 7}, 300);
    compare_parts<std::uint8_t>({40, 9, 7}, 400);
  }
  base::reset_simd_target();
}

TEST(DensePartsFloat, CountBoundaryEdgesOfEveryFaceThatIsNotCapped) {
  const Index3 dims{12, 12, 12};
  const std::vector<float> samples = random_field<float>(dims, Noise::white, 5);
  const ExtractOptions o{.iso = 0.25, .border = Border::closed};
  const MemorySlabs reader(samples, dims);
  extraction::DenseExtractor extractor(reader.volume(), {}, o, {{-1, 3, 4}, {12, 8, 12}});
  MeshChunk chunk;
  SurfaceTotals totals;
  extractor.extract(cut_out(samples, dims, extractor.samples()), 0, extractor.n_layers(), chunk,
                    totals);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (std::size_t n = 0; n < chunk.indices.size(); n += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [a, b] = std::minmax(chunk.indices[n + c], chunk.indices[n + (c + 1) % 3]);
      ++sides[{a, b}];
    }
  }
  const auto n_boundary = std::ranges::count_if(sides, [](const auto& s) { return s.second == 1; });
  EXPECT_EQ(totals.n_boundary_edges, static_cast<std::uint64_t>(n_boundary));
  EXPECT_GT(n_boundary, 0);
}

}  // namespace
}  // namespace mc::test
