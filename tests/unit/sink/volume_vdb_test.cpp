// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_VDB

#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <sys/stat.h>

#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "base/parallel.hpp"
#include "mc/sink.hpp"
#include "support/memory_readers.hpp"
#include "unit/sink/volume_support.hpp"

namespace mc {
namespace {

using openvdb::Coord;
using test::bytes_of;
using test::MemoryLeaves;
using test::MemorySlabs;
using test::VolumeFolder;
using test::write_planes;
using test::write_volume;

openvdb::GridBase::Ptr only_grid(const std::string& path) {
  openvdb::io::File file(path);
  file.open(/*delayLoad=*/false);
  const auto grids = file.getGrids();
  EXPECT_EQ(grids->size(), 1U);
  return grids->front();
}

/// The only grid of a file, which must be of this type.
template <class Grid>
typename Grid::Ptr only(const std::string& path) {
  const auto grid = openvdb::gridPtrCast<Grid>(only_grid(path));
  EXPECT_NE(grid, nullptr);
  return grid;
}

/// Noise in some blocks of 8, 4 in all others.
template <class T>
std::vector<T> patches(const Index3& dims) {
  std::mt19937 random(3);
  std::vector<T> out;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) {
        const bool noisy = (i / 8 + j / 8 + k / 8) % 3 == 0;
        out.push_back(static_cast<T>(noisy ? static_cast<int>(random() % 100) : 4));
      }
    }
  }
  return out;
}

template <class Grid, class T>
void expect_round_trip(std::endian endian) {
  const VolumeFolder folder;
  const Index3 dims{21, 16, 19};
  const auto samples = patches<T>(dims);
  MemorySlabs::Layout layout;
  layout.endian = endian;
  layout.lead = 1;
  write_volume(folder / "v.vdb", MemorySlabs(samples, dims, layout), {}, 5);
  const auto grid = only<Grid>(folder / "v.vdb");
  ASSERT_NE(grid, nullptr);
  EXPECT_EQ(grid->activeVoxelCount(), samples.size());
  EXPECT_EQ(grid->evalActiveVoxelBoundingBox(), openvdb::CoordBBox(Coord(0), Coord(20, 15, 18)));
  EXPECT_GT(grid->tree().activeTileCount(), 0U);
  std::size_t at = 0;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i, ++at) {
        ASSERT_EQ(grid->tree().getValue(Coord(i, j, k)),
                  static_cast<typename Grid::ValueType>(samples[at]));
      }
    }
  }
  EXPECT_EQ(grid->tree().getValue(Coord(21, 0, 0)), 0);
  EXPECT_EQ(grid->tree().getValue(Coord(0, 0, 19)), 0);
}

TEST(VdbSink, HoldsEveryDenseTypeExactly) {
  expect_round_trip<openvdb::FloatGrid, float>(std::endian::big);
  expect_round_trip<openvdb::DoubleGrid, double>(std::endian::little);
  expect_round_trip<openvdb::Int32Grid, std::uint8_t>(std::endian::little);
  expect_round_trip<openvdb::Int32Grid, std::int8_t>(std::endian::little);
  expect_round_trip<openvdb::Int32Grid, std::uint16_t>(std::endian::big);
  expect_round_trip<openvdb::Int32Grid, std::int16_t>(std::endian::little);
  expect_round_trip<openvdb::Int32Grid, std::int32_t>(std::endian::big);
  expect_round_trip<openvdb::Int64Grid, std::uint32_t>(std::endian::little);
  expect_round_trip<openvdb::Int64Grid, std::int64_t>(std::endian::big);
}

