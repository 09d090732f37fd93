// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "base/parallel.hpp"
#include "cli/bench/bench_field.hpp"
#include "cli/bench/bench_memory.hpp"
#include "cli/bench/bench_rounds.hpp"
#include "cli/bench/bench_surface.hpp"

namespace mc::cli {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::int32_t kSize = 24;

/// The mesh of a field, which some tests then spoil.
Mesh mesh_of(const BenchVolume& volume, Normals normals = Normals::gradient) {
  BenchSurface surface(volume, normals);
  surface.extract();
  return surface.mesh();
}

TEST(BenchSurface, IsRightForEveryField) {
  for (const std::string_view name : kBenchFields) {
    const BenchVolume volume = make_bench_volume(name, kSize, SampleType::f32);
    EXPECT_EQ(fault_of(volume, mesh_of(volume)), "") << name;
  }
}

TEST(BenchSurface, IsRightForEveryType) {
  for (const SampleType type :
       {SampleType::u8, SampleType::i8, SampleType::u16, SampleType::i16, SampleType::u32,
        SampleType::i32, SampleType::i64, SampleType::f16, SampleType::f32, SampleType::f64}) {
    const BenchVolume volume = make_bench_volume("sphere", kSize, type);
    const Mesh mesh = mesh_of(volume);
    EXPECT_EQ(fault_of(volume, mesh), "") << sample_name(type);
    EXPECT_EQ(fault_of_sphere(mesh, kSize, type), "") << sample_name(type);
  }
}

TEST(BenchSurface, ProvesTheDemosTerrain) {
  const BenchVolume volume = make_demo_volume(10);
  EXPECT_EQ(fault_of(volume, mesh_of(volume)), "");
}

class SpoiltMesh : public testing::Test {
 protected:
  BenchVolume volume_ = make_bench_volume("gyroid", kSize, SampleType::f32);
  Mesh mesh_ = mesh_of(volume_);
};

TEST_F(SpoiltMesh, OneVertexTooMany) {
  mesh_.positions.push_back({0, 0, 0});
  EXPECT_THAT(fault_of(volume_, mesh_), HasSubstr("crossed edges"));
}

TEST_F(SpoiltMesh, ATriangleTurnedRound) {
  std::swap(mesh_.triangles[100][0], mesh_.triangles[100][1]);
  EXPECT_THAT(fault_of(volume_, mesh_), HasSubstr("not run once each way"));
}

TEST_F(SpoiltMesh, ATriangleMissing) {
  mesh_.triangles.erase(mesh_.triangles.begin() + 100);
  EXPECT_THAT(fault_of(volume_, mesh_), HasSubstr("not run once each way"));
}

TEST_F(SpoiltMesh, AnIndexOutOfRange) {
  mesh_.triangles[7][2] = static_cast<std::uint32_t>(mesh_.positions.size());
  EXPECT_THAT(fault_of(volume_, mesh_), StartsWith("a triangle names vertex"));
}

TEST_F(SpoiltMesh, AVertexWithoutATriangle) {
  for (auto& triangle : mesh_.triangles) {
    for (std::uint32_t& v : triangle) v = v == 5 ? 6 : v;
  }
  EXPECT_EQ(fault_of(volume_, mesh_), "vertex 5 is in no triangle");
}

TEST_F(SpoiltMesh, ANormalTooLong) {
  mesh_.normals[3] = {1, 1, 0};
  EXPECT_THAT(fault_of(volume_, mesh_), StartsWith("a normal of length 1.41"));
}

TEST(BenchSphere, OfAnotherSizeIsRefused) {
  const BenchVolume volume = make_bench_volume("sphere", 64, SampleType::f32);
  Mesh mesh = mesh_of(volume);
  for (auto& p : mesh.positions) p[0] *= 1.05F;
  EXPECT_THAT(fault_of_sphere(mesh, 64, SampleType::f32), StartsWith("area "));
}

TEST(BenchSphere, OfFewLevelsIsAStair) {
  const BenchVolume volume = make_bench_volume("sphere", 512, SampleType::u8);
  const Mesh mesh = mesh_of(volume);
  EXPECT_EQ(fault_of_sphere(mesh, 512, SampleType::u8), "");
  EXPECT_THAT(fault_of_sphere(mesh, 512, SampleType::f32), StartsWith("area "));
}

TEST(BenchField, FillsAnIntegersRange) {
  const BenchVolume f32 = make_bench_volume("terrain", kSize, SampleType::f32);
  const BenchVolume u8 = make_bench_volume("terrain", kSize, SampleType::u8);
  EXPECT_EQ(u8.iso, 127.5);
  for (std::size_t n = 0; n < u8.samples.size(); ++n) {
    float value = 0;
    std::memcpy(&value, f32.samples.data() + n * sizeof value, sizeof value);
    const double wanted = 127.5 + 127.5 * std::clamp(value, -1.0F, 1.0F);
    ASSERT_NEAR(std::to_integer<int>(u8.samples.data()[n]), wanted, 0.5001);
  }
}

TEST(BenchRounds, GiveEachBodyItsTurnAndItsThreads) {
  std::vector<int> order;
  const auto body = [&](int name) {
    return [&order, name] {
      const auto began = std::chrono::steady_clock::now();
      while (std::chrono::steady_clock::now() - began < std::chrono::milliseconds(2)) {
      }
      order.push_back(10 * name + base::thread_count());
    };
  };
  const std::vector<TimedBody> bodies{{1, body(1)}, {2, body(2)}};
  const auto timings = time_rounds(bodies, {.min_rounds = 3, .max_rounds = 3, .seconds = 0});
  ASSERT_EQ(timings.size(), 2U);
  EXPECT_EQ(timings[0].n_rounds, 3U);
  EXPECT_GE(timings[0].least, 2e-3);
  EXPECT_GE(timings[0].median, timings[0].least);
  order.erase(order.begin(), order.end() - 6);
  EXPECT_EQ(order, (std::vector{11, order[1], 11, order[1], 11, order[1]}));
  EXPECT_EQ(order[1] / 10, 2);
}

TEST(BenchMemory, ReadsAndWritesAllOfIt) {
  const BenchArray array(2 * kStreamBlock);
  write_past_cache(array.data(), array.size());
  std::uint64_t n_words = array.size() / sizeof(std::uint64_t);
  std::uint64_t last = 0;
  std::memcpy(&last, array.data() + array.size() - sizeof last, sizeof last);
  EXPECT_GE(last + 8, n_words);  // each vector holds its first word's number
  std::memset(array.data(), 0, array.size());
  EXPECT_EQ(read_one_stream(array.data(), array.size()), 0U);
  EXPECT_EQ(read_eight_streams(array.data(), array.size()), 0U);
  for (std::size_t at = 0; at < array.size(); at += 1000) {
    array.data()[at] = std::byte{1};
    EXPECT_NE(read_one_stream(array.data(), array.size()), 0U) << at;
    EXPECT_NE(read_eight_streams(array.data(), array.size()), 0U) << at;
    array.data()[at] = std::byte{0};
  }
}

}  // namespace
}  // namespace mc::cli
