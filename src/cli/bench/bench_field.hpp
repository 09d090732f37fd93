// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "cli/bench/bench_array.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/graph.hpp"

// The volumes that `mc bench` extracts: cubes of samples over [-1, 1]^3, solid where positive, made
// by the graph of mc-volume(5), so that they are the same bits on every machine.

namespace mc::cli {

/// sphere: 0.8 - |p|; terrain: a height field of six octaves; gyroid: eight periods an axis, solid
/// and void alike everywhere; noise: four octaves of Perlin's in three dimensions.
inline constexpr std::array<std::string_view, 4> kBenchFields{"sphere", "terrain", "gyroid",
                                                              "noise"};
inline constexpr double kSphereRadius = 0.8;
inline constexpr double kGyroidPeriods = 8;

/// A cube of samples in memory, and the surface in it.
struct BenchVolume {
  SampleType type = SampleType::f32;
  std::int32_t n = 0;  ///< samples along each axis
  BenchArray samples;
  double iso = 0;
  Inside inside = Inside::above;
};

/// Field `name` with n >= 2 samples an axis. Integers: [-1, 1] is scaled to the type's range.
/// `periods` is the gyroid's.
/// Threads  uses the caller's arena.
BenchVolume make_bench_volume(std::string_view name, std::int32_t n, SampleType type,
                              double periods = kGyroidPeriods);

/// The terrain of the demo (data/specs/demo-terrain.json), stretched over n_cells^3 cells.
BenchVolume make_demo_volume(std::int32_t n_cells);

/// Six octaves of Perlin's noise in three dimensions.
GraphField make_fractal_field();
/// Solid below y = 0 but for six octaves of noise of this frequency: hills, where `dims` does
/// without y, or cliffs.
GraphField make_terrain_field(Dims dims, double frequency);

}  // namespace mc::cli