TEST(VdbSink, SavesHalvesAsHalves) {
  const VolumeFolder folder;
  std::vector<Half> samples;
  for (int n = 0; n < 512; ++n) samples.push_back(to_half(static_cast<float>(n) / 7));
  write_volume(folder / "v.vdb", MemorySlabs(samples, {8, 8, 8}));
  const auto grid = only<openvdb::FloatGrid>(folder / "v.vdb");
  EXPECT_TRUE(grid->saveFloatAsHalf());
  for (int n = 0; n < 512; ++n) {
    EXPECT_EQ(grid->tree().getValue(Coord(n % 8, n / 8 % 8, n / 64)),
              to_float(samples[static_cast<std::size_t>(n)]));
  }
}

TEST(VdbSink, PrunesEqualSamplesOnly) {
  const VolumeFolder folder;
  std::vector<float> samples(std::size_t{128} * 128 * 128, 2.F);
  write_volume(folder / "flat.vdb", MemorySlabs(samples, {128, 128, 128}), {}, 40);
  const auto flat = only<openvdb::FloatGrid>(folder / "flat.vdb");
  EXPECT_EQ(flat->tree().leafCount(), 0U);
  EXPECT_EQ(flat->tree().activeTileCount(), 1U);
  samples[5] = std::nextafter(2.F, 3.F);
  write_volume(folder / "not.vdb", MemorySlabs(samples, {128, 128, 128}), {}, 40);
  const auto bumpy = only<openvdb::FloatGrid>(folder / "not.vdb");
  EXPECT_EQ(bumpy->tree().leafCount(), 1U);
  EXPECT_EQ(bumpy->tree().getValue(Coord(5, 0, 0)), samples[5]);
}

TEST(VdbSink, SurroundsTheVolumeWithWhatIsNotSolid) {
  const VolumeFolder folder;
  const auto background = [&](VolumeClass cls, std::vector<float> samples) {
    MemorySlabs volume(samples, {2, 1, 1}, Affine::scale_translate({3, 3, 3}, {0, 0, 0}));
    volume.edit().cls = cls;
    SinkOptions options;
    options.force = true;
    write_volume(folder / "v.vdb", volume, options);
    const auto grid = only<openvdb::FloatGrid>(folder / "v.vdb");
    EXPECT_EQ(grid->tree().getValue(Coord(2, 0, 0)), grid->background());  // in the leaf
    EXPECT_EQ(grid->tree().getValue(Coord(99, 0, 0)), grid->background());
    return grid->background();
  };
  EXPECT_EQ(background(VolumeClass::level_set, {-5, 20}), 20);
  EXPECT_EQ(background(VolumeClass::sdf_spec, {-5, -1}), 3);  // one cell
  EXPECT_EQ(background(VolumeClass::unknown, {-1000, 400}), -1000);
  EXPECT_EQ(background(VolumeClass::fog, {0.25F, NAN}), 0);
}

TEST(VdbSink, PlacesSamplesByAnyLinearMap) {
  const VolumeFolder folder;
  const std::vector<Affine> maps{{{0.1, 0.2, 0, 5, -0.3, 0.1, 0.7, 6, 0.01, 0, -1, 7}},
                                 Affine::scale_translate({0.1, 0.1, 0.1}, {0, 0, 0}),
                                 Affine::scale_translate({0.1, 0.1, 0.1}, {1, 2, 1e-9}),
                                 Affine::scale_translate({-0.5, 0.5, 2}, {0, 0, 0}),
                                 Affine::scale_translate({1, 1, 1 + 1e-15}, {-1, 2, 3})};
  for (const Affine& map : maps) {
    SinkOptions options;
    options.force = true;
    write_volume(folder / "v.vdb", MemorySlabs(std::vector<float>{1, 2}, {2, 1, 1}, map), options);
    const auto grid = only_grid(folder / "v.vdb");
    const openvdb::Mat4d m = grid->transform().baseMap()->getAffineMap()->getMat4();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        EXPECT_EQ(m(column, row), map.m[static_cast<std::size_t>(4 * row + column)]);
      }
    }
  }
}

