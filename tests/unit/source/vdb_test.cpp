// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_VDB

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>

#include <atomic>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "support/source_files.hpp"
#include "support/vdb_grids.hpp"

// Files are written here with OpenVDB and read through the port; what leaves, tiles and background
// say together must be what OpenVDB's own accessor says, sample by sample.

namespace mc {
namespace {

using test::error_of_open;
using test::Folder;
using test::leaves;
using test::open;

/// The port as one lookup.
class Lookup {
 public:
  explicit Lookup(const LeafReader& reader) : reader_(reader) {
    for (std::size_t n = 0; n < reader.leaves().size(); ++n) {
      leaf_at_[reader.leaves()[n]] = n;
    }
  }
  [[nodiscard]] std::pair<double, bool> at(const Index3& p) const {
    const SampleType type = reader_.volume().type;
    const auto leaf = leaf_at_.find({p[0] & ~7, p[1] & ~7, p[2] & ~7});
    if (leaf != leaf_at_.end()) {
      alignas(8) std::array<std::byte, 512 * 8> scratch{};
      const std::byte* values = reader_.leaf_values(leaf->second, scratch.data());
      const auto n = static_cast<std::size_t>((p[0] & 7) * 64 + (p[1] & 7) * 8 + (p[2] & 7));
      Scalar s;
      std::memcpy(s.bytes.data(), values + n * sample_size(type), sample_size(type));
      const std::uint64_t word = reader_.leaf_active(leaf->second)[n / 64];
      return {to_double(s, type), ((word >> (n % 64)) & 1U) != 0};
    }
    for (const Tile& tile : reader_.tiles()) {
      const IndexBox box{tile.origin,
                         {tile.origin[0] + tile.size - 1, tile.origin[1] + tile.size - 1,
                          tile.origin[2] + tile.size - 1}};
      if (box.contains(p)) {
        return {to_double(tile.value, type), tile.active};
      }
    }
    return {to_double(reader_.background(), type), false};
  }

