// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "mc/field.hpp"
#include "support/memory_readers.hpp"

namespace mc {
namespace {

using test::MemoryLeaves;
using test::MemorySlabs;

/// Samples of which whole blocks are 0, whole blocks are 5, and the rest random.
template <class T>
std::vector<T> blocky(const Index3& dims, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<unsigned> kinds(1000);
  for (unsigned& kind : kinds) kind = static_cast<unsigned>(random() % 3);
  std::vector<T> out;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) {
        const auto block = static_cast<std::size_t>(i / 8 + 10 * (j / 8) + 100 * (k / 8));
        const auto noise = static_cast<unsigned>(random() % 100);
        const unsigned value = kinds[block] == 2 ? noise : kinds[block] * 5;
        out.push_back(static_cast<T>(value));
      }
    }
  }
  return out;
}

/// What a reader hands out for planes [k0, k1), as numbers.
std::vector<double> planes_of(const SlabReader& reader, std::int32_t k0, std::int32_t k1) {
  Slab slab;
  reader.read(k0, k1, slab);
  EXPECT_EQ(slab.k0, k0);
  EXPECT_EQ(slab.planes.size(), static_cast<std::size_t>(k1 - k0));
  const Index3 dims = reader.volume().lattice.dims();
  const std::size_t size = sample_size(reader.volume().type);
  std::vector<double> out;
  for (const std::byte* plane : slab.planes) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) {
        Scalar sample;
        std::memcpy(sample.bytes.data(),
                    plane + static_cast<std::size_t>(j) * slab.row_stride_bytes +
                        static_cast<std::size_t>(i) * size,
                    size);
        out.push_back(to_double(sample, reader.volume().type));
      }
    }
  }
  return out;
}

template <class T>
std::vector<double> naive(const std::vector<T>& samples, const Index3& dims, const Index3& origin,
                          double background, const IndexBox& box, int k0, int k1) {
  std::vector<double> out;
  for (int z = box.lo[2] + k0; z < box.lo[2] + k1; ++z) {
    for (int y = box.lo[1]; y <= box.hi[1]; ++y) {
      for (int x = box.lo[0]; x <= box.hi[0]; ++x) {
        const int i = x - origin[0];
        const int j = y - origin[1];
        const int k = z - origin[2];
        const bool inside = i >= 0 && j >= 0 && k >= 0 && i < dims[0] && j < dims[1] && k < dims[2];
        const auto at = static_cast<std::size_t>((k * dims[1] + j) * dims[0] + i);
        out.push_back(inside ? static_cast<double>(samples[at]) : background);
      }
    }
  }
  return out;
}

TEST(DenseView, EqualsTheArrayTheLeavesWereCutFrom) {
  const Index3 dims{40, 27, 33};
  const Index3 origin{-16, 8, -24};
  const auto samples = blocky<std::int16_t>(dims, 7);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const MemoryLeaves sparse(samples, dims, origin, std::int16_t{0}, {},
                              MemoryLeaves::seeded(seed));
    for (const IndexBox& box :
         {sparse.volume().lattice.box, IndexBox{{-20, 3, -30}, {30, 40, 12}},
          IndexBox{{-11, 13, -19}, {-3, 20, -2}}, IndexBox{{100, 100, 100}, {104, 102, 103}}}) {
      const auto view = dense_view(sparse, box);
      const int nz = view->volume().lattice.dims()[2];
      EXPECT_EQ(planes_of(*view, 0, nz), naive(samples, dims, origin, 0, box, 0, nz));
      EXPECT_EQ(planes_of(*view, nz / 2, nz / 2 + 1),
                naive(samples, dims, origin, 0, box, nz / 2, nz / 2 + 1));
    }
  }
}

TEST(DenseView, FillsTilesOfEverySize) {
  const std::vector<double> one(512, 2.5);
  MemoryLeaves sparse(one, {8, 8, 8}, {0, 0, 0}, -1.0);
  sparse.add_tile({{8, 0, 0}, 8, Scalar::of(3.0), false});
  sparse.add_tile({{128, 0, 0}, 128, Scalar::of(4.0), true});
  const IndexBox box{{4, 7, 7}, {130, 7, 130}};
  const auto view = dense_view(sparse, box);
  std::vector<double> row = planes_of(*view, 0, 1);
  EXPECT_EQ(row[3], 2.5);  // x = 7
  EXPECT_EQ(row[4], 3.0);  // x = 8
  EXPECT_EQ(row[12], -1.0);
  EXPECT_EQ(row[123], -1.0);
  EXPECT_EQ(row[124], 4.0);  // x = 128
  row = planes_of(*view, 120, 122);
  EXPECT_EQ(row[124], 4.0);         // z = 127
  EXPECT_EQ(row[127 + 124], -1.0);  // z = 128
  EXPECT_EQ(view->volume().n_active, std::nullopt);
}

