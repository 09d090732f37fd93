// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "field/attributes.hpp"
#include "field/volume_attribute.hpp"
#include "mc/field.hpp"
#include "support/memory_readers.hpp"

namespace mc::field {
namespace {

std::string fault_of(const std::vector<AttributeInfo>& attributes) {
  try {
    check_attributes(attributes);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "";
}

TEST(Attributes, NamesAreCheckedForAllFormats) {
  EXPECT_EQ(fault_of({material_attribute(), {"heat"}, {"heat2"}, {"flow", SampleType::f64, 3}}),
            "");
  const std::string no_name =
      "cannot name a vertex attribute: expected a letter, then letters, digits and underscores, at "
      "most 64 in all";
  for (const char* name : {"", "2nd", "_heat", "heat map", "h\xC3\xA9"}) {
    EXPECT_EQ(fault_of({{name}}), "attribute \"" + std::string(name) + "\": " + no_name);
  }
  EXPECT_EQ(fault_of({{std::string(64, 'a')}}), "");
  EXPECT_NE(fault_of({{std::string(65, 'a')}}), "");
  for (const char* name : {"x", "Y", "nx", "NZ"}) {
    EXPECT_EQ(fault_of({{name}}),
              "attribute \"" + std::string(name) +
                  "\": names part of a vertex's position or normal: expected another name");
  }
  EXPECT_EQ(
      fault_of({{"Material", SampleType::u16}}),
      "attribute \"Material\": names the index of a vertex's material: expected another name");
  EXPECT_EQ(fault_of({{"heat", SampleType::f32, 5}}),
            "attribute \"heat\": has 5 components: expected 1 to 4");
  EXPECT_EQ(fault_of({{"heat"}, {"HEAT"}}),
            "attribute \"HEAT\": cannot be told apart from \"heat\" in every format: expected "
            "another name");
  EXPECT_EQ(fault_of({{"flow", SampleType::f32, 3}, {"flow_z"}}),
            "attribute \"flow_z\": cannot be told apart from \"flow\" in every format: expected "
            "another name");
  EXPECT_EQ(fault_of({{"flow", SampleType::f32, 3}, {"flow_w"}}), "");
}

TEST(Attributes, ComponentsAreNamedByAxes) {
  EXPECT_EQ(component_name({"heat"}, 0), "heat");
  EXPECT_EQ(component_name({"flow", SampleType::f32, 4}, 0), "flow_x");
  EXPECT_EQ(component_name({"flow", SampleType::f32, 4}, 3), "flow_w");
}

std::vector<float> values_of(const AttributeReader& reader, const std::vector<Vec3>& places) {
  EXPECT_EQ(reader.info().type, SampleType::f32);
  std::vector<float> out(places.size());
  EXPECT_EQ(reader.values_at(places, reinterpret_cast<std::byte*>(out.data())), 0U);
  return out;
}

/// i + 10 j + 100 k at each sample.
template <class T>
std::vector<T> linear(const Index3& dims) {
  std::vector<T> out;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) out.push_back(static_cast<T>(i + 10 * j + 100 * k));
    }
  }
  return out;
}

TEST(VolumeAttribute, IsLinearBetweenSamplesAndConstantPastTheBorder) {
  // Another origin, spacing and byte order than those of the volume that is meshed.
  test::MemorySlabs::Layout layout{.to_world = Affine::scale_translate({2, 2, 2}, {10, 0, 0})};
  layout.endian =
      std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
  layout.lead = 1;
  const VolumeReader volume =
      std::make_unique<test::MemorySlabs>(linear<std::int16_t>({4, 5, 6}), Index3{4, 5, 6}, layout);
  const auto reader =
      volume_attribute(volume, "heat", Affine::scale_translate({1, 1, 1}, {8, 0, 0}));
  EXPECT_EQ(reader->info(), (AttributeInfo{"heat"}));
  EXPECT_EQ(values_of(*reader, {{2, 0, 0}, {4, 2, 2}, {3, 3, 5}, {-9, 0, 0}, {99, 99, 99}}),
            (std::vector<float>{0, 111, 0.5F + 15 + 250, 0, 3 + 40 + 500}));
}

TEST(VolumeAttribute, SparseIsTheSameInsideAndBackgroundOutside) {
  const Index3 dims{24, 16, 16};
  std::vector<float> samples = linear<float>(dims);
  for (int k = 0; k < 8; ++k) {  // a tile
    for (int j = 0; j < 8; ++j) std::fill_n(&samples[(16 * k + j) * 24 + 8], 8, 7.F);
  }
  const VolumeReader dense = std::make_unique<test::MemorySlabs>(samples, dims);
  const VolumeReader sparse =
      std::make_unique<test::MemoryLeaves>(samples, dims, Index3{0, 0, 0}, -1.F);
  const auto of_dense = volume_attribute(dense, "a", {});
  const auto of_sparse = volume_attribute(sparse, "a", {});
  std::vector<Vec3> places;
  for (int n = 0; n < 500; ++n) {
    places.push_back({n % 23 + 0.25, n % 14 + 0.5, n % 15 + 0.125 * (n % 8)});
  }
  EXPECT_EQ(values_of(*of_sparse, places), values_of(*of_dense, places));
  EXPECT_EQ(values_of(*of_sparse, {{-100, 0, 0}, {12, 4, 4}, {23.5, 0, 0}}),
            (std::vector<float>{-1, 7, 11}));
}

TEST(VolumeAttribute, NanSpreadsToPlacesThatItCountsFor) {
  std::vector<float> samples = linear<float>({3, 2, 2});
  samples[1] = std::numeric_limits<float>::quiet_NaN();
  const VolumeReader volume = std::make_unique<test::MemorySlabs>(samples, Index3{3, 2, 2});
  const std::vector<float> values = values_of(*volume_attribute(volume, "a", {}),
                                              {{0, 0, 0}, {0.5, 0, 0}, {1, 1, 0}, {2, 0, 0.5}});
  EXPECT_EQ(values[0], 0);
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], 11);
  EXPECT_EQ(values[3], 52);
}

TEST(VolumeAttribute, WideSamplesStayDoubles) {
  const std::vector<std::int64_t> samples(8, (std::int64_t{1} << 40) + 1);
  const VolumeReader volume = std::make_unique<test::MemorySlabs>(samples, Index3{2, 2, 2});
  const auto reader = volume_attribute(volume, "a", {});
  EXPECT_EQ(reader->info().type, SampleType::f64);
  const std::array<Vec3, 1> places{{{0.5, 0.5, 0.5}}};
  double value = 0;
  reader->values_at(places, reinterpret_cast<std::byte*>(&value));
  EXPECT_EQ(value, 0x1p40 + 1);
}

}  // namespace
}  // namespace mc::field