 private:
  const LeafReader& reader_;
  std::map<Index3, std::size_t> leaf_at_;
};

/// Compares the port with an accessor over [lo, hi]; returns the number of differing samples.
template <class GridT>
int differences(const LeafReader& reader, const GridT& grid, const Index3& lo, const Index3& hi) {
  const Lookup lookup(reader);
  auto accessor = grid.getConstAccessor();
  int n = 0;
  for (std::int32_t i = lo[0]; i <= hi[0]; ++i) {
    for (std::int32_t j = lo[1]; j <= hi[1]; ++j) {
      for (std::int32_t k = lo[2]; k <= hi[2]; ++k) {
        const openvdb::Coord at(i, j, k);
        const auto [value, active] = lookup.at({i, j, k});
        const bool same =
            value == static_cast<double>(accessor.getValue(at)) && active == accessor.isValueOn(at);
        n += same ? 0 : 1;
      }
    }
  }
  return n;
}

/// Leaves stay in their file then.
const SourceOptions kLittleMemory = [] {
  SourceOptions options;
  options.memory_bytes = 1;
  return options;
}();

template <class GridT>
void expect_round_trip(SampleType type, typename GridT::ValueType background) {
  openvdb::initialize();
  const Folder folder;
  auto grid = test::noise_grid<GridT>(background);
  grid->setName("n");
  test::write_grids(folder.path("n.vdb"), {grid});
  const Source source = open({folder.path("n.vdb")});
  const Source packed = open({folder.path("n.vdb")}, kLittleMemory);
  EXPECT_EQ(differences(leaves(packed), *grid, {-42, -14, -14}, {19, 19, 19}), 0);
  const LeafReader& reader = leaves(source);
  EXPECT_EQ(reader.volume().type, type);
  EXPECT_EQ(reader.volume().n_active, grid->activeVoxelCount());
  const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  EXPECT_EQ(reader.volume().lattice.box, (IndexBox{{box.min().x(), box.min().y(), box.min().z()},
                                                   {box.max().x(), box.max().y(), box.max().z()}}));
  EXPECT_EQ(differences(reader, *grid, {-42, -14, -14}, {19, 19, 19}), 0);
  EXPECT_TRUE(std::ranges::is_sorted(reader.leaves(), [](const Index3& a, const Index3& b) {
    return std::tuple(a[2], a[1], a[0]) < std::tuple(b[2], b[1], b[0]);
  }));
}

TEST(Vdb, EveryScalarType) {
  expect_round_trip<openvdb::FloatGrid>(SampleType::f32, 3);
  expect_round_trip<openvdb::DoubleGrid>(SampleType::f64, -2);
  expect_round_trip<openvdb::Int32Grid>(SampleType::i32, 5);
  expect_round_trip<openvdb::Int64Grid>(SampleType::i64, -5);
  expect_round_trip<openvdb::BoolGrid>(SampleType::u8, false);
}

/// A leaf each for every way in which OpenVDB leaves out inactive values, and two whole ones.
openvdb::FloatGrid::Ptr every_kind_of_leaf(float background) {
  auto grid = openvdb::FloatGrid::create(background);
  const std::vector<std::vector<float>> inactive{{background},
                                                 {-background},
                                                 {7},
                                                 {background, -background},
                                                 {background, 7},
                                                 {-background, 7},
                                                 {7, 8},
                                                 {7, 8, 9},
                                                 {},
                                                 {0.F, -0.F},
                                                 {-background},
                                                 {1e30F, background}};
  std::mt19937 random(3);
  for (std::size_t n = 0; n < inactive.size(); ++n) {
    auto* leaf = new openvdb::FloatTree::LeafNodeType(
        openvdb::Coord(static_cast<int>(n) * 8 - 32, 8, -8), background);
    for (openvdb::Index at = 0; at < openvdb::FloatTree::LeafNodeType::SIZE; ++at) {
      const auto value = static_cast<float>(random() % 1000U) / 8;
      if (inactive[n].empty() || at / 64 == 2 || random() % 3U == 0) {
        leaf->setValueOn(at, value);
      } else {
        leaf->setValueOff(at, inactive[n][random() % inactive[n].size()]);
      }
    }
    grid->tree().addLeaf(leaf);
  }
  grid->tree().addTile(1, {0, 512, 0}, background == 0 ? 5 : -background, false);
  grid->tree().addTile(2, {0, 1024, 0}, 3, true);
  return grid;
}

TEST(Vdb, EveryCompressionAndKindOfLeaf) {
  using namespace openvdb::io;
  openvdb::initialize();
  const Folder folder;
  const std::vector<std::uint32_t> all{COMPRESS_NONE,
                                       COMPRESS_ZIP,
                                       COMPRESS_BLOSC,
                                       COMPRESS_ACTIVE_MASK,
                                       COMPRESS_ZIP | COMPRESS_ACTIVE_MASK,
                                       COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK};
  for (const std::uint32_t flags : all) {
    for (const bool as_half : {false, true}) {
      for (const float background : {3.F, 0.F}) {
        const auto grid = every_kind_of_leaf(background);
        grid->setSaveFloatAsHalf(as_half);
        openvdb::io::File file(folder.path("c.vdb"));
        file.setCompression(flags);
        file.write({grid});
        openvdb::io::File back(folder.path("c.vdb"));  // halves round: OpenVDB says to what
        back.open();
        const auto expected = openvdb::gridPtrCast<openvdb::FloatGrid>(back.readGrid(""));
        const Source source = open({folder.path("c.vdb")});
        const std::string message = std::to_string(flags) + (as_half ? " half" : "");
        EXPECT_EQ(differences(leaves(source), *expected, {-33, 7, -9}, {65, 16, 0}), 0) << message;
        EXPECT_EQ(leaves(source).tiles().size(), 2U) << message;
        const Source packed = open({folder.path("c.vdb")}, kLittleMemory);
        EXPECT_EQ(differences(leaves(packed), *expected, {-33, 7, -9}, {65, 16, 0}), 0) << message;
      }
    }
  }
}

TEST(Vdb, MasksAreTheirActiveSamples) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::MaskGrid::create();
  grid->tree().setValueOn({1, 2, 3});
  grid->tree().setValueOn({100, 2, 3});
  grid->tree().addTile(1, {-8, -8, -8}, true, true);
  test::write_grids(folder.path("m.vdb"), {grid});
  const Source source = open({folder.path("m.vdb")});
  EXPECT_EQ(volume_of(source.reader).type, SampleType::u8);
  EXPECT_EQ(volume_of(source.reader).cls, VolumeClass::mask);
  EXPECT_EQ(volume_of(source.reader).n_active, 514U);
  EXPECT_EQ(differences(leaves(source), *grid, {-10, -10, -10}, {8, 8, 8}), 0);
}

TEST(Vdb, LeavesThatAreTooManyStayInTheFile) {
  openvdb::initialize();
  const Folder folder;
  for (const std::uint32_t compression :
       {openvdb::io::COMPRESS_NONE, openvdb::io::COMPRESS_BLOSC}) {
    openvdb::io::File file(folder.path("n.vdb"));
    file.setCompression(compression);
    file.write({test::noise_grid<openvdb::FloatGrid>(3)});
    SourceOptions options;
    const Source whole = open({folder.path("n.vdb")}, options);
    const std::size_t n = leaves(whole).leaves().size();
    const std::uint64_t values = n * 2048;
    ASSERT_GT(leaves(whole).held_bytes(), values);
    const std::uint64_t tree = leaves(whole).held_bytes() - values;
    options.memory_bytes = 2 * (tree + values);
    EXPECT_EQ(leaves(open({folder.path("n.vdb")}, options)).held_bytes(), tree + values);
    options.memory_bytes -= 2;
    const Source packed = open({folder.path("n.vdb")}, options);
    EXPECT_LT(leaves(packed).held_bytes(), tree + values / 2);
    std::array<std::byte, 4096> first{}, again{};
    for (std::size_t leaf = 0; leaf < n; ++leaf) {
      const std::byte* expected = leaves(whole).leaf_values(leaf, first.data());
      EXPECT_EQ(std::memcmp(leaves(packed).leaf_values(leaf, again.data()), expected, 2048), 0);
    }
  }
}

TEST(Vdb, LeavesInTheFileMayBeAskedForByAllThreads) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(0);
  for (int n = 0; n < 4000; ++n) {
    grid->tree().setValueOn({8 * (n % 40), 8 * (n / 40), 0}, static_cast<float>(n));
  }
  test::write_grids(folder.path("n.vdb"), {grid});
  SourceOptions options;
  options.memory_bytes = 1 << 20;  // a cache of 64 leaves
  const Source source = open({folder.path("n.vdb")}, options);
  const LeafReader& reader = leaves(source);
  std::atomic<int> n_wrong{0};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      std::array<std::byte, 2048> scratch{};
      for (std::size_t n = 0; n < 2 * reader.leaves().size(); ++n) {
        const std::size_t row_before = n % 2 == 0 || n < 80 ? 0 : 40;  // as neighbours are
        const std::size_t leaf = n / 2 - row_before;
        const Index3 at = reader.leaves()[leaf];
        float value = 0;
        std::memcpy(&value, reader.leaf_values(leaf, scratch.data()), sizeof value);
        n_wrong += value == static_cast<float>(at[0] / 8 + 40 * (at[1] / 8)) ? 0 : 1;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(n_wrong, 0);
}

TEST(Vdb, NumbersAreNotCopied) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(0);
  grid->tree().setValueOn({1, 2, 3}, 9);
  test::write_grids(folder.path("f.vdb"), {grid});
  const Source source = open({folder.path("f.vdb")});
  std::array<std::byte, 4096> scratch{};
  const std::byte* values = leaves(source).leaf_values(0, scratch.data());
  EXPECT_NE(values, scratch.data());
  float value = 0;
  std::memcpy(&value, values + 4 * (1 * 64 + 2 * 8 + 3), sizeof value);
  EXPECT_EQ(value, 9);
}

