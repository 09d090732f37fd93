// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>
#include <tuple>

#include "base/simd_target.hpp"
#include "mc/extract.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "support/reference_extractor.hpp"

// The dense engine against the reference, bit for bit.

namespace mc::test {
namespace {

void expect_same(const Mesh& got, const Mesh& want) {
  ASSERT_EQ(got.positions.size(), want.positions.size());
  ASSERT_EQ(std::memcmp(got.positions.data(), want.positions.data(),
                        want.positions.size() * sizeof(want.positions[0])),
            0);
  ASSERT_EQ(got.triangles, want.triangles);
  ASSERT_EQ(got.normals.size(), want.normals.size());
  for (std::size_t n = 0; n < want.normals.size(); ++n) {
    ASSERT_EQ(std::memcmp(&got.normals[n], &want.normals[n], sizeof(want.normals[n])), 0)
        << "normal " << n << ": " << got.normals[n][0] << " " << got.normals[n][1] << " "
        << got.normals[n][2] << " but " << want.normals[n][0] << " " << want.normals[n][1] << " "
        << want.normals[n][2];
  }
}

const Affine kSkewed{{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}};
const Affine kMirrored{{-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 5}};

template <class T>
void compare_all(Index3 dims, const std::vector<How>& hows) {
  std::uint64_t seed = 1;
  for (const Noise noise : {Noise::white, Noise::plateaus, Noise::with_nan, Noise::smooth}) {
    for (const Border border : {Border::open, Border::closed, Border::solid}) {
      for (const Inside inside : {Inside::above, Inside::below}) {
        for (const Normals normals : {Normals::none, Normals::gradient, Normals::face}) {
          const auto samples = random_field<T>(dims, noise, ++seed);
          ExtractOptions o;
          o.iso = test_iso<T>();
          o.inside = inside;
          o.border = border;
          o.normals = normals;
          const Affine& map = seed % 2 == 0 ? kSkewed : kMirrored;
          const Mesh want = reference_extract(samples, dims, o, map);
          const MemorySlabs::Layout layout{
              .to_world = map,
              .endian = seed % 3 == 0 ? std::endian::big : std::endian::little,
              .row_padding = seed % 4,
              .lead = seed % 2};
          const VolumeReader reader =
              owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims, layout)));
          for (const How& how : hows) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << " threads " << how.threads
                                            << " layers " << how.slab_layers);
            expect_same(collect(reader, o, how).mesh, want);
            if (testing::Test::HasFatalFailure()) return;
          }
        }
      }
    }
  }
}

template <class T>
class DenseEngine : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t,
                                   std::uint32_t, std::int32_t, std::int64_t, Half, float, double>;
TYPED_TEST_SUITE(DenseEngine, SampleTypes);

TYPED_TEST(DenseEngine, EqualsTheReference) {
  compare_all<TypeParam>({9, 6, 7}, {{1, 0, false}, {2, 1, false}});
}

TYPED_TEST(DenseEngine, EqualsTheReferenceInRowsOfSeveralWords) {
  compare_all<TypeParam>({131, 4, 3}, {{1, 1, false}});
}

/// Memory that ends where a page ends that must not be touched.
class GuardedMemory {
 public:
  explicit GuardedMemory(std::size_t n_bytes)
      : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))),
        n_mapped_((n_bytes + page_ - 1) / page_ * page_ + page_),
        base_(static_cast<std::byte*>(
            mmap(nullptr, n_mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))),
        first_(base_ + n_mapped_ - page_ - n_bytes) {
    if (base_ == MAP_FAILED || mprotect(base_ + n_mapped_ - page_, page_, PROT_NONE) != 0) {
      throw std::runtime_error("no guarded memory");
    }
  }
  ~GuardedMemory() { munmap(base_, n_mapped_); }
  GuardedMemory(const GuardedMemory&) = delete;
  GuardedMemory& operator=(const GuardedMemory&) = delete;
  [[nodiscard]] std::byte* data() const { return first_; }

 private:
  std::size_t page_, n_mapped_;
  std::byte *base_, *first_;
};

// Several samples are loaded at once, or more bytes than one has: never past the last.
TYPED_TEST(DenseEngine, ReadsNothingPastTheLastSample) {
  const Index3 dims{40, 9, 5};
  const auto samples = random_field<TypeParam>(dims, Noise::white, 3);
  const GuardedMemory memory(samples.size() * sizeof(TypeParam));
  std::memcpy(memory.data(), samples.data(), samples.size() * sizeof(TypeParam));
  for (const Normals normals : {Normals::none, Normals::gradient}) {
    ExtractOptions o;
    o.iso = test_iso<TypeParam>();
    o.normals = normals;
    const View3<const TypeParam> view(reinterpret_cast<const TypeParam*>(memory.data()), dims);
    expect_same(extract(view, o), reference_extract(samples, dims, o));
  }
}

// Thin volumes have no sample with neighbours on all sides.
TEST(DenseEngineFloat, ThinVolumesEqualTheReference) {
  for (const std::int32_t thin : {2, 3, 4}) {
    for (const Index3 dims : {Index3{thin, 8, 7}, Index3{8, thin, 7}, Index3{8, 7, thin}}) {
      compare_all<float>(dims, {{1, 0, false}});
    }
  }
}

