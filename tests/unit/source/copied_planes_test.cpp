// SPDX-License-Identifier: MIT
#include "source/copied_planes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <thread>
#include <vector>

#include "support/source_files.hpp"

namespace mc {
namespace {

using test::counting_bytes;
using test::error_of;
using test::Folder;
using test::slabs;

constexpr std::int32_t kPlanes = 40;
constexpr std::size_t kPlaneBytes = 5 * 4;
const std::string kHead = "head";

SourceOptions options_for(Reading reading) {
  SourceOptions options;
  options.dims = {5, 4, kPlanes};
  options.type = SampleType::u8;
  options.skip_bytes = kHead.size();
  options.reading = reading;
  return options;
}

std::string bytes_of(const Slab& slab, std::size_t n) {
  return {reinterpret_cast<const char*>(slab.planes[n]), kPlaneBytes};
}

class CopiedPlanes : public ::testing::Test {
 protected:
  [[nodiscard]] Source open(Reading reading) const {
    return test::open({path_}, options_for(reading));
  }

  Folder folder_;
  std::string samples_ = counting_bytes(kPlaneBytes * kPlanes);
  std::string path_ = folder_.file("a.raw", kHead + samples_);
};

TEST_F(CopiedPlanes, AreThoseOfTheFile) {
  const Source source = open(Reading::copied);
  const auto copies = slabs(source).copies(8);
  ASSERT_NE(copies, nullptr);
  Slab slab;
  for (std::int32_t k = 0; k < kPlanes; k += 7) {
    const std::int32_t end = std::min(k + 9, kPlanes);
    copies->read(k, end, slab);
    EXPECT_EQ(slab.k0, k);
    EXPECT_EQ(slab.row_stride_bytes, 5U);
    ASSERT_EQ(slab.planes.size(), static_cast<std::size_t>(end - k));
    for (std::size_t n = 0; n < slab.planes.size(); ++n) {
      const std::size_t at = (static_cast<std::size_t>(k) + n) * kPlaneBytes;
      EXPECT_EQ(bytes_of(slab, n), samples_.substr(at, kPlaneBytes));
    }
  }
}

TEST_F(CopiedPlanes, OfNeighboursAreReadOnce) {
  const Source source = open(Reading::copied);
  const auto copies = slabs(source).copies(8);
  Slab lower, upper;
  copies->read(0, 5, lower);
  copies->read(3, 8, upper);
  EXPECT_EQ(upper.planes[0], lower.planes[3]);
  EXPECT_EQ(upper.planes[1], lower.planes[4]);
  const std::byte* const kept = upper.planes[4];
  copies->read(7, 9, upper);
  EXPECT_EQ(upper.planes[0], kept);
  // Memory of planes that no slab has any more is used again.
  std::vector<const std::byte*> seen(lower.planes);
  copies->read(20, 25, lower);
  for (const std::byte* plane : lower.planes) {
    seen.push_back(plane);
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  EXPECT_LT(seen.size(), 10U);
}

TEST_F(CopiedPlanes, AreReadByManyThreadsAtOnce) {
  const Source source = open(Reading::copied);
  const auto copies = slabs(source).copies(8);
  std::vector<std::thread> threads;
  std::atomic<int> n_wrong = 0;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      Slab slab;
      for (std::int32_t k = t % 2; k + 3 <= kPlanes; ++k) {
        copies->read(k, k + 3, slab);
        for (std::size_t n = 0; n < 3; ++n) {
          const std::size_t at = (static_cast<std::size_t>(k) + n) * kPlaneBytes;
          if (bytes_of(slab, n) != samples_.substr(at, kPlaneBytes)) ++n_wrong;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(n_wrong, 0);
}

TEST_F(CopiedPlanes, OfAFileThatWasCutAreAnError) {
  const Source source = open(Reading::copied);
  const auto copies = slabs(source).copies(8);
  Slab slab;
  std::filesystem::resize_file(path_, kHead.size() + 10 * kPlaneBytes + 1);
  copies->read(7, 10, slab);
  for (int tries = 0; tries < 2; ++tries) {
    EXPECT_EQ(error_of([&] { copies->read(8, 12, slab); }),
              "3 " + path_ +
                  ": became shorter while it was read; run again when nothing "
                  "writes to it");
  }
}

TEST_F(CopiedPlanes, AreNotMadeIfMappedOrOfSmallFiles) {
  EXPECT_EQ(slabs(open(Reading::mapped)).copies(8), nullptr);
  EXPECT_EQ(slabs(open(Reading::fastest)).copies(8), nullptr);
}

TEST_F(CopiedPlanes, AreNotMadeOfSlices) {
  SourceOptions options = options_for(Reading::copied);
  options.dims = {5, 4};
  options.skip_bytes = 0;
  const std::vector<std::string> slices{folder_.file("1.raw", counting_bytes(kPlaneBytes)),
                                        folder_.file("2.raw", counting_bytes(kPlaneBytes))};
  EXPECT_EQ(slabs(test::open(slices, options)).copies(8), nullptr);
}

}  // namespace
}  // namespace mc
