// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_VDB

#include "support/source_files.hpp"

// Third-party VDB files, against what other readers say of them.

namespace mc {
namespace {

using test::error_of_open;
using test::Folder;
using test::leaves;
using test::open;

struct RealGrid {
  const char* file;
  const char* grid;
  std::uint64_t n_active;
  IndexBox box;
  VolumeClass cls;
  double spacing;
  const char* stored_as;
};

TEST(VdbReal, AgreesWithOtherReaders) {
  // The numbers of the three densities are those in the file, not their metadata "index".
  const std::vector<RealGrid> grids{{"vdb-zeno-sphere-levelset/sphere.vdb",
                                     "",
                                     40404,
                                     {{-27, 17, -22}, {20, 64, 25}},
                                     VolumeClass::level_set,
                                     0.0099999998,
                                     ""},
                                    {"vdb-cube-levelset-half/cube.vdb",
                                     "ls_cube",
                                     1452218,
                                     {{-112, -112, -112}, {112, 112, 112}},
                                     VolumeClass::level_set,
                                     0.050000001,
                                     "half"},
                                    {"vdb-smoke-fog-half/smoke.vdb",
                                     "density",
                                     1049275,
                                     {{1, 2, 1}, {111, 223, 112}},
                                     VolumeClass::fog,
                                     0.47619048,
                                     "half"},
                                    {"vdb-torus-bifrost-fog/torus01.vdb",
                                     "voxel_fog_density",
                                     2450,
                                     {{-25, -4, 1}, {-4, 4, 22}},
                                     VolumeClass::fog,
                                     0.40323097,
                                     ""},
                                    {"vdb-three-density-grids/grids.vdb",
                                     "density[2]",
                                     491,
                                     {{-5, -5, -5}, {5, 5, 5}},
                                     VolumeClass::fog,
                                     0.1,
                                     ""},
                                    {"vdb-three-density-grids/grids.vdb",
                                     "density[1]",
                                     2222,
                                     {{-9, -13, -9}, {9, 5, 12}},
                                     VolumeClass::fog,
                                     0.1,
                                     ""},
                                    {"vdb-three-density-grids/grids.vdb",
                                     "density[0]",
                                     803,
                                     {{-5, -5, -5}, {5, 5, 5}},
                                     VolumeClass::fog,
                                     0.1,
                                     ""}};
  for (const RealGrid& expected : grids) {
    const std::string file = test::shared_volume(expected.file);
    MC_NEEDS_VOLUME(file);
    SourceOptions options;
    options.grid = expected.grid;
    const Volume volume = volume_of(open({file}, options).reader);
    EXPECT_EQ(volume.n_active, expected.n_active) << file;
    EXPECT_EQ(volume.lattice.box, expected.box) << file;
    EXPECT_EQ(volume.cls, expected.cls) << file;
    EXPECT_EQ(volume.stored_as, expected.stored_as) << file;
    EXPECT_NEAR(volume.lattice.to_world.spacing(0), expected.spacing, 1e-7) << file;
  }
}

TEST(VdbReal, UnmeshableGridsAreNamed) {
  const std::string points = test::shared_volume("vdb-unmeshable/points.vdb");
  const std::string vectors = test::shared_volume("vdb-unmeshable/vel_VDB_bound_v02.vdb");
  MC_NEEDS_VOLUME(points);
  EXPECT_EQ(error_of_open({points}).substr(2 + points.size()),
            ": grid \"points\": type ptdataidx32, but only scalar grids can be meshed");
  EXPECT_EQ(error_of_open({vectors}).substr(2 + vectors.size()),
            ": grid \"vel\": type vec3s, but only scalar grids can be meshed");
  const auto grids = describe_source(std::vector{vectors}, {}, silent_progress());
  ASSERT_EQ(grids.size(), 1U);
  EXPECT_EQ(grids[0].type_name, "vec3s");
}

}  // namespace
}  // namespace mc

#endif
