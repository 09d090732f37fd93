// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mc/edit.hpp"
#include "mc/pipe.hpp"
#include "mc/source.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/places.hpp"
#include "support/random_edits.hpp"

// The store of edits: cases whose outcome can be counted by hand or by another program.

namespace mc::test {

namespace {

Edit ball(EditOp op, const Vec3& center, double radius, double strength = 1) {
  Edit edit;
  edit.op = op;
  edit.shape.center = center;
  edit.shape.radius = radius;
  edit.falloff.type = FalloffType::hard;
  edit.strength = strength;
  return edit;
}

template <class T>
VolumeReader dense(const Index3& dims, T value, const Affine& map = {}) {
  const auto n = static_cast<std::size_t>(dims[0] * dims[1] * dims[2]);
  return std::make_unique<MemorySlabs>(std::vector<T>(n, value), dims, map);
}

template <class T>
T sample(const EditStore& store, const Index3& at) {
  T value;
  store.read_box({at, at}, std::as_writable_bytes(std::span(&value, 1)));
  return value;
}

VolumeReader open_spec(const char* name) {
  const std::vector<std::string> inputs{source_file(std::string("data/specs/") + name)};
  return open_source(inputs, {}, silent_progress()).reader;
}

std::uint64_t n_inside(const EditStore& store, double iso) {
  const IndexBox box = store.volume().lattice.box;
  std::vector<float> values(
      static_cast<std::size_t>(box.extent(0) * box.extent(1) * box.extent(2)));
  store.read_box(box, std::as_writable_bytes(std::span(values)));
  std::uint64_t n = 0;
  for (const float v : values) n += v < static_cast<float>(iso) ? 1 : 0;
  return n;
}

TEST(EditStore, HardBallReachesSamplesWithinItsRadius) {
  const VolumeReader input = dense<float>({9, 9, 9}, 0);
  EditStore store(input, {});
  const EditEffect effect = store.apply(ball(EditOp::add, {4, 4, 4}, 1, 0.25));
  EXPECT_EQ(effect.n_samples, 7U);  // the middle and six neighbours, whose distance is the radius
  EXPECT_EQ(effect.n_changed, 7U);
  EXPECT_EQ(effect.touched, (IndexBox{{3, 3, 3}, {5, 5, 5}}));
  EXPECT_EQ(sample<float>(store, {5, 4, 4}), 0.25F);
  EXPECT_EQ(sample<float>(store, {5, 5, 4}), 0.0F);
}

// The counts are those of a program of its own that evaluates the terrain and the brush.
TEST(EditStore, DemosBrushOnTheDemosTerrain) {
  const VolumeReader input = open_spec("demo-terrain.json");
  EditStore store(input, {.above = false, .iso = 0.5, .to_world = {}});
  EXPECT_EQ(n_inside(store, 0.5), 1285U);
  const auto brush = [&](EditOp op, const Vec3& at, std::uint32_t steps) {
    Edit edit = ball(op, at, 1, 2 * 0.02);
    edit.steps = steps;
    edit.clamp = {0, 1};
    return store.apply(edit);
  };
  EXPECT_EQ(brush(EditOp::subtract, {10, 1, 10}, 25).n_changed, 7U);
  EXPECT_EQ(n_inside(store, 0.5), 1279U);
  EXPECT_EQ(brush(EditOp::add, {4, 4, 15}, 50).n_changed, 7U);
  EXPECT_EQ(n_inside(store, 0.5), 1285U);
  EXPECT_EQ(brush(EditOp::subtract, {0, 0, 0}, 25).n_changed, 4U);
  EXPECT_EQ(n_inside(store, 0.5), 1281U);
  store.undo(3);
  EXPECT_EQ(n_inside(store, 0.5), 1285U);
}

TEST(EditStore, AddIsMoreSolidInBothConventions) {
  for (const bool above : {true, false}) {
    for (const Blend blend : {Blend::accumulate, Blend::csg}) {
      const float empty = above ? -5 : 5;
      const VolumeReader input = dense<float>({17, 17, 17}, empty);
      EditStore store(input, {.above = above, .iso = 0, .to_world = {}});
      const auto is_solid = [&] {
        const float v = sample<float>(store, {8, 8, 8});
        return above ? v >= 0 : v < 0;
      };
      Edit edit = ball(EditOp::add, {8, 8, 8}, 3, blend == Blend::csg ? 1 : 8);
      edit.blend = blend;
      if (blend == Blend::csg) edit.falloff.type = FalloffType::none;
      EXPECT_FALSE(is_solid());
      store.apply(edit);
      EXPECT_TRUE(is_solid());
      edit.op = EditOp::subtract;
      store.apply(edit);
      EXPECT_FALSE(is_solid());
    }
  }
}

TEST(EditStore, UnionIsTheDistanceToTheSurfaceAndBeyondIt) {
  const VolumeReader input = dense<double>({33, 9, 9}, 100);
  EditStore store(input, {.above = false, .iso = 0, .to_world = {}});
  Edit edit = ball(EditOp::add, {16, 4, 4}, 4.25);
  edit.blend = Blend::csg;
  edit.falloff.type = FalloffType::none;
  store.apply(edit);
  EXPECT_EQ(sample<double>(store, {16, 4, 4}), -4.25);
  EXPECT_EQ(sample<double>(store, {20, 4, 4}), -0.25);
  EXPECT_EQ(sample<double>(store, {23, 4, 4}), 2.75);
  EXPECT_EQ(sample<double>(store, {24, 4, 4}), 100);  // 3.75 beyond: three spacings are reached
}

TEST(EditStore, DistancesAreTheWorlds) {
  // Samples half a unit apart along i, two along j and mirrored; k is sheared over i.
  const Affine map{{0.5, 0, 0.25, 0, 0, -2, 0, 0, 0, 0, 1, 0}};
  const VolumeReader input = dense<float>({40, 12, 12}, 0, map);
  EditStore store(input, {.above = true, .iso = 0, .to_world = map});
  const Vec3 middle = map({20, 6, 6});
  store.apply(ball(EditOp::add, middle, 2.6, 1));
  for (std::int32_t k = 0; k < 12; ++k) {
    for (std::int32_t j = 0; j < 12; ++j) {
      for (std::int32_t i = 0; i < 40; ++i) {
        const Vec3 p = map({1.0 * i, 1.0 * j, 1.0 * k});
        const double r = std::hypot(p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]);
        ASSERT_EQ(sample<float>(store, {i, j, k}), r <= 2.6 ? 1.0F : 0.0F) << i << j << k;
      }
    }
  }
}

TEST(EditStore, StepsAreEditsOfOneStep) {
  const VolumeReader input = dense<std::uint8_t>({16, 16, 16}, 100);
  EditStore once(input, {});
  EditStore often(input, {});
  Edit edit = ball(EditOp::add, {8, 8, 8}, 6, 7.4);
  edit.falloff.type = FalloffType::smoothstep;
  for (int n = 0; n < 5; ++n) often.apply(edit);
  edit.steps = 5;
  once.apply(edit);
  EXPECT_EQ(sample<std::uint8_t>(once, {8, 8, 8}), 135);  // 100 + 5 * 7: rounded each step
  EXPECT_EQ(once.hash(), often.hash());
}

TEST(EditStore, DabsAreEditsAtTheirPlaces) {
  const VolumeReader input = dense<float>({48, 16, 16}, 0);
  EditStore path(input, {});
  EditStore dabs(input, {});
  Edit edit = ball(EditOp::add, {0, 0, 0}, 4);
  edit.falloff.type = FalloffType::spherical;
  for (int n = 0; n <= 4; ++n) {
    edit.shape.center = {10.0 + 6 * n, 8, 8};
    dabs.apply(edit);
  }
  edit.path = BrushPath{{{10, 8, 8}, {20, 8, 8}, {34, 8, 8}}, PathMode::dabs, 1.5};
  EXPECT_EQ(path.apply(edit).n_dabs, 5U);
  EXPECT_EQ(path.hash(), dabs.hash());
}

TEST(EditStore, SweepTouchesEachSampleOnce) {
  const VolumeReader input = dense<float>({48, 16, 16}, 0);
  EditStore store(input, {});
  Edit edit = ball(EditOp::add, {}, 2);
  edit.path = BrushPath{{{10, 8, 8}, {20, 8, 8}, {10, 8, 8}, {34, 8, 8}}, PathMode::sweep};
  EXPECT_EQ(store.apply(edit).n_dabs, 1U);
  for (std::int32_t i = 0; i < 48; ++i) {
    EXPECT_EQ(sample<float>(store, {i, 8, 8}), i >= 8 && i <= 36 ? 1.0F : 0.0F) << i;
  }
}

TEST(EditStore, SweptCapsuleTapersAlongItsPath) {
  const VolumeReader input = dense<float>({48, 16, 16}, 0);
  EditStore store(input, {});
  Edit edit = ball(EditOp::add, {}, 4);
  edit.shape.type = ShapeType::capsule;
  edit.shape.end_radius = 1;
  edit.path = BrushPath{{{10, 8, 8}, {22, 8, 8}, {34, 8, 8}}, PathMode::sweep};
  store.apply(edit);
  const auto height = [&](std::int32_t i) {
    std::int32_t n = 0;
    while (sample<float>(store, {i, 8 + n, 8}) > 0) ++n;
    return n - 1;
  };
  EXPECT_EQ(height(10), 4);
  EXPECT_EQ(height(22), 2);  // 2.5 halfway along
  EXPECT_EQ(height(34), 1);
}

TEST(EditStore, CopiesThatCoincideCountOnce) {
  const VolumeReader input = dense<float>({33, 9, 33}, 0);
  EditStore store(input, {});
  Edit edit = ball(EditOp::add, {20, 4, 18}, 1);
  edit.mirror = Mirror{{true, false, true}, {16, 4, 16}};
  edit.radial = Radial{2, 1, {16, 4, 16}};  // a half turn is both mirrors at once
  EXPECT_EQ(store.apply(edit).n_dabs, 4U);
  for (const Index3 at : {Index3{20, 4, 18}, {12, 4, 18}, {20, 4, 14}, {12, 4, 14}}) {
    EXPECT_EQ(sample<float>(store, at), 1.0F);
  }
}

TEST(EditStore, QuarterTurnsAreExact) {
  const VolumeReader input = dense<float>({33, 9, 33}, 0);
  EditStore store(input, {});
  Edit edit = ball(EditOp::add, {26, 4, 16}, 1);
  edit.radial = Radial{4, 1, {16, 4, 16}};
  EXPECT_EQ(store.apply(edit).n_changed, 28U);
  for (const Index3 at : {Index3{26, 4, 16}, {16, 4, 26}, {6, 4, 16}, {16, 4, 6}}) {
    EXPECT_EQ(sample<float>(store, at), 1.0F);
  }
}

TEST(EditStore, OutsideIsANoOpThatIsCounted) {
  const VolumeReader input = dense<float>({9, 9, 9}, 0);
  EditStore store(input, {});
  const EditEffect effect = store.apply(ball(EditOp::add, {40, 4, 4}, 3));
  EXPECT_EQ(effect.n_outside, 1U);
  EXPECT_EQ(effect.n_changed, 0U);
  EXPECT_TRUE(store.take_dirty().empty());
  EXPECT_EQ(store.n_stored_blocks(), 0U);
}

TEST(EditStore, NaNStays) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const VolumeReader input = dense<float>({9, 9, 9}, nan);
  EditStore store(input, {});
  Edit edit = ball(EditOp::set, {4, 4, 4}, 3);
  edit.value = 7;
  EXPECT_EQ(store.apply(edit).n_changed, 0U);
  EXPECT_EQ(store.apply(ball(EditOp::add, {4, 4, 4}, 3)).n_changed, 0U);
}

