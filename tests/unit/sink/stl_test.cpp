// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <span>
#include <vector>

#include "unit/sink/sink_support.hpp"

namespace mc::test {
namespace {

SinkOptions stl(bool ascii = false) {
  return {.to = "stl", .ascii = ascii, .precision = {}, .provenance = {{"iso", "0.5"}}};
}

TEST(Stl, BinaryIsHeaderCountFacets) {
  const std::string bytes = written({}, stl(), {});
  ASSERT_EQ(bytes.size(), 84U + 4 * 50);
  std::string header = "binary STL; iso: 0.5";
  header.resize(80, ' ');
  EXPECT_EQ(bytes.substr(0, 80), header);
  EXPECT_EQ(bytes.substr(80, 4), std::string("\4\0\0\0", 4));
  const std::array<float, 12> second{0, -1, 0, 0, 0, 0, 0.1F, 0, -2, 1.5F, 0, 0};
  EXPECT_EQ(std::memcmp(bytes.data() + 84 + 50, second.data(), sizeof second), 0);
  EXPECT_EQ(bytes.substr(84 + 98, 2), std::string(2, '\0'));
}

TEST(Stl, AsciiIsTheseBytes) {
  const std::string bytes = written({}, stl(true), {});
  EXPECT_TRUE(
      bytes.starts_with("solid mc\n"
                        "facet normal 0 0 1\n"
                        " outer loop\n"
                        "  vertex 0 0 0\n"
                        "  vertex 1.5 0 0\n"
                        "  vertex 0 1 0\n"
                        " endloop\n"
                        "endfacet\n"
                        "facet normal 0 -1 0\n"))
      << bytes;
  EXPECT_TRUE(bytes.ends_with(" endloop\nendfacet\nendsolid mc\n")) << bytes;
}

TEST(Stl, EveryWayGivesTheSameBytes) {
  for (const bool ascii : {false, true}) {
    const std::string expected = written({}, stl(ascii), {});
    for (const Way& way : all_ways()) {
      EXPECT_EQ(written({}, stl(ascii), way), expected) << way.stream << way.counts << way.cut;
      EXPECT_EQ(written({.has_normals = true}, stl(ascii), way), expected);
    }
  }
}

/// Random triangles of vertices that lie anywhere, cut into chunks, some of which name vertices of
/// the whole mesh. Chunks are taken as a run with several slots takes them: the one before is
/// written when the next has its place.
std::string written_in_chunks(std::size_t reach, std::size_t n_chunks, bool ascii,
                              std::uint64_t seed) {
  constexpr std::size_t kVertices = 200, kTriangles = 3 * kVertices, kSlots = 3;
  std::mt19937_64 random(seed);
  Buffer<float> positions;
  for (std::size_t n = 0; n < 3 * kVertices; ++n) {
    positions.push_back(static_cast<float>(random() % 1000) / 8);
  }
  Buffer<std::uint32_t> indices;
  for (std::size_t t = 0; t < kTriangles; ++t) {
    const std::size_t first = (t + 2) / 3;  // at least the first vertex of its chunk
    for (int c = 0; c < 3; ++c) {
      indices.push_back(
          static_cast<std::uint32_t>(std::min(kVertices - 1, first + random() % reach)));
    }
  }
  std::vector<MeshChunk> chunks(n_chunks);
  for (std::size_t n = 0; n < n_chunks; ++n) {
    const auto part = [&](const auto& all, std::size_t size) {
      return std::span(all).subspan(3 * (size * n / n_chunks),
                                    3 * (size * (n + 1) / n_chunks - size * n / n_chunks));
    };
    const auto own = part(positions, kVertices);
    chunks[n].positions.assign(own.begin(), own.end());
    chunks[n].index_base = n % 4 == 3 ? 0 : kVertices * n / n_chunks;
    for (const std::uint32_t id : part(indices, kTriangles)) {
      chunks[n].indices.push_back(static_cast<std::uint32_t>(id - chunks[n].index_base));
    }
  }
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.stl", stl(ascii));
  sink->set_slots(kSlots);
  sink->begin_object({});
  for (std::size_t n = 0; n <= n_chunks; ++n) {
    if (n < n_chunks) {
      sink->format(chunks[n], n % kSlots);
      sink->place(chunks[n], n % kSlots);
    }
    if (n > 0) sink->write(chunks[n - 1], (n - 1) % kSlots);
  }
  sink->end_object({});
  sink->finish();
  return read_all(folder / "a.stl");
}

TEST(Stl, TrianglesMayNameVerticesOfAnyChunk) {
  for (const bool ascii : {false, true}) {
    for (const std::size_t reach : {1U, 10U, 30U, 60U, 200U}) {
      const std::string whole = written_in_chunks(reach, 1, ascii, reach);
      ASSERT_GT(whole.size(), 600U * 50);
      for (const std::size_t n_chunks : {2U, 5U, 11U, 40U}) {
        EXPECT_EQ(written_in_chunks(reach, n_chunks, ascii, reach), whole) << reach << n_chunks;
      }
    }
  }
}

TEST(Stl, DegenerateFacetsHaveNoNormal) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.stl", stl(true));
  MeshChunk chunk;
  chunk.positions = {1, 2, 3, 4, 5, 6};
  chunk.indices = {0, 1, 0};
  sink->begin_object({});
  sink->put(chunk);
  sink->end_object({});
  sink->finish();
  EXPECT_TRUE(read_all(folder / "a.stl").starts_with("solid mc\nfacet normal 0 0 0\n"));
}

TEST(Stl, EmptyCountsNothing) {
  const TemporaryFolder folder;
  open_mesh_sink(folder / "a.stl", {})->finish();
  std::string expected = "binary STL";
  expected.resize(80, ' ');
  EXPECT_EQ(read_all(folder / "a.stl"), expected + std::string(4, '\0'));
  open_mesh_sink(folder / "b.stl", stl(true))->finish();
  EXPECT_EQ(read_all(folder / "b.stl"), "solid mc\nendsolid mc\n");
}

TEST(Stl, RefusesMoreFacetsThanItsCountHolds) {
  const TemporaryFolder folder;
  MeshObject object;
  object.n_triangles = std::uint64_t{1} << 32;
  EXPECT_EQ(error_text([&] { open_mesh_sink(folder / "a.stl", {})->begin_object(object); },
                       ErrorKind::limit),
            folder /
                "a.stl: 4294967296 triangles, but STL holds at most 4294967295; write .ply or "
                ".obj, or one --region at a time");
}

TEST(Stl, ATriangleWithoutVertexIsAFaultOfOurs) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.stl", {});
  MeshChunk chunk;
  chunk.indices = {0, 1, 2};
  sink->begin_object({});
  sink->put(chunk);
  sink->end_object({});
  EXPECT_EQ(error_text([&] { sink->finish(); }, ErrorKind::internal),
            folder / "a.stl: a triangle names no vertex");
}

}  // namespace
}  // namespace mc::test