TEST(DenseEngineFloat, DoesNotDependOnThreadsOrSlabs) {
  std::vector<How> hows;
  for (const int threads : {1, 2, 3, 7}) {
    for (const std::int32_t layers : {1, 2, 3, 5, 0}) hows.push_back({threads, layers, false});
  }
  compare_all<float>({12, 11, 13}, hows);
}

TEST(DenseEngineFloat, RowEndsAtEveryPlaceInAWord) {
  for (std::int32_t nx = 2; nx <= 130; ++nx) {
    const auto samples =
        random_field<float>({nx, 3, 3}, Noise::white, static_cast<std::uint64_t>(nx));
    for (const Border border : {Border::open, Border::closed}) {
      ExtractOptions o;
      o.iso = 0.25;
      o.border = border;
      const Mesh want = reference_extract(samples, {nx, 3, 3}, o);
      const VolumeReader reader =
          owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, Index3{nx, 3, 3})));
      expect_same(collect(reader, o).mesh, want);
      ASSERT_FALSE(HasFatalFailure()) << nx;
    }
  }
}

TEST(DenseEngineFloat, EverySimdTargetGivesTheSameBytes) {
  for (const std::string& target : base::simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(base::set_simd_target(target));
    compare_all<float>({70, 5, 4}, {{1, 0, false}});
    compare_all<std::uint8_t>({133, 3, 3}, {{1, 0, false}});
    compare_all<std::int8_t>({133, 3, 3}, {{1, 0, false}});
    compare_all<std::int16_t>({70, 3, 3}, {{1, 0, false}});
    compare_all<std::int32_t>({70, 3, 3}, {{1, 0, false}});
    compare_all<std::uint16_t>({70, 3, 3}, {{1, 0, false}});
    compare_all<std::uint32_t>({70, 3, 3}, {{1, 0, false}});
    compare_all<std::int64_t>({70, 3, 3}, {{1, 0, false}});
    compare_all<Half>({70, 3, 3}, {{1, 0, false}});
    compare_all<double>({70, 3, 3}, {{1, 0, false}});
  }
  base::reset_simd_target();
  EXPECT_FALSE(base::set_simd_target("neon9"));
}

TEST(DenseEngineFloat, InterpolationOptions) {
  const Index3 dims{6, 7, 5};
  const auto samples = random_field<float>(dims, Noise::white, 5);
  const VolumeReader reader = owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims)));
  ExtractOptions o;
  o.iso = 0.25;
  o.interpolation = Interpolation::midpoint;
  expect_same(collect(reader, o).mesh, reference_extract(samples, dims, o));
  o.interpolation = Interpolation::linear;
  o.cutoff = 0.3;
  expect_same(collect(reader, o).mesh, reference_extract(samples, dims, o));
  o.cutoff = 0;
  o.min_edge = 0.125;
  expect_same(collect(reader, o).mesh, reference_extract(samples, dims, o));
  o.min_edge = 0;
  o.origin = {100, 200, 300};
  expect_same(collect(reader, o).mesh, reference_extract(samples, dims, o));
}

TEST(DenseEngineFloat, RegionIsAVolumeOfItsOwn) {
  const Index3 dims{20, 14, 11};
  const auto samples = random_field<float>(dims, Noise::white, 6);
  const VolumeReader reader = owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims)));
  for (const Border border : {Border::open, Border::closed}) {
    for (const Normals normals : {Normals::gradient, Normals::face}) {
      ExtractOptions o;
      o.iso = 0.25;
      o.border = border;
      o.normals = normals;
      o.region = IndexBox{{3, 2, 4}, {17, 9, 8}};
      expect_same(collect(reader, o, {2, 1, false}).mesh, reference_extract(samples, dims, o));
    }
  }
}

TEST(DenseEngineFloat, CountsBeforeEqualCountsAfter) {
  const Index3 dims{40, 30, 20};
  const auto samples = random_field<float>(dims, Noise::white, 7);
  const VolumeReader reader = owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims)));
  ExtractOptions o;
  o.iso = 0.25;
  const Collected got = collect(reader, o, {2, 3, true});
  EXPECT_EQ(got.object.n_vertices, got.mesh.positions.size());
  EXPECT_EQ(got.object.n_triangles, got.mesh.triangles.size());
  EXPECT_EQ(got.totals.n_vertices, got.mesh.positions.size());
  EXPECT_EQ(got.totals.n_triangles, got.mesh.triangles.size());
  EXPECT_EQ(got.n_objects, 1);
}

TEST(DenseEngineFloat, DoublePrecisionRoundsToTheSingleOne) {
  const Index3 dims{10, 9, 8};
  const auto samples = random_field<float>(dims, Noise::white, 8);
  const VolumeReader reader =
      owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims, kSkewed)));
  ExtractOptions o;
  o.iso = 0.25;
  const Collected single = collect(reader, o);
  o.precision = Precision::f64;
  const Collected twice = collect(reader, o);
  ASSERT_EQ(twice.mesh.positions_f64.size(), single.mesh.positions.size());
  for (std::size_t n = 0; n < twice.mesh.positions_f64.size(); ++n) {
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(static_cast<float>(twice.mesh.positions_f64[n][a]), single.mesh.positions[n][a]);
    }
  }
  EXPECT_EQ(twice.mesh.normals, single.mesh.normals);
}

}  // namespace
}  // namespace mc::test