TEST(EditStore, FillIsNoCopyAndRevertGoesBackToTheInput) {
  const VolumeReader input = dense<std::uint16_t>({64, 64, 64}, 9);
  EditStore store(input, {});
  Edit fill;
  fill.op = EditOp::fill;
  fill.value = 1;
  EXPECT_EQ(store.apply(fill).n_samples, 64U * 64 * 64);
  EXPECT_EQ(store.n_stored_blocks(), 0U);
  EXPECT_EQ(sample<std::uint16_t>(store, {63, 0, 5}), 1);
  store.apply(ball(EditOp::revert, {8, 8, 8}, 2));
  EXPECT_EQ(sample<std::uint16_t>(store, {8, 8, 8}), 9);
  EXPECT_EQ(sample<std::uint16_t>(store, {11, 8, 8}), 1);
  store.undo(2);
  EXPECT_EQ(sample<std::uint16_t>(store, {63, 0, 5}), 9);
}

TEST(EditStore, FillOfASparseVolumeDropsLeaves) {
  const VolumeReader input = std::make_unique<MemoryLeaves>(
      std::vector<float>(16 * 16 * 16, 2), Index3{16, 16, 16}, Index3{0, 0, 0}, 0.0F);
  EditStore store(input, {});
  Edit fill;
  fill.op = EditOp::fill;
  fill.value = 3;
  store.apply(fill);
  store.apply(ball(EditOp::set, {100, 0, 0}, 2, 1));
  const VolumeReader edited = store.reader();
  const auto& leaves = *std::get<std::unique_ptr<LeafReader>>(edited);
  EXPECT_EQ(leaves.background().as<float>(), 3.0F);
  EXPECT_TRUE(leaves.tiles().empty());
  EXPECT_EQ(leaves.leaves().size(), 4U);  // the ball lies around an edge of blocks
  EXPECT_EQ(store.volume().lattice.box, (IndexBox{{98, -2, -2}, {102, 2, 2}}));
}

