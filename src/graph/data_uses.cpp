// SPDX-License-Identifier: MIT
#include "graph/data_uses.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

// Samples that nodes read, as instructions hold them.

namespace mc::graph {

namespace {

/// Least and greatest of the samples and of what lies beyond them; NaN where one is not finite.
std::array<float, 2> range_of(std::span<const float> samples, std::optional<float> outside) {
  constexpr float kNan = __builtin_nanf("");
  std::array<float, 2> range{outside.value_or(samples.front()), outside.value_or(samples.front())};
  if (!std::isfinite(range[0])) return {kNan, kNan};
  for (const float v : samples) {
    if (!std::isfinite(v)) return {kNan, kNan};
    range = {std::min(range[0], v), std::max(range[1], v)};
  }
  return range;
}

}  // namespace

const DataUse* DataUses::of(const Node& node) {
  const Raster* raster = node.raster.get();
  const SampledVolume* volume = node.volume.get();
  assert((raster != nullptr) != (volume != nullptr));
  const void* sampled = volume != nullptr ? static_cast<const void*>(volume) : raster;
  const DataUse*& use = known_[{sampled, node.wrap, node.filter, node.outside}];
  if (use == nullptr) {
    const auto made = std::make_shared<DataUse>();
    made->raster = node.raster;
    made->volume = node.volume;
    made->wrap = node.wrap;
    made->filter = node.filter;
    made->outside = volume != nullptr && !node.outside ? volume->background : node.outside;
    const auto range = volume != nullptr ? range_of(volume->samples, made->outside)
                                         : range_of(raster->samples, std::nullopt);
    made->least = range[0];
    made->greatest = range[1];
    uses_.push_back(made);
    use = made.get();
  }
  return use;
}

std::vector<std::shared_ptr<const DataUse>> DataUses::take() { return std::move(uses_); }

}  // namespace mc::graph
