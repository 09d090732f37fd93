// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "base/checked.hpp"
#include "graph/nodes/generators.hpp"

// Pictures and volumes, which mc-volume(5) has under Generators.

namespace mc::graph {

inline Value emit_heightmap(Emitter& to, const Node& node, const Domain& domain) {
  const auto axes = flat_axes(node, domain);
  Numbers p = node.numbers;
  p[2] = static_cast<float>(node.raster->width) / p[2];
  p[3] = static_cast<float>(node.raster->height) / p[3];
  return to.push(Op::heightmap, {domain.at[axes[0]], domain.at[axes[1]]}, p, 0, to.use_of(node));
}

inline Value emit_volume(Emitter& to, const Node& node, const Domain& domain) {
  return to.push(Op::volume, {domain.at[0], domain.at[1], domain.at[2]}, {}, 0, to.use_of(node));
}

[[noreturn]] inline void refuse_samples(const std::string& fault) {
  throw Error(ErrorKind::usage, "", fault);
}

/// Counts are small enough for float32 to hold every pixel's place.
inline void check_raster(const Node& node) {
  constexpr std::int32_t kMostPixels = 1 << 22;
  if (node.raster == nullptr) {
    refuse_samples("a node has no samples to read");
  }
  const Raster& raster = *node.raster;
  const auto counted = [](std::int32_t n) { return n >= 1 && n <= kMostPixels; };
  if (!counted(raster.width) || !counted(raster.height) ||
      raster.samples.size() !=
          static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height)) {
    refuse_samples("a picture of " + std::to_string(raster.width) + "x" +
                   std::to_string(raster.height) + " pixels: expected 1 to " +
                   std::to_string(kMostPixels) + " along each axis");
  }
  if (!(node.numbers[2] > 0) || !(node.numbers[3] > 0)) {
    refuse_samples("a picture's size is not above 0");
  }
}

inline void check_volume(const Node& node) {
  constexpr double kMostFactor = 1e100;  // times float32 and added up, still a double
  if (node.volume == nullptr) {
    refuse_samples("a node has no samples to read");
  }
  const SampledVolume& volume = *node.volume;
  const auto n = [&](std::size_t axis) { return static_cast<std::uint64_t>(volume.dims[axis]); };
  const bool counted =
      std::all_of(volume.dims.begin(), volume.dims.end(), [](auto d) { return d >= 1; });
  if (!counted || base::checked_mul(n(0), n(1), n(2)) != volume.samples.size()) {
    refuse_samples("a volume's dims are not those of its " + std::to_string(volume.samples.size()) +
                   " samples");
  }
  const auto& m = volume.to_index.m;
  if (!std::all_of(m.begin(), m.end(), [](double v) { return std::abs(v) <= kMostFactor; })) {
    refuse_samples("a volume's map has numbers past +-1e100");
  }
  if (node.filter == Filter::cubic || !std::isfinite(node.outside.value_or(0))) {
    refuse_samples("a volume has the filters nearest and linear, and finite numbers outside");
  }
}

inline constexpr NodeRow kData[] = {
    {.type = NodeType::heightmap,
     .name = "heightmap",
     .keys = {plain_key("path", KeyKind::picture), or_nothing(plain_key("channel", KeyKind::text)),
              or_else(numbers_key("origin", 2, 0, kAnyFloat), 0),
              sizes_key("size", 2, 2, kPositiveFloat),
              or_else(number_key("height", 4, kAnyFloat), 1),
              or_else(choice_key("wrap", {"clamp", "repeat", "mirror"},
                                 [](Node& node, double n) { node.wrap = Wrap(n); }),
                      0),
              or_else(choice_key("filter", {"nearest", "linear", "cubic"},
                                 [](Node& node, double n) { node.filter = Filter(n); }),
                      1),
              kFlatDims},
     .emit = emit_heightmap,
     .check_samples = check_raster},
    {.type = NodeType::volume,
     .name = "volume",
     .keys = {plain_key("path", KeyKind::volume), or_nothing(plain_key("grid", KeyKind::text)),
              or_nothing(number_key("outside", -1, kAnyFloat)),
              or_else(choice_key("filter", {"nearest", "linear"},
                                 [](Node& node, double n) { node.filter = Filter(n); }),
                      1)},
     .emit = emit_volume,
     .make =
         [](Node& node, GivenKeys& given) {
           if (given["outside"].present) node.outside = static_cast<float>(given.number("outside"));
         },
     .check_samples = check_volume},
};

}  // namespace mc::graph