TEST(EditStore, ATileIsCutAroundWhatIsStored) {
  auto reader = std::make_unique<MemoryLeaves>(std::vector<float>(512, 0), Index3{8, 8, 8},
                                               Index3{0, 0, 0}, 0.0F);
  reader->add_tile({{128, 0, 0}, 128, Scalar::of(1.0F), true});
  const VolumeReader input = std::move(reader);
  EditStore store(input, {});
  store.apply(ball(EditOp::add, {132, 4, 4}, 2));  // within the tile's first block
  const VolumeReader edited = store.reader();
  const auto& leaves = *std::get<std::unique_ptr<LeafReader>>(edited);
  EXPECT_EQ(leaves.leaves().size(), 1U);
  EXPECT_EQ(leaves.tiles().size(), 4U * 7);  // seven eighths each of sizes 64, 32, 16 and 8
  std::uint64_t n = leaves.leaves().size() * 512;
  for (const Tile& tile : leaves.tiles()) {
    n += static_cast<std::uint64_t>(tile.size) * static_cast<std::uint64_t>(tile.size) *
         static_cast<std::uint64_t>(tile.size);
  }
  EXPECT_EQ(n, 128U * 128 * 128);
}

TEST(EditStore, ChangedSamplesOfASparseVolumeBecomeActive) {
  const VolumeReader input = std::make_unique<MemoryLeaves>(std::vector<float>(512, 0),
                                                            Index3{8, 8, 8}, Index3{0, 0, 0}, 0.0F);
  EditStore store(input, {});
  store.apply(ball(EditOp::add, {20, 20, 20}, 1));
  const VolumeReader edited = store.reader();
  const auto& leaves = *std::get<std::unique_ptr<LeafReader>>(edited);
  std::uint64_t n = 0;
  for (std::size_t leaf = 0; leaf < leaves.leaves().size(); ++leaf) {
    if (leaves.leaves()[leaf] != Index3{16, 16, 16}) continue;
    for (const std::uint64_t word : leaves.leaf_active(leaf)) {
      n += static_cast<std::uint64_t>(std::popcount(word));
    }
  }
  EXPECT_EQ(n, 7U);
}

