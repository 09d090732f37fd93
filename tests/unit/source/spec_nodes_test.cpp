// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "field/placing.hpp"
#include "source/spec/spec.hpp"

// What the keys of solids, transforms and control nodes mean: values at one place of a document.

namespace mc::tests {
namespace {

/// The value of a field at p: the first sample of a grid that begins there.
float value_of(const std::string& field, const Vec3& p, const std::string& header = "") {
  const std::string text = R"({"format": "mc-volume", "version": 1, )" + header +
                           R"("grid": {"cells": [1, 1, 1], "origin": [)" + std::to_string(p[0]) +
                           ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) +
                           R"(]}, "field": )" + field + "}";
  const auto reader = source::open_spec_text("v.json", text);
  Slab slab;
  reader->read(0, 1, slab);
  float value = 0;
  std::memcpy(&value, slab.planes[0], sizeof value);
  return value;
}

/// Where a transform puts the point (1, 2, 3): a ball of radius 1/2 around it is lit there.
void expect_moves_to(const std::string& transform, const Vec3& place) {
  const std::string ball = R"({"type": "sphere", "center": [1, 2, 3], "radius": 0.5})";
  const std::string field = "{" + transform + R"(, "source": )" + ball + "}";
  EXPECT_NEAR(value_of(field, place), 0.5F, 1e-6) << transform;
}

TEST(SpecTransforms, MoveThingsToWhereTheySay) {
  expect_moves_to(R"("type": "translate", "by": [10, 20, 30])", {11, 22, 33});
  expect_moves_to(R"("type": "rotate", "degrees": 90)", {3, 2, -1});  // x goes to -z, z to x
  expect_moves_to(R"("type": "rotate", "degrees": 90, "axis": "x")", {1, -3, 2});
  expect_moves_to(R"("type": "rotate", "degrees": 90, "axis": [0, 0, 7])", {-2, 1, 3});
  expect_moves_to(R"("type": "rotate", "degrees": 180, "center": [1, 0, 0])", {1, 2, -3});
  expect_moves_to(R"("type": "rotate", "degrees": 120, "axis": [1, 1, 1])", {3, 1, 2});
  expect_moves_to(R"("type": "rotate", "degrees": [90, 90, 0])", {2, -3, -1});  // x, then y
  expect_moves_to(R"("type": "scale", "factor": 2)", {2, 4, 6});
  expect_moves_to(R"("type": "scale", "factor": [1, -3, 2], "center": [0, 1, 0])", {1, -2, 6});
  expect_moves_to(R"("type": "affine", "matrix": [0,2,0,1, 1,0,0,2, 0,0,1,3])", {5, 3, 6});
  expect_moves_to(R"("type": "mirror", "axis": "x")", {-1, 2, 3});
  expect_moves_to(R"("type": "mirror", "axis": "y", "at": 5, "keep": "below")", {1, 8, 3});
  expect_moves_to(R"("type": "repeat", "period": [10, 0, 20])", {-29, 2, 43});
  expect_moves_to(R"("type": "repeat", "period": 10, "copies": [3, 1, 1])", {21, 2, 3});
}

TEST(SpecTransforms, ScaleKeepsValuesUnlessToldOtherwise) {
  const std::string ball = R"("source": {"type": "sphere", "radius": 1})";
  const std::string keep = R"({"type": "scale", "factor": 3, )" + ball + "}";
  const std::string scale =
      R"({"type": "scale", "factor": [3, -2, 4], "values": "scale", )" + ball + "}";
  EXPECT_FLOAT_EQ(value_of(keep, {6, 0, 0}), -1.0F);
  EXPECT_FLOAT_EQ(value_of(scale, {6, 0, 0}), -2.0F);  // by the least size, a bound
  EXPECT_FLOAT_EQ(value_of(scale, {6, 0, 0}, R"("iso": 7, )"), 5.0F);
}

TEST(Placing, QuarterTurnsAreExactAndOthersAreRotations) {
  using field::rotation_about;
  for (const double turn : {0.0, 360.0, -720.0, 3600000000000.0}) {
    EXPECT_EQ(rotation_about({0, 1, 0}, 90 + turn)[0], (Vec3{0, 0, 1})) << turn;
    EXPECT_EQ(rotation_about({1, 0, 0}, 180 + turn)[1], (Vec3{0, -1, 0})) << turn;
    EXPECT_EQ(rotation_about({0, 0, 1}, turn - 90)[0], (Vec3{0, 1, 0})) << turn;
  }
  for (double degrees = -400; degrees < 400; degrees += 7.3) {
    const auto m = rotation_about({0, 0, 1}, degrees);
    EXPECT_NEAR(m[0][0], std::cos(degrees * M_PI / 180), 2e-15) << degrees;
    EXPECT_NEAR(m[1][0], std::sin(degrees * M_PI / 180), 2e-15) << degrees;
  }
}

TEST(SpecSolids, ReadTheirKeys) {
  EXPECT_EQ(value_of(R"({"type": "roundbox", "size": [2, 4, 6], "radius": 1})", {3, 0, 0}), -2.0F);
  EXPECT_EQ(
      value_of(R"({"type": "capsule", "from": [0,0,0], "to": [0,4,0], "radius": 1})", {3, 2, 0}),
      -2.0F);
  EXPECT_EQ(value_of(R"({"type": "capsule", "from": [0,0,0], "to": [0,4,0], "radius": [1, 2]})",
                     {0, 8, 0}),
            -2.0F);
  EXPECT_EQ(value_of(R"({"type": "cylinder", "radius": 1, "height": 6, "axis": "x"})", {5, 0, 0}),
            -2.0F);
  EXPECT_EQ(value_of(R"({"type": "cone", "radius": 2, "height": 4})", {0, 3, 0}), -1.0F);
  EXPECT_EQ(value_of(R"({"type": "cone", "radius": [2, 1], "height": 4, "axis": "z"})", {0, 1, 4}),
            -2.0F);
  EXPECT_EQ(
      value_of(R"({"type": "ellipsoid", "radii": [1, 2, 3], "center": [1, 0, 0]})", {1, 3, 0}),
      -1.0F);
  EXPECT_EQ(value_of(R"({"type": "gyroid", "period": 5, "thickness": 0.5})", {0, 0, 0}), 0.25F);
  const std::string ball = R"("source": {"type": "sphere", "radius": 4}})";
  EXPECT_EQ(value_of(R"({"type": "offset", "distance": 1, )" + ball, {5, 0, 0}), 0.0F);
  EXPECT_EQ(value_of(R"({"type": "shell", "thickness": 1, )" + ball, {3, 0, 0}), 0.0F);
  EXPECT_EQ(value_of(R"({"type": "shell", "thickness": 1, "side": "both", )" + ball, {4, 0, 0}),
            0.5F);
  EXPECT_EQ(value_of(R"({"type": "shell", "thickness": 1, "side": "outside", )" + ball, {5, 0, 0}),
            0.0F);
}

TEST(SpecControls, ReadTheirKeys) {
  EXPECT_EQ(
      value_of(R"({"type": "select", "a": 3, "b": 4, "control": "x", "threshold": 2})", {2, 0, 0}),
      4.0F);
  EXPECT_EQ(
      value_of(R"({"type": "select", "a": 3, "b": 4, "control": "x", "threshold": 2, "blend": 1})",
               {2, 0, 0}),
      3.5F);
  EXPECT_EQ(value_of(R"({"type": "curve", "source": "y", "points": [[0, 1], [2, 5]]})", {0, 1, 0}),
            3.0F);
  EXPECT_EQ(value_of(R"({"type": "curve", "source": "y", "points": [[0, 1], [2, 5]],
                         "interpolation": "steps"})",
                     {0, 1, 0}),
            1.0F);
  EXPECT_EQ(value_of(R"({"type": "terrace", "source": "y", "step": 2, "offset": 1, "ramp": 0})",
                     {0, 4, 0}),
            3.0F);
  EXPECT_FLOAT_EQ(
      value_of(R"({"type": "terrace", "source": "y", "levels": [0, 1, 11]})", {0, 10, 0}), 6.0F);
  EXPECT_EQ(
      value_of(R"({"type": "floor-hard", "source": -1, "height": 2, "weight": 3})", {0, 1, 0}),
      2.0F);
}

}  // namespace
}  // namespace mc::tests
