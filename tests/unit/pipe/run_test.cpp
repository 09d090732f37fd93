// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"

namespace mc {
namespace {

/// 40^3 samples with a surface across, between every `period` planes.
VolumeReader sheets(std::int32_t period) {
  constexpr std::int32_t kSize = 40;
  std::vector<float> samples;
  for (std::int32_t k = 0; k < kSize; ++k) {
    samples.insert(samples.end(), kSize * kSize, k / period % 2 == 0 ? 0.0F : 1.0F);
  }
  return test::owned(std::make_unique<test::MemorySlabs>(samples, Index3{kSize, kSize, kSize}));
}

MeshObject announced(const VolumeReader& reader, CountFirst count_first) {
  RunOptions options;
  options.extract.iso = 0.5;
  options.slab_layers = 1;
  options.count_first = count_first;
  test::Collected out;
  test::CollectingSink sink(out);
  run(reader, options, false, sink, silent_progress(), {});
  return out.object;
}

TEST(Run, CountsFirstWhereItIsWorthIt) {
  const VolumeReader few = sheets(39);
  const VolumeReader many = sheets(1);
  EXPECT_FALSE(announced(few, CountFirst::no).n_triangles);
  EXPECT_TRUE(announced(few, CountFirst::yes).n_triangles);
  EXPECT_FALSE(announced(few, CountFirst::if_large).n_triangles);
  EXPECT_EQ(announced(many, CountFirst::if_large).n_triangles, 39U * 39U * 39U * 2U);
}

TEST(Run, NeedsMemoryForWhatTheSinkMakes) {
  const VolumeReader reader = sheets(1);
  RunOptions options;
  const MemoryNeed plain = memory_needed(reader, options);
  options.formatted = {.vertex_bytes = 4 * 24, .triangle_bytes = 4 * 12};
  const MemoryNeed formatted = memory_needed(reader, options);
  EXPECT_GT(formatted.expected, plain.expected);
  EXPECT_GT(formatted.most, plain.most);
  EXPECT_GT(formatted.least, plain.least);
}

TEST(Run, NeedsWhatTheSurfaceThatIsThereTakes) {
  RunOptions options;
  options.extract.iso = 0.5;
  const MemoryNeed few = memory_counted(sheets(39), options, {});
  const MemoryNeed many = memory_counted(sheets(1), options, {});
  EXPECT_LT(few.expected, many.expected);
  EXPECT_LE(many.expected, many.most);
  EXPECT_LE(many.most, options.memory_bytes);
  EXPECT_LE(few.least, few.expected);
}

TEST(Run, TellsItsNeedBeforeTheWork) {
  const VolumeReader reader = sheets(1);
  RunOptions options;
  options.tell_need = [](const MemoryNeed& /*need*/) { throw Cancelled(); };
  test::Collected out;
  test::CollectingSink sink(out);
  EXPECT_THROW(run(reader, options, false, sink, silent_progress(), {}), Cancelled);
  EXPECT_FALSE(out.object.n_triangles);
}

/// The material of a place is the nearest sample's i; every place with j > 20 has none.
class MaterialsAlongI final : public AttributeReader {
 public:
  [[nodiscard]] const AttributeInfo& info() const override { return material_attribute(); }
  std::size_t values_at(std::span<const Vec3> places, std::byte* values) const override {
    auto* out = reinterpret_cast<std::uint16_t*>(values);
    std::size_t n_held = 0;
    for (std::size_t n = 0; n < places.size(); ++n) {
      out[n] = static_cast<std::uint16_t>(places[n][0] + 0.5);
      n_held += places[n][1] > 20 ? 1 : 0;
    }
    return n_held;
  }
};

TEST(Run, GivesVerticesTheMaterialsOfTheirPlaceInTheLattice) {
  const VolumeReader reader = sheets(20);
  const MaterialsAlongI materials;
  const std::array<const AttributeReader*, 1> attributes{&materials};
  for (const bool exact : {false, true}) {
    RunOptions options;
    options.extract.iso = 0.5;
    options.extract.precision = exact ? Precision::f64 : Precision::f32;
    options.extract.origin = {7, 8, 9};
    options.to_world = Affine{{0, 0, 3, 100, -2, 0, 0, 200, 0, 4, 0, 300}};  // (k, i, j) of i, j, k
    options.attributes = attributes;
    options.slab_layers = 3;
    test::Collected out;
    test::CollectingSink sink(out);
    const MeshTotals totals = run(reader, options, false, sink, silent_progress(), {});
    EXPECT_EQ(out.object.attributes, std::vector{material_attribute()});
    ASSERT_EQ(out.materials.size(), totals.n_vertices);
    EXPECT_EQ(totals.n_clamped.at(0), totals.n_vertices / 40 * 19);  // j of 21 to 39
    for (std::size_t v = 0; v < out.materials.size(); ++v) {
      const double y = exact ? out.mesh.positions_f64[v][1] : double{out.mesh.positions[v][1]};
      EXPECT_EQ(out.materials[v], (200 - (y + 8)) / 2);
    }
  }
}

TEST(Run, RefusesMaterialsWhereVerticesHaveNoPlaceInTheLattice) {
  const MaterialsAlongI materials;
  const std::array<const AttributeReader*, 1> attributes{&materials};
  RunOptions options;
  options.to_world = Affine{{1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}};
  options.attributes = attributes;
  test::Collected out;
  test::CollectingSink sink(out);
  EXPECT_THROW(run(sheets(20), options, false, sink, silent_progress(), {}), Error);
}

}  // namespace
}  // namespace mc