TEST(Vdb, HalfIsWidenedAndSaidSo) {
  openvdb::initialize();
  const Folder folder;
  auto grid = test::noise_grid<openvdb::FloatGrid>(3);
  grid->setSaveFloatAsHalf(true);
  test::write_grids(folder.path("h.vdb"), {grid});
  const Source source = open({folder.path("h.vdb")});
  EXPECT_EQ(volume_of(source.reader).type, SampleType::f32);
  EXPECT_EQ(volume_of(source.reader).stored_as, "half");
  EXPECT_EQ(differences(leaves(source), *grid, {-14, -14, -14}, {19, 19, 19}), 0);
}

TEST(Vdb, TilesOfEveryLevel) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(1);
  openvdb::FloatTree& tree = grid->tree();
  tree.addTile(1, {8, 0, 0}, 2, true);
  tree.addTile(1, {16, 0, 0}, 3, false);
  tree.addTile(1, {24, 0, 0}, 1, true);   // active, of background value
  tree.addTile(1, {32, 0, 0}, 1, false);  // nothing
  tree.addTile(2, {-128, 0, 0}, 4, true);
  tree.addTile(2, {-256, 0, 0}, 5, false);
  tree.addTile(3, {4096, 0, 0}, 6, false);
  tree.addTile(3, {-8192, 4096, 0}, 7, true);
  test::write_grids(folder.path("t.vdb"), {grid});
  const Source source = open({folder.path("t.vdb")});
  std::map<Index3, std::tuple<int, float, bool>> tiles;
  for (const Tile& tile : leaves(source).tiles()) {
    tiles[tile.origin] = {tile.size, tile.value.as<float>(), tile.active};
  }
  const std::map<Index3, std::tuple<int, float, bool>> expected{
      {{8, 0, 0}, {8, 2.F, true}},          {{16, 0, 0}, {8, 3.F, false}},
      {{24, 0, 0}, {8, 1.F, true}},         {{-128, 0, 0}, {128, 4.F, true}},
      {{-256, 0, 0}, {128, 5.F, false}},    {{4096, 0, 0}, {4096, 6.F, false}},
      {{-8192, 4096, 0}, {4096, 7.F, true}}};
  EXPECT_EQ(tiles, expected);
  EXPECT_EQ(volume_of(source.reader).n_active,
            2U * 512 + 128ULL * 128 * 128 + 4096ULL * 4096 * 4096);
}

