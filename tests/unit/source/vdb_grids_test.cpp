// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_VDB

#include <openvdb/openvdb.h>

#include <array>
#include <cstring>

#include "support/source_files.hpp"
#include "support/vdb_grids.hpp"

// What a grid of a VDB file is beside its values: its box, place, name and class; and those that
// are refused.

namespace mc {
namespace {

using test::error_of_open;
using test::Folder;
using test::leaves;
using test::open;

TEST(Vdb, WithoutActiveSamplesTheBoxIsAllThatIsStored) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(1);
  grid->tree().setValueOff({1, 2, 3}, -1);
  grid->tree().addTile(1, {-8, 0, 0}, 2, false);
  test::write_grids(folder.path("i.vdb"), {grid});
  const Volume volume = volume_of(open({folder.path("i.vdb")}).reader);
  EXPECT_EQ(volume.n_active, 0U);
  EXPECT_EQ(volume.lattice.box, (IndexBox{{-8, 0, 0}, {7, 7, 7}}));
}

/// Reads one sample's grid under a transform and compares where some indices lie.
void expect_placed_as(const openvdb::math::Transform::Ptr& transform) {
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(0);
  grid->tree().setValueOn({0, 0, 0}, 1);
  grid->setTransform(transform);
  test::write_grids(folder.path("p.vdb"), {grid});
  const Affine map = volume_of(open({folder.path("p.vdb")}).reader).lattice.to_world;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-3, 5, 7}}) {
    const openvdb::Vec3d expected = transform->indexToWorld(openvdb::Vec3d(p[0], p[1], p[2]));
    const Vec3 found = map(p);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(found[static_cast<std::size_t>(a)], expected[a], 1e-12);
    }
  }
}

TEST(Vdb, AnyLinearTransform) {
  using openvdb::math::Transform;
  openvdb::initialize();
  expect_placed_as(Transform::createLinearTransform(0.25));
  auto turned = Transform::createLinearTransform(0.5);
  turned->postRotate(0.7, openvdb::math::Z_AXIS);
  turned->postScale(openvdb::Vec3d(1, 2, 3));
  turned->postTranslate({10, -20, 30});
  turned->postShear(0.5, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  expect_placed_as(turned);
  auto mirrored = Transform::createLinearTransform(1.0);
  mirrored->postScale(openvdb::Vec3d(-1, 1, 2));
  mirrored->postTranslate({3, 4, 5});
  expect_placed_as(mirrored);
  using namespace openvdb::math;
  expect_placed_as(std::make_shared<Transform>(std::make_shared<ScaleMap>(Vec3d(1, 2, 3))));
  expect_placed_as(std::make_shared<Transform>(std::make_shared<TranslationMap>(Vec3d(1, 2, 3))));
  expect_placed_as(std::make_shared<Transform>(std::make_shared<UnitaryMap>(X_AXIS, 0.3)));
}

TEST(Vdb, ProjectiveMapsAreDamage) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(0);
  grid->tree().setValueOn({0, 0, 0}, 1);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(
      openvdb::Mat4d(2, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1)));
  test::write_grids(folder.path("whole.vdb"), {grid});
  std::string bytes = test::read_bytes(folder.path("whole.vdb"));
  const std::size_t at = bytes.find("AffineMap");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 9 + 3 * sizeof(double)] = 1;
  const std::string file = folder.file("p.vdb", bytes);
  EXPECT_EQ(error_of_open({file}), "3 " + file +
                                       ": damaged VDB file: a projective map; fetch or write the "
                                       "file again");
}

TEST(Vdb, PlacementOptionsOverride) {
  openvdb::initialize();
  const Folder folder;
  auto grid = openvdb::FloatGrid::create(0);
  grid->tree().setValueOn({0, 0, 0}, 1);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
  test::write_grids(folder.path("p.vdb"), {grid});
  SourceOptions options;
  options.spacing = Vec3{1, 2, 3};
  options.origin = Vec3{4, 5, 6};
  EXPECT_EQ(volume_of(open({folder.path("p.vdb")}, options).reader).lattice.to_world,
            Affine::scale_translate({1, 2, 3}, {4, 5, 6}));
}

