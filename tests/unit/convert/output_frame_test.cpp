// SPDX-License-Identifier: MIT
#include "convert/output_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "convert/surface_choice.hpp"
#include "support/usage_error.hpp"

namespace mc::conversion {
namespace {

using tests::usage_error;

constexpr Vec3 kPoint{1, 2, 3};

Volume volume_in(Frame frame, Units units) {
  Volume volume;
  volume.lattice.box = {{0, 0, 0}, {9, 9, 9}};
  volume.frame = frame;
  volume.units = units;
  return volume;
}

Vec3 placed(Frame frame, Units units, const FrameChoice& choice, std::string_view format) {
  return output_frame(volume_in(frame, units), choice, *find_sink_format(format)).to_world(kPoint);
}

TEST(Placement, KeepsTheSourcesFrameInPly) {
  EXPECT_EQ(placed(Frame::lps, Units::mm, {}, "ply"), kPoint);
  EXPECT_EQ(placed(Frame::none, Units::unknown, {}, "stl"), kPoint);
}

TEST(Placement, TurnsMedicalFramesYUpInGltf) {
  EXPECT_EQ(placed(Frame::lps, Units::mm, {}, "glb"), (Vec3{0.001, 0.003, -0.002}));
  EXPECT_EQ(placed(Frame::ras, Units::mm, {}, "glb"), (Vec3{-0.001, 0.003, 0.002}));
  EXPECT_EQ(placed(Frame::ras, Units::m, {}, "gltf"), (Vec3{-1, 3, 2}));
  EXPECT_EQ(placed(Frame::ras, Units::unknown, {}, "glb"), (Vec3{-0.001, 0.003, 0.002}));
}

TEST(Placement, TurningKeepsHandedness) {
  for (const Frame frame : {Frame::none, Frame::ras, Frame::lps}) {
    EXPECT_GT(output_frame(volume_in(frame, Units::m), {}, *find_sink_format("glb"))
                  .to_world.determinant(),
              0);
  }
  EXPECT_GT(output_frame(volume_in(Frame::none, Units::m), {.up = Up::z}, *find_sink_format("glb"))
                .to_world.determinant(),
            0);
}

TEST(Placement, ConvertsBetweenRasAndLps) {
  EXPECT_EQ(placed(Frame::ras, Units::mm, {.frame = Frame::lps}, "ply"), (Vec3{-1, -2, 3}));
  EXPECT_EQ(placed(Frame::ras, Units::mm, {.frame = Frame::ras}, "ply"), kPoint);
}

TEST(Placement, DeclaresAFrameWhereThereIsNone) {
  EXPECT_EQ(placed(Frame::none, Units::unknown, {.frame = Frame::lps}, "ply"), kPoint);
  EXPECT_EQ(placed(Frame::none, Units::unknown, {.frame = Frame::lps}, "glb"),
            (Vec3{0.001, 0.003, -0.002}));
}

TEST(Placement, TurnsZUpOnlyForGltf) {
  EXPECT_EQ(placed(Frame::none, Units::unknown, {.up = Up::z}, "glb"), (Vec3{1, 3, -2}));
  EXPECT_EQ(placed(Frame::none, Units::unknown, {.up = Up::z}, "ply"), kPoint);
}

TEST(Placement, DeclaresOrConvertsUnits) {
  EXPECT_EQ(placed(Frame::none, Units::unknown, {.units = Units::mm}, "glb"),
            (Vec3{0.001, 0.002, 0.003}));
  EXPECT_EQ(placed(Frame::none, Units::unknown, {.units = Units::mm}, "ply"), kPoint);
  EXPECT_EQ(placed(Frame::lps, Units::mm, {.units = Units::m}, "ply"), (Vec3{0.001, 0.002, 0.003}));
  EXPECT_EQ(placed(Frame::none, Units::m, {.units = Units::mm}, "obj"), (Vec3{1000, 2000, 3000}));
}

TEST(Placement, RefusesWhatCannotBe) {
  EXPECT_EQ(usage_error([] { placed(Frame::lps, Units::mm, {.up = Up::z}, "ply"); }),
            "--up: is for sources without a frame, but this one is in lps");
  EXPECT_EQ(usage_error([] { placed(Frame::none, Units::m, {.units = Units::mm}, "glb"); }),
            "--units: glTF is in metres, and so is the source; choose ply, obj or stl for "
            "millimetres");
}

TEST(RoundingLoss, MattersFarFromTheOrigin) {
  const IndexBox box{{0, 0, 0}, {9, 9, 9}};
  EXPECT_FALSE(
      rounding_loss(box, Affine::scale_translate({1, 1, 1}, {1000, 0, 0}), Precision::f32).matters);
  const RoundingLoss far =
      rounding_loss(box, Affine::scale_translate({1, 1, 1}, {500000, 0, 0}), Precision::f32);
  EXPECT_EQ(far.largest_move, 1.0 / 64);
  EXPECT_TRUE(far.matters);
  // Half a float's step at 4096 is 1/4096; just below, 1/8192, which is the limit itself.
  EXPECT_TRUE(
      rounding_loss(box, Affine::scale_translate({1, 1, 1}, {4096, 0, 0}), Precision::f32).matters);
  EXPECT_FALSE(
      rounding_loss(box, Affine::scale_translate({1, 1, 1}, {4086, 0, 0}), Precision::f32).matters);
}

TEST(RoundingLoss, CollapsesWhereNeighboursBecomeOne) {
  const IndexBox box{{0, 0, 0}, {9, 9, 9}};
  const auto at = [&](double spacing, double origin, Precision precision) {
    return rounding_loss(box, Affine::scale_translate({spacing, spacing, spacing}, {origin, 0, 0}),
                         precision)
        .collapses;
  };
  EXPECT_FALSE(at(1, 1e6, Precision::f32));
  EXPECT_TRUE(at(1, 1e8, Precision::f32));
  EXPECT_FALSE(at(1, 1e14, Precision::f64));
  EXPECT_TRUE(at(1, 1e17, Precision::f64));
  EXPECT_TRUE(at(1e300, 0, Precision::f32));
  EXPECT_FALSE(at(1e300, 0, Precision::f64));
  EXPECT_TRUE(at(1e-300, 0, Precision::f32));
  EXPECT_FALSE(at(1e-300, 0, Precision::f64));
}

TEST(RoundingLoss, OriginIsTheMiddle) {
  const IndexBox box{{0, 0, 0}, {9, 9, 9}};
  const Vec3 origin = double_origin(box, Affine::scale_translate({1, 1, 1}, {123456789, 0, 0}));
  EXPECT_EQ(origin[0], 123456793.5);
  EXPECT_EQ(origin[1], 4.5);
}

TEST(SurfaceChoice, DefaultsFollowTheClass) {
  Volume volume;
  const Measure never = [](std::span<const double> /*percentiles*/) -> FieldStatistics {
    ADD_FAILURE() << "the data were read";
    return {};
  };
  volume.cls = VolumeClass::fog;
  EXPECT_EQ(choose_isos({}, volume, "v", never).front().value, 0.5);
  EXPECT_EQ(choose_isos({}, volume, "v", never).front().reason, "fog volume");
  EXPECT_EQ(choose_inside({}, volume), Inside::above);
  volume.cls = VolumeClass::level_set;
  EXPECT_EQ(choose_isos({}, volume, "v", never).front().value, 0);
  EXPECT_EQ(choose_inside({}, volume), Inside::below);
  EXPECT_EQ(choose_inside({.invert = true}, volume), Inside::above);
  volume.iso = 3;
  EXPECT_EQ(choose_isos({}, volume, "v", never).front().value, 3);
}

TEST(SurfaceChoice, RoundsTheIsoAsTheDataAre) {
  Volume volume;
  const IsoChoice tenth{IsoChoice::Kind::number, 0.1};
  volume.type = SampleType::f32;
  const Iso iso = choose_isos({&tenth, 1}, volume, "v", {}).front();
  EXPECT_EQ(iso.value, double{0.1F});
  EXPECT_EQ(value_text(iso.value, volume.type), "0.1");
  volume.type = SampleType::u8;
  EXPECT_EQ(choose_isos({&tenth, 1}, volume, "v", {}).front().value, 0.1);
}

TEST(SurfaceChoice, ReadsTheDataOnceForAllThatNeedThem) {
  Volume volume;
  volume.type = SampleType::u8;
  const std::vector<IsoChoice> asked{{IsoChoice::Kind::percentile, 25},
                                     {IsoChoice::Kind::number, 7},
                                     {IsoChoice::Kind::otsu, 0},
                                     {IsoChoice::Kind::percentile, 75}};
  int n_reads = 0;
  const auto isos = choose_isos(asked, volume, "v", [&](std::span<const double> percentiles) {
    ++n_reads;
    EXPECT_THAT(percentiles, testing::ElementsAre(25, 75));
    FieldStatistics statistics;
    statistics.n_samples = 8;
    statistics.otsu = 100;
    statistics.percentiles = {20, 60};
    return statistics;
  });
  EXPECT_EQ(n_reads, 1);
  ASSERT_EQ(isos.size(), 4U);
  EXPECT_EQ(isos[0].value, 20);
  EXPECT_EQ(isos[1].value, 7);
  EXPECT_EQ(isos[2].value, 100);
  EXPECT_EQ(isos[3].value, 60);
  EXPECT_EQ(isos[3].reason, "p75");
}

}  // namespace
}  // namespace mc::conversion
