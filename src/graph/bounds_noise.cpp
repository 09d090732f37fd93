// SPDX-License-Identifier: MIT
#include "graph/bounds_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "graph/interval_math.hpp"
#include "graph/noise_range.hpp"
#include "graph/rows.hpp"

// A noise is sampled on a grid over the box. Between the grid's places it cannot leave the range of
// its samples by more than its steepness, or how much it bends, allows.

namespace mc::graph {

namespace {

/// A grid over a box, its corners included.
class Grid {
 public:
  Grid(const Interval (&at)[3], std::size_t n_axes, float frequency) : n_axes_(n_axes) {
    for (std::size_t a = 0; a < n_axes; ++a) width_[a] = (at[a].hi - at[a].lo) * frequency;
    // Three axes share 32 places: the shortest has no more than its ends.
    const bool flat = n_axes < 3 || !(width_[0] > 0 && width_[1] > 0 && width_[2] > 0);
    const auto shortest = std::min_element(width_.begin(), width_.end()) - width_.begin();
    for (std::size_t a = 0; a < n_axes; ++a) {
      const bool has_few = !flat && a == static_cast<std::size_t>(shortest);
      n_steps_[a] = !(width_[a] > 0) ? 0 : has_few ? 1 : 3;
      place(at[a], n_steps_[a], places_[a]);
    }
  }
  /// How far what lies between the places may be beyond them.
  [[nodiscard]] float reach(const Shape& shape) const {
    constexpr float kPart[] = {0, 1, 0, 1.0F / 3};
    float square = 0;
    for (std::size_t a = 0; a < n_axes_; ++a) {
      const float step = width_[a] * kPart[n_steps_[a]];
      square += step * step;
    }
    const float by_slope = shape.slope * 0.5F * __builtin_sqrtf(square);
    // Multilinear interpolation stays within the samples, and is as close as that to the noise.
    return shape.bend > 0 ? std::min(by_slope, shape.bend * 0.125F * square) : by_slope;
  }
  [[nodiscard]] Interval sampled(const Instruction& instruction) const;

 private:
  static void place(const Interval& at, std::size_t n_steps, std::array<float, 4>& out) {
    out = {at.lo, at.lo * (2.0F / 3) + at.hi * (1.0F / 3), at.lo * (1.0F / 3) + at.hi * (2.0F / 3),
           at.hi};
    if (n_steps == 1) out[1] = at.hi;
  }

  std::size_t n_axes_;
  std::array<float, 3> width_{};
  std::array<std::size_t, 3> n_steps_{};
  std::array<std::array<float, 4>, 3> places_{};
};

Interval Grid::sampled(const Instruction& instruction) const {
  using Places = std::array<float, 32>;
  static_assert(std::tuple_size_v<Places> % kRowStep == 0);
  std::array<Places, 3> at{};
  std::size_t n = 0;
  for (std::size_t k = 0; k <= n_steps_[2]; ++k) {
    for (std::size_t j = 0; j <= n_steps_[1]; ++j) {
      for (std::size_t i = 0; i <= n_steps_[0]; ++i, ++n) {
        at[0][n] = places_[0][i];
        at[1][n] = places_[1][j];
        at[2][n] = places_[2][k];
      }
    }
  }
  Places value{};
  any_row(instruction, at[0].data(), at[1].data(), at[2].data(), n, value.data());
  Places most = value;
  for (std::size_t half = n / 2; half > 0; half /= 2) {  // n is a power of two
    for (std::size_t s = 0; s < half; ++s) {
      value[s] = std::min(value[s], value[s + half]);
      most[s] = std::max(most[s], most[s + half]);
    }
  }
  return between(value[0], most[0]);
}

}  // namespace

Interval whole_range(const Instruction& instruction) {
  const NoiseRange range = noise_range(instruction);
  return between(range.lo, range.hi);
}

Interval noise_bounds(const Instruction& instruction, const Interval (&at)[3], Shape shape) {
  const float frequency = std::abs(instruction.p[0]);
  float farthest = 0;
  for (std::size_t a = 0; a < instruction.n_in; ++a) {
    farthest = std::max(farthest, size_of(at[a]) * frequency);
  }
  const Interval range = whole_range(instruction);
  if (!(farthest <= 0x1p20F)) return range;
  const Grid grid(at, instruction.n_in, frequency);
  // Coordinates are rounded before and after they are scaled.
  const float reach = grid.reach(shape) + shape.slope * farthest * 0x1p-20F + 1e-4F;
  if (!(reach < 0.9F)) return range;
  const Interval samples = grid.sampled(instruction);
  if (!samples.known()) return kUnknown;
  return between(std::max(range.lo, samples.lo - reach), std::min(range.hi, samples.hi + reach));
}

Interval cellular_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto what = static_cast<CellReturn>(instruction.p[2]);
  if (what == CellReturn::value) return whole_range(instruction);
  const bool manhattan = static_cast<CellMetric>(instruction.p[3]) == CellMetric::manhattan;
  const float steepness = manhattan ? 1.75F : 1.01F;
  return noise_bounds(instruction, at, {steepness * (what == CellReturn::f2_f1 ? 2.0F : 1.0F), 0});
}

}  // namespace mc::graph