TEST(EditStore, RefusesWhatMemoryDoesNotHoldBeforeTouchingIt) {
  const VolumeReader input = std::make_unique<MemoryLeaves>(std::vector<float>(512, 0),
                                                            Index3{8, 8, 8}, Index3{0, 0, 0}, 0.0F);
  EditStore store(input, {});
  store.limit_memory(std::uint64_t{64} << 20U);
  try {
    store.apply(ball(EditOp::add, {0, 0, 0}, 1e7));
    FAIL() << "was not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
  }
  EXPECT_EQ(store.n_stored_blocks(), 0U);
  EXPECT_EQ(store.undo(), 0U);
  EXPECT_GT(store.apply(ball(EditOp::add, {0, 0, 0}, 20)).n_changed, 0U);
}

TEST(EditStore, MemoryStaysFlatWhereUndoIsBounded) {
  const VolumeReader input = dense<float>({32, 32, 32}, 0);
  EditStore store(input, {});
  store.keep_undo(4);
  RandomEdits random(7, {{16, 16, 16}, 12, 3, 1});
  std::uint64_t most = 0;
  for (int n = 0; n < 20000; ++n) {
    store.apply(ball(n % 2 == 0 ? EditOp::add : EditOp::subtract, random.place(), 2));
    if (n == 1000) most = store.stored_bytes();
  }
  EXPECT_LE(store.stored_bytes(), most + (std::uint64_t{4} << 10U) * 4 * 8);
  EXPECT_EQ(store.undo(100), 4U);
}

