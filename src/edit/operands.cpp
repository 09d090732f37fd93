// SPDX-License-Identifier: MIT
#include "edit/operands.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "edit/neighbourhood.hpp"

// What each operation combines samples with: a constant, a distance, a noise, another volume, or
// what lies around.

namespace mc::edit {

namespace {

/// f(n, i, j, k) for each sample of a block whose row is reached.
template <class F>
void for_samples_of(const Index3& block, const Mask512& reached, F f) {
  const Index3 at = origin_of(block);
  for_rows_of(reached, [&](std::size_t row) {
    const auto j = at[1] + static_cast<std::int32_t>(row % kBlockSize);
    const auto k = at[2] + static_cast<std::int32_t>(row / kBlockSize);
    for (std::int32_t i = 0; i < kBlockSize; ++i) {
      f(row * kBlockSize + static_cast<std::size_t>(i), at[0] + i, j, k);
    }
  });
}

Vec3 place_of(const Affine& map, std::int32_t i, std::int32_t j, std::int32_t k) {
  return map({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
}

/// Where a coordinate among n samples lies: between first and first + 1, by a part of the way.
struct Between {
  std::int32_t first;
  double part;
  bool inside;

  Between(double u, std::int32_t n) {
    constexpr double kRoom = 1e-9;  // for rounding
    inside = u >= -kRoom && u <= n - 1 + kRoom;
    const double held = inside ? std::clamp(u, 0.0, static_cast<double>(n - 1)) : 0;
    first = std::min(static_cast<std::int32_t>(held), std::max(n - 2, 0));
    part = held - first;
  }
};

/// Linear between samples, along i, j, k in turn. NaN beyond the volume.
double stamp_at(const SampledVolume& stamp, const Vec3& u) {
  const Between x(u[0], stamp.dims[0]);
  const Between y(u[1], stamp.dims[1]);
  const Between z(u[2], stamp.dims[2]);
  if (!x.inside || !y.inside || !z.inside) return std::nan("");
  const auto sample = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const auto size = [](std::int32_t v) { return static_cast<std::size_t>(v); };
    const std::size_t at = (size(std::min(z.first + k, stamp.dims[2] - 1)) * size(stamp.dims[1]) +
                            size(std::min(y.first + j, stamp.dims[1] - 1))) *
                               size(stamp.dims[0]) +
                           size(std::min(x.first + i, stamp.dims[0] - 1));
    return static_cast<double>(stamp.samples[at]);
  };
  const auto mix = [](double a, double b, double t) { return t > 0 ? a + (b - a) * t : a; };
  const auto row = [&](std::int32_t j, std::int32_t k) {
    return mix(sample(0, j, k), sample(1, j, k), x.part);
  };
  const auto plane = [&](std::int32_t k) { return mix(row(0, k), row(1, k), y.part); };
  return mix(plane(0), plane(1), z.part);
}

}  // namespace

bool looks_around(EditOp op) {
  return op == EditOp::smooth || op == EditOp::inflate || op == EditOp::flatten;
}

void Operands::find_csg(const BlockWeights& weights, std::span<double, kBlockSamples> out) const {
  // A difference is the intersection with the complement, whose distance has the other sign.
  const bool rises = rules_.above != (edit_.op == EditOp::add);  // values rise with the distance
  for_rows_of(weights.reached, [&](std::size_t row) {
    for (std::size_t n = row * kBlockSize; n < (row + 1) * kBlockSize; ++n) {
      const double distance = weights.distance[n];
      out[n] = rises ? rules_.iso + distance : rules_.iso - distance;
    }
  });
}

void Operands::find_noise(const Index3& block, const BlockWeights& weights,
                          std::span<double, kBlockSamples> out) const {
  std::array<float, kBlockSamples> values;
  sample_block(*edit_.noise, rules_.to_world, box_of(block, weights.reached), values);
  for_rows_of(weights.reached, [&](std::size_t row) {
    for (std::size_t n = row * kBlockSize; n < (row + 1) * kBlockSize; ++n) {
      out[n] = values[n] == values[n] ? static_cast<double>(values[n]) : 0;
    }
  });
}

void Operands::find_plane(const Index3& block, const BlockWeights& weights,
                          std::span<double, kBlockSamples> out) const {
  assert(plane_);
  for_samples_of(block, weights.reached,
                 [&](std::size_t n, std::int32_t i, std::int32_t j, std::int32_t k) {
                   const Vec3 p = place_of(rules_.to_world, i, j, k);
                   double distance = 0;  // to the side that is not solid
                   for (std::size_t a = 0; a < 3; ++a) {
                     distance += (p[a] - plane_->point[a]) * plane_->normal[a];
                   }
                   out[n] = rules_.above ? rules_.iso - distance : rules_.iso + distance;
                 });
}

void Operands::find_stamp(const Index3& block, const Position& at, BlockWeights& weights,
                          std::span<double, kBlockSamples> out) const {
  const bool csg = edit_.blend == Blend::csg;
  Mask512 reached{};
  for_samples_of(
      block, weights.reached, [&](std::size_t n, std::int32_t i, std::int32_t j, std::int32_t k) {
        const double v = stamp_at(*edit_.stamp, place_of(at.to_stamp, i, j, k)) - edit_.stamp_iso;
        const double solid = edit_.stamp_above ? v : -v;
        if (!(solid == solid)) weights.weight[n] = 0;
        reached[n / 64] |= std::uint64_t{weights.weight[n] > 0} << (n % 64);
        const double inside = csg && edit_.stamp_carves ? -solid : solid;
        const double field = rules_.above ? rules_.iso + inside : rules_.iso - inside;
        out[n] = csg ? field : solid;
      });
  weights.reached = reached;
}

void Operands::find(const Index3& block, const Position& at, BlockWeights& weights,
                    std::span<double, kBlockSamples> out) const {
  switch (edit_.op) {
    case EditOp::add:
    case EditOp::subtract:
      if (edit_.blend == Blend::csg) return find_csg(weights, out);
      return std::fill(out.begin(), out.end(), 1.0);
    case EditOp::set:
      return std::fill(out.begin(), out.end(), edit_.value);
    case EditOp::noise:
      return find_noise(block, weights, out);
    case EditOp::flatten:
      return find_plane(block, weights, out);
    case EditOp::stamp:
      return find_stamp(block, at, weights, out);
    case EditOp::smooth:
      return find_means(edit_, before_, block, weights.reached, out);
    case EditOp::inflate:
      return find_slopes(rules_.to_world, before_, block, weights.reached, out);
    case EditOp::fill:
    case EditOp::revert:
    case EditOp::paint:
      assert(false && "has no operand");
  }
}

}  // namespace mc::edit