TEST(Vdb, SharedTreesAndStreamsWithoutOffsets) {
  openvdb::initialize();
  const Folder folder;
  auto a = test::noise_grid<openvdb::FloatGrid>(3);
  a->setName("a");
  auto b = a->copyWithNewTree();  // then given a's own tree, which is written once
  b->setTree(a->treePtr());
  b->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  b->setName("b");
  auto c = openvdb::Vec3SGrid::create();
  c->setName("c");
  const openvdb::GridPtrVec grids{c, a, b};
  test::write_grids(folder.path("shared.vdb"), grids);
  std::ostringstream stream(std::ios::binary);
  openvdb::io::Stream(stream).write(grids);
  const std::string streamed = folder.file("streamed.vdb", stream.str());
  SourceOptions options;
  options.grid = "b";
  for (const std::string& file : {folder.path("shared.vdb"), streamed}) {
    const Source source = open({file}, options);
    EXPECT_EQ(differences(leaves(source), *a, {-14, -14, -14}, {19, 19, 19}), 0) << file;
    EXPECT_EQ(volume_of(source.reader).lattice.to_world.spacing(0), 0.5);
    EXPECT_EQ(source.other_grids, std::vector<std::string>{"a"});
    EXPECT_EQ(describe_source(std::vector{file}, {}, silent_progress()).size(), 3U);
  }
}

TEST(Vdb, StreamsArePassedOverAsFarAsTheyCanBe) {
  openvdb::initialize();
  const Folder folder;
  auto scalar = test::noise_grid<openvdb::FloatGrid>(3);
  scalar->setName("s");
  auto bits = test::noise_grid<openvdb::BoolGrid>(false);
  bits->setName("b");
  auto frustum = openvdb::FloatGrid::create(0);
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 2.0));
  auto points = openvdb::points::PointDataGrid::create();
  points->setName("p");
  const auto streamed = [&](const openvdb::GridPtrVec& grids) {
    std::ostringstream stream(std::ios::binary);
    openvdb::io::Stream(stream).write(grids);
    return folder.file("streamed.vdb", stream.str());
  };
  SourceOptions options;
  options.grid = "s";
  const Source source = open({streamed({frustum, bits, scalar, points})}, options);
  EXPECT_EQ(differences(leaves(source), *scalar, {-14, -14, -14}, {19, 19, 19}), 0);
  const std::string file = streamed({points, scalar});
  EXPECT_EQ(error_of_open({file}, options),
            "3 " + file +
                ": grid \"p\": type \"ptdataidx32\" in a file without offsets: what follows it "
                "cannot be found; write the file again, to a disk and not to a pipe");
}

}  // namespace
}  // namespace mc

#endif