TEST(VdbSink, RefusesCellsThatOpenVdbCannotPlace) {
  const VolumeFolder folder;
  const MemorySlabs volume(std::vector<float>{1}, {1, 1, 1},
                           Affine::scale_translate({0x1p-20, 0x1p-20, 0x1p-20}, {0, 0, 0}));
  try {
    write_volume(folder / "v.vdb", volume);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::output);
    EXPECT_EQ(std::string(error.what()),
              folder / "v.vdb" +
                  ": a cell of volume 8.673617379884035e-19 cannot be placed by a VDB file; give a "
                  "larger --spacing, in millimetres for example, or write .nrrd");
  }
  EXPECT_TRUE(folder.empty());
}

TEST(VdbSink, WritesClassNameAndFacts) {
  const VolumeFolder folder;
  MemorySlabs volume(std::vector<float>{1, -1}, {2, 1, 1});
  volume.edit().cls = VolumeClass::sdf_spec;
  volume.edit().iso = 0;
  volume.edit().border = Border::solid;
  SinkOptions options;
  options.provenance = {{"mc", "0.1.0"}};
  write_volume(folder / "v.vdb", volume, options);
  const auto grid = only_grid(folder / "v.vdb");
  EXPECT_EQ(grid->getName(), "surface");
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(grid->metaValue<std::string>("mc_class"), "sdf_spec");
  EXPECT_EQ(grid->metaValue<std::string>("mc_border"), "solid");
  EXPECT_EQ(grid->metaValue<double>("mc_iso"), 0);
  openvdb::io::File file(folder / "v.vdb");
  file.open(false);
  EXPECT_EQ(file.getMetadata()->metaValue<std::string>("mc"), "0.1.0");
  volume.edit().iso = 0.5;
  volume.edit().name = "rock";
  write_volume(folder / "w.vdb", volume, options);
  EXPECT_EQ(only_grid(folder / "w.vdb")->getGridClass(), openvdb::GRID_UNKNOWN);
  EXPECT_EQ(only_grid(folder / "w.vdb")->getName(), "rock");
}

void write_leaves(const std::string& path, const LeafReader& reader) {
  const auto sink = open_volume_sink(path, {});
  sink->begin(reader.volume());
  EXPECT_TRUE(sink->write_sparse(reader));
  sink->finish();
}

TEST(VdbSink, RebuildsSparseVolumesWithValuesAndStates) {
  const VolumeFolder folder;
  const Index3 dims{40, 24, 19};
  auto samples = patches<float>(dims);
  MemoryLeaves sparse(samples, dims, {-16, 8, -24}, 4.F, Affine{}, MemoryLeaves::seeded(5));
  const auto off = [](const Index3& p) { return (p[0] ^ p[1] ^ p[2]) % 5 == 0; };
  sparse.deactivate(off);
  sparse.add_tile({{128, -128, 0}, 128, Scalar::of(7.F), true});
  sparse.add_tile({{4096, 0, 0}, 4096, Scalar::of(8.F), false});
  sparse.add_tile({{256, 0, 0}, 16, Scalar::of(9.F), true});
  sparse.edit().stored_as = "half";
  sparse.edit().cls = VolumeClass::level_set;
  write_leaves(folder / "v.vdb", sparse);
  const auto grid = only<openvdb::FloatGrid>(folder / "v.vdb");
  EXPECT_EQ(grid->tree().leafCount(), sparse.leaves().size());
  EXPECT_EQ(grid->activeVoxelCount(), *sparse.volume().n_active);
  EXPECT_TRUE(grid->saveFloatAsHalf());
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(grid->background(), 4.F);
  for (std::size_t n = 0; n < sparse.leaves().size(); ++n) {
    const Index3& origin = sparse.leaves()[n];
    const auto* leaf = grid->tree().probeConstLeaf(Coord(origin[0], origin[1], origin[2]));
    ASSERT_NE(leaf, nullptr);
    const std::byte* values = sparse.leaf_values(n, nullptr);
    for (openvdb::Index at = 0; at < 512; ++at) {
      float want = 0;
      std::memcpy(&want, values + at * sizeof want, sizeof want);
      EXPECT_EQ(leaf->getValue(at), want);
      EXPECT_EQ(leaf->isValueOn(at), (sparse.leaf_active(n)[at / 64] >> (at % 64) & 1U) != 0);
    }
  }
  for (const Tile& tile : sparse.tiles()) {
    const Coord last =
        Coord(tile.origin[0], tile.origin[1], tile.origin[2]).offsetBy(tile.size - 1);
    EXPECT_EQ(grid->tree().getValue(last), tile.value.as<float>());
    EXPECT_EQ(grid->tree().isValueOn(last), tile.active);
    EXPECT_EQ(grid->tree().probeConstLeaf(last), nullptr);
  }
}