TEST(Vdb, RefusesWhatCannotBeMeshed) {
  openvdb::initialize();
  const Folder folder;
  auto frustum = openvdb::FloatGrid::create(0);
  frustum->setName("cam");
  frustum->tree().setValueOn({0, 0, 0}, 1);
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 2.0));
  auto vec = openvdb::Vec3SGrid::create();
  vec->setName("vel");
  vec->tree().setValueOn({0, 0, 0}, openvdb::Vec3s(1));
  auto empty = openvdb::FloatGrid::create(2);
  empty->setName("void");
  const std::string file = folder.path("r.vdb");
  test::write_grids(file, {vec, frustum, empty});
  SourceOptions options;
  EXPECT_EQ(error_of_open({file}),  // the first scalar one
            "3 " + file +
                ": grid \"cam\": frustum transform, but only linear transforms can be meshed; "
                "resample it to a linear transform first");
  options.grid = "vel";
  EXPECT_EQ(error_of_open({file}, options),
            "3 " + file + ": grid \"vel\": type vec3s, but only scalar grids can be meshed");
  options.grid = "void";
  EXPECT_EQ(error_of_open({file}, options),
            "3 " + file + ": grid \"void\": empty, it holds nothing but background");
  options.grid = "w";
  EXPECT_EQ(error_of_open({file}, options),
            "3 " + file +
                ": no grid \"w\": it has \"vel\", \"cam\", \"void\"; choose one with --grid NAME, "
                "NAME[n] or #n");
  const auto grids = describe_source(std::vector{file}, {}, silent_progress());
  ASSERT_EQ(grids.size(), 3U);
  EXPECT_EQ(grids[0].type_name, "vec3s");
  EXPECT_EQ(grids[0].refused, "type vec3s, but only scalar grids can be meshed");
  EXPECT_EQ(grids[1].refused, "frustum transform, but only linear transforms can be meshed");
  EXPECT_EQ(grids[2].refused, "empty");
}

TEST(Vdb, OtherTreesAreRefusedByName) {
  openvdb::initialize();
  using Tree = openvdb::tree::Tree4<float, 4, 3, 3>::Type;
  using Small = openvdb::Grid<Tree>;
  const Folder folder;
  const std::string file = folder.path("t.vdb");
  auto grid = Small::create(0.F);
  grid->setName("small");
  grid->tree().setValueOn({0, 0, 0}, 1.F);
  Small::registerGrid();
  test::write_grids(file, {grid});
  Small::unregisterGrid();
  EXPECT_EQ(error_of_open({file}),
            "3 " + file +
                ": grid \"small\": tree of type \"Tree_float_4_3_3\", but only trees of 5-4-3 "
                "levels can be meshed");
}

TEST(Vdb, GridsByNameNumberAndPosition) {
  openvdb::initialize();
  const Folder folder;
  openvdb::GridPtrVec grids;
  for (const char* name : {"density", "density", "", "heat"}) {
    auto grid = openvdb::FloatGrid::create(0);
    grid->setName(name);
    grid->tree().setValueOn({0, 0, 0}, static_cast<float>(grids.size() + 1));
    grids.push_back(grid);
  }
  const std::string file = folder.path("g.vdb");
  test::write_grids(file, grids);
  const auto value = [&](std::optional<std::string> wanted) {
    SourceOptions options;
    options.grid = std::move(wanted);
    const Source source = open({file}, options);
    alignas(8) std::array<std::byte, 512 * sizeof(float)> scratch{};
    float first = 0;
    std::memcpy(&first, leaves(source).leaf_values(0, scratch.data()), sizeof(first));
    return first;
  };
  EXPECT_EQ(value("density[0]"), 1);
  EXPECT_EQ(value("density[1]"), 2);
  EXPECT_EQ(value("density"), 1);
  EXPECT_EQ(value(""), 3);
  EXPECT_EQ(value("#2"), 3);
  EXPECT_EQ(value("heat"), 4);
  EXPECT_EQ(value("#3"), 4);
  const Source first = open({file});
  EXPECT_EQ(volume_of(first.reader).name, "density[0]");
  EXPECT_EQ(first.other_grids, (std::vector<std::string>{"density[1]", "", "heat"}));
  EXPECT_EQ(value(std::nullopt), 1);
}

TEST(Vdb, ClassesOfGrids) {
  openvdb::initialize();
  const Folder folder;
  for (const auto& [stored, expected] : std::vector<std::pair<openvdb::GridClass, VolumeClass>>{
           {openvdb::GRID_LEVEL_SET, VolumeClass::level_set},
           {openvdb::GRID_FOG_VOLUME, VolumeClass::fog},
           {openvdb::GRID_UNKNOWN, VolumeClass::unknown}}) {
    auto grid = openvdb::FloatGrid::create(1);
    grid->setGridClass(stored);
    grid->tree().setValueOn({0, 0, 0}, 0.5F);
    test::write_grids(folder.path("c.vdb"), {grid});
    const Volume volume = volume_of(open({folder.path("c.vdb")}).reader);
    EXPECT_EQ(volume.cls, expected);
    EXPECT_EQ(volume.units, Units::m);
    EXPECT_EQ(volume.frame, Frame::none);
  }
}

TEST(Vdb, RawsOptionsAreUsage) {
  openvdb::initialize();
  const Folder folder;
  const std::string file = folder.path("c.vdb");
  auto grid = openvdb::FloatGrid::create(1);
  test::write_grids(file, {grid});
  SourceOptions options;
  options.dims = {2, 2, 2};
  EXPECT_EQ(error_of_open({file}, options), "2 --dims: is for raw data, but " + file + " is VDB");
}

}  // namespace
}  // namespace mc

#endif