TEST(EditStore, DirtyBoxesAreWhatChanged) {
  const VolumeReader input = dense<float>({32, 32, 32}, 0);
  EditStore store(input, {});
  const IndexBox touched = store.apply(ball(EditOp::add, {9, 9, 9}, 2)).touched;
  EXPECT_EQ(store.take_dirty(), std::vector{touched});
  EXPECT_TRUE(store.take_dirty().empty());
  store.undo();
  EXPECT_EQ(store.take_dirty(), std::vector{touched});
}

TEST(EditStore, AHashIsOfTheStateAndNotOfTheWayThere) {
  const VolumeReader input = dense<float>({32, 32, 32}, 0);
  EditStore a(input, {});
  EditStore b(input, {});
  const Edit first = ball(EditOp::add, {4, 4, 4}, 2);
  const Edit second = ball(EditOp::add, {27, 27, 27}, 2);
  a.apply(first), a.apply(second);
  EXPECT_NE(a.hash(), b.hash());
  b.apply(second), b.apply(first);
  EXPECT_EQ(a.hash(), b.hash());
  a.undo();
  EXPECT_NE(a.hash(), b.hash());
}

// A spec that is read near its surface only, with edits far from it: the mesh is that of all
// samples.
TEST(EditStore, SkippingASpecLeavesNoEditOut) {
  const VolumeReader input = open_spec("hills.json");
  const Volume& volume = volume_of(input);
  EditStore store(input, {.above = true, .iso = 0, .to_world = volume.lattice.to_world});
  const IndexBox& box = volume.lattice.box;
  const Vec3 middle = volume.lattice.to_world(
      {(box.lo[0] + box.hi[0]) / 2.0, box.hi[1] - 7.0, (box.lo[2] + box.hi[2]) / 2.0});
  const double reach = 4 * volume.lattice.to_world.spacing(0);
  store.apply(ball(EditOp::add, middle, reach, 1000));
  Vec3 below = middle;
  below[1] = volume.lattice.to_world({0, box.lo[1] + 6.0, 0})[1];
  store.apply(ball(EditOp::subtract, below, reach, 1000));
  const VolumeReader edited = store.reader();
  ExtractOptions options;
  options.iso = 0;
  const Collected fast = collect(edited, options, {.skip = true});
  const Collected whole = collect(edited, options, {.skip = false});
  EXPECT_GT(whole.mesh.triangles.size(), 0U);
  EXPECT_EQ(fast.mesh.positions, whole.mesh.positions);
  EXPECT_EQ(fast.mesh.normals, whole.mesh.normals);
  EXPECT_EQ(fast.mesh.triangles, whole.mesh.triangles);
}

}  // namespace

}  // namespace mc::test
