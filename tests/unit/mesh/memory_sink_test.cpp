// SPDX-License-Identifier: MIT
#include "mesh/memory_sink.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "base/simd_target.hpp"
#include "mesh/word_kernels.hpp"

namespace mc::mesh {
namespace {

TEST(MoveWords, IsAnAdditionOnEveryTarget) {
  std::vector<std::uint32_t> from(200);
  std::iota(from.begin(), from.end(), 0xFFFFFF80U);
  for (const std::string& target : base::simd_targets()) {
    ASSERT_TRUE(base::set_simd_target(target));
    for (const Stores stores : {Stores::cached, Stores::streamed}) {
      for (std::size_t at = 0; at < 20; ++at) {
        for (const std::size_t n : {0U, 1U, 5U, 16U, 33U, 100U, 150U}) {
          std::vector<std::uint32_t> to(200, 7);
          move_words(from.data() + 3, n, 300, to.data() + at, stores);
          for (std::size_t i = 0; i < to.size(); ++i) {
            const bool inside = i >= at && i < at + n;
            ASSERT_EQ(to[i], inside ? from[i - at + 3] + 300 : 7)
                << target << " at " << at << " n " << n << " word " << i;
          }
        }
      }
    }
  }
  base::reset_simd_target();
}

MeshChunk chunk_of(std::size_t n_vertices, std::size_t n_triangles, float value) {
  MeshChunk chunk;
  chunk.positions.assign(3 * n_vertices, value);
  chunk.normals.assign(3 * n_vertices, -value);
  chunk.indices.assign(3 * n_triangles, 1);
  return chunk;
}

TEST(MemorySink, PlacesInOrderWhateverTheOrderOfWriting) {
  Mesh mesh;
  MemorySink sink;
  sink.start(mesh);
  sink.set_slots(2);
  sink.begin_object({});
  MeshChunk first = chunk_of(2, 1, 1);
  MeshChunk second = chunk_of(1, 2, 2);
  second.index_base = 2;
  sink.place(first, 0);
  sink.place(second, 1);
  sink.write(second, 1);
  sink.write(first, 0);
  sink.end_object({});
  sink.finish();
  using Triple = std::array<float, 3>;
  using Ids = std::array<std::uint32_t, 3>;
  EXPECT_EQ(mesh.positions, (Buffer<Triple>{{1, 1, 1}, {1, 1, 1}, {2, 2, 2}}));
  EXPECT_EQ(mesh.normals, (Buffer<Triple>{{-1, -1, -1}, {-1, -1, -1}, {-2, -2, -2}}));
  EXPECT_EQ(mesh.triangles, (Buffer<Ids>{{1, 1, 1}, {3, 3, 3}, {3, 3, 3}}));
}

TEST(MemorySink, StoresDoublesOnlyIfChunksHaveThem) {
  Mesh mesh;
  MemorySink sink;
  for (const bool doubles : {true, false, true}) {
    sink.start(mesh);
    sink.begin_object({});
    for (const float value : {1.0F, 2.0F}) {
      MeshChunk chunk = chunk_of(2, 1, value);
      if (doubles) chunk.positions_f64.assign(std::exchange(chunk.positions, {}).size(), value);
      sink.put(chunk);
    }
    sink.end_object({});
    sink.finish();
    ASSERT_EQ(mesh.n_vertices(), 4U);
    EXPECT_EQ(mesh.positions_f64.size(), doubles ? 4U : 0U);
    EXPECT_EQ(mesh.position(1), (Vec3{1, 1, 1}));
    EXPECT_EQ(mesh.position(2), (Vec3{2, 2, 2}));
    EXPECT_EQ(mesh.normals.size(), 4U);
  }
}

TEST(MemorySink, StoresAttributes) {
  Mesh mesh;
  MemorySink sink;
  sink.start(mesh);
  MeshObject object;
  object.attributes = {{"kind", SampleType::u8}, {"flow", SampleType::f64, 2}};
  sink.set_slots(2);
  sink.begin_object(object);
  std::array<MeshChunk, 2> chunks{chunk_of(2, 1, 1), chunk_of(1, 1, 2)};
  std::uint8_t next = 0;
  for (MeshChunk& chunk : chunks) {
    for (const AttributeInfo& info : object.attributes) {
      chunk.attributes.push_back({info, Buffer<std::byte>(chunk.n_vertices() * info.bytes())});
    }
    for (std::uint8_t& kind : chunk.attributes[0].values_as<std::uint8_t>()) kind = ++next;
    for (double& flow : chunk.attributes[1].values_as<double>()) flow = ++next;
  }
  sink.place(chunks[0], 0);
  sink.place(chunks[1], 1);
  sink.write(chunks[1], 1);
  sink.write(chunks[0], 0);
  sink.end_object({});
  sink.finish();
  ASSERT_EQ(mesh.attributes.size(), 2U);
  EXPECT_EQ(mesh.attributes[1].info, object.attributes[1]);
  const auto kinds = mesh.attributes[0].values_as<std::uint8_t>();
  const auto flows = mesh.attributes[1].values_as<double>();
  EXPECT_EQ(std::vector(kinds.begin(), kinds.end()), (std::vector<std::uint8_t>{1, 2, 7}));
  EXPECT_EQ(std::vector(flows.begin(), flows.end()), (std::vector<double>{3, 4, 5, 6, 8, 9}));
  mesh.clear();
  EXPECT_TRUE(mesh.attributes[0].values.empty());
}

TEST(MemorySink, KeepsWhatIsWrittenWhenItMoves) {
  Mesh mesh;
  MemorySink sink;
  sink.start(mesh);
  sink.begin_object({});
  std::size_t n = 0;
  for (std::size_t c = 1; n < 1000000; c *= 2) {  // past the size from which it streams
    sink.put(chunk_of(c, c, static_cast<float>(n)));
    n += c;
  }
  ASSERT_EQ(mesh.positions.size(), n);
  ASSERT_EQ(mesh.triangles.size(), n);
  std::size_t at = 0;
  for (std::size_t c = 1; at < n; c *= 2) {
    for (std::size_t i = at; i < at + c; ++i) {
      ASSERT_EQ(mesh.positions[i][2], static_cast<float>(at)) << i;
    }
    at += c;
  }
}

}  // namespace
}  // namespace mc::mesh