TEST(VdbSink, WritesMasksAsBool) {
  const VolumeFolder folder;
  std::vector<std::uint8_t> samples(512);
  samples[9] = 1;
  MemoryLeaves sparse(samples, {8, 8, 8}, {0, 0, 0}, std::uint8_t{0});
  sparse.edit().cls = VolumeClass::mask;
  write_leaves(folder / "v.vdb", sparse);
  const auto grid = only<openvdb::BoolGrid>(folder / "v.vdb");
  ASSERT_NE(grid, nullptr);
  EXPECT_TRUE(grid->tree().getValue(Coord(1, 1, 0)));
  EXPECT_FALSE(grid->tree().getValue(Coord(1, 2, 0)));
}

TEST(VdbSink, WritesTheSameBytesAlways) {
  const VolumeFolder folder;
  const Index3 dims{33, 20, 27};
  const auto samples = patches<float>(dims);
  const MemorySlabs volume(samples, dims);
  write_volume(folder / "a.vdb", volume, {}, 1);
  {
    const base::ThreadLimit limit(1);
    const std::jthread other([&] { write_volume(folder / "b.vdb", volume, {}, 100); });
  }
  const std::string bytes = bytes_of(folder / "a.vdb");
  EXPECT_EQ(bytes, bytes_of(folder / "b.vdb"));
  auto changed = samples;
  changed[100] += 1;
  write_volume(folder / "c.vdb", MemorySlabs(changed, dims));
  const std::string uuid = bytes.substr(21, 36);
  EXPECT_NE(uuid, bytes_of(folder / "c.vdb").substr(21, 36));
  for (const std::size_t dash : {8U, 13U, 18U, 23U}) EXPECT_EQ(uuid[dash], '-');
  EXPECT_EQ(uuid[14], '8');
  EXPECT_EQ(uuid.find_first_not_of("0123456789abcdef-"), std::string::npos);
}

TEST(VdbSink, WritesTheSameBytesToAPipe) {
  const VolumeFolder folder;
  const Index3 dims{16, 16, 16};
  const MemorySlabs volume(patches<std::int16_t>(dims), dims);
  write_volume(folder / "v.vdb", volume);
  const std::string pipe = folder / "pipe.vdb";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  {
    const std::jthread reader([&] { got = bytes_of(pipe); });
    write_volume(pipe, volume);
  }
  EXPECT_EQ(got, bytes_of(folder / "v.vdb"));
}

TEST(VdbSink, LeavesNothingWhenNotFinished) {
  const VolumeFolder folder;
  const MemorySlabs volume(std::vector<float>{1, 2}, {1, 1, 2});
  {
    const auto sink = open_volume_sink(folder / "v.vdb", {});
    sink->begin(volume.volume());
    write_planes(volume, *sink, 1);
  }
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace mc

#else

#include "mc/sink.hpp"

namespace mc {
namespace {

TEST(VdbSink, NamesThePackageThatIsMissing) {
  try {
    open_volume_sink("v.vdb", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(),
                 "v.vdb: this build cannot write VDB; install libopenvdb-dev and build again, or "
                 "write .nrrd");
  }
}

}  // namespace
}  // namespace mc

#endif