TEST(DenseView, KeepsSamplesInPlaceAndAllocatesOnlyWhatIsAskedFor) {
  const std::vector<float> one(512, 1.F);
  const MemoryLeaves sparse(one, {8, 8, 8}, {0, 0, 0}, 0.F,
                            Affine::scale_translate({2, 3, 4}, {1, 1, 1}));
  const auto view = dense_view(sparse, {{-1, -2, -3}, {500, 500, 1000000}});
  EXPECT_EQ(view->volume().lattice.box, (IndexBox{{0, 0, 0}, {501, 502, 1000003}}));
  EXPECT_EQ(view->volume().lattice.to_world({0, 0, 0}), (Vec3{-1, -5, -11}));
  EXPECT_EQ(view->volume().lattice.to_world({1, 2, 3}), (Vec3{1, 1, 1}));
  Slab slab;
  view->read(999, 1001, slab);
  EXPECT_EQ(slab.storage.size(), 2U * 502 * 503 * sizeof(float));
}

TEST(DenseView, IsReadFromSeveralThreads) {
  const Index3 dims{24, 24, 24};
  const auto samples = blocky<float>(dims, 3);
  const MemoryLeaves sparse(samples, dims, {0, 0, 0}, 0.F);
  const auto view = dense_view(sparse, sparse.volume().lattice.box);
  std::array<std::vector<double>, 3> parts;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 3; ++t) {
      threads.emplace_back(
          [&, t] { parts[static_cast<std::size_t>(t)] = planes_of(*view, 8 * t, 8 * t + 8); });
    }
  }
  for (int t = 0; t < 3; ++t) {
    EXPECT_EQ(parts[static_cast<std::size_t>(t)],
              naive(samples, dims, {0, 0, 0}, 0, sparse.volume().lattice.box, 8 * t, 8 * t + 8));
  }
}

TEST(CropView, PointsIntoTheWholeVolume) {
  const Index3 dims{9, 8, 7};
  std::vector<std::uint16_t> samples(9 * 8 * 7);
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<std::uint16_t>(n);
  MemorySlabs::Layout layout;
  layout.to_world = Affine::scale_translate({1, 2, 3}, {10, 20, 30});
  layout.row_padding = 5;
  layout.lead = 1;
  const MemorySlabs whole(samples, dims, layout);
  const IndexBox box{{2, 1, 3}, {6, 7, 5}};
  const auto crop = crop_view(whole, box);
  EXPECT_EQ(crop->volume().lattice.dims(), (Index3{5, 7, 3}));
  EXPECT_EQ(crop->volume().lattice.to_world({0, 0, 0}), (Vec3{12, 22, 39}));
  EXPECT_TRUE(crop->rereads_cheaply());
  EXPECT_EQ(planes_of(*crop, 0, 3), naive(samples, dims, {0, 0, 0}, 0, box, 0, 3));
  EXPECT_EQ(planes_of(*crop, 1, 2), naive(samples, dims, {0, 0, 0}, 0, box, 1, 2));
  Slab of_whole;
  Slab of_crop;
  whole.read(4, 5, of_whole);
  crop->read(1, 2, of_crop);
  EXPECT_EQ(of_crop.planes[0],
            of_whole.planes[0] + of_whole.row_stride_bytes + 2 * sizeof(std::uint16_t));
}

/// Makes samples for every read, and so should not be asked for whole planes.
class DearSlabs final : public SlabReader {
 public:
  explicit DearSlabs(const MemorySlabs& slabs) : slabs_(slabs) {}

  [[nodiscard]] const Volume& volume() const override { return slabs_.volume(); }
  void read(std::int32_t, std::int32_t, Slab&) const override { ADD_FAILURE() << "all of a plane"; }
  void read_box(const IndexBox& box, std::span<std::byte> out) const override {
    slabs_.read_box(box, out);
  }
  [[nodiscard]] bool reads_boxes_cheaply() const override { return true; }
  [[nodiscard]] bool rereads_cheaply() const override { return false; }

 private:
  const MemorySlabs& slabs_;
};

TEST(CropView, AsksForItsBoxAloneWhereThatIsCheaper) {
  const Index3 dims{9, 8, 6};
  const auto samples = blocky<std::uint16_t>(dims, 5);
  const MemorySlabs slabs(samples, dims);
  const IndexBox box{{2, 1, 3}, {6, 7, 5}};
  const DearSlabs dear(slabs);
  const auto crop = crop_view(dear, box);
  EXPECT_EQ(planes_of(*crop, 0, 3), naive(samples, dims, {0, 0, 0}, 0, box, 0, 3));
  EXPECT_EQ(planes_of(*crop, 1, 2), naive(samples, dims, {0, 0, 0}, 0, box, 1, 2));
}

}  // namespace
}  // namespace mc
