// SPDX-License-Identifier: MIT
#include "edit/neighbourhood.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/vectors.hpp"
#include "edit/combine.hpp"
#include "graph/float_math.hpp"

// What operations see around a sample. Every sum has one order, so that the bits do not depend on
// how the work was shared.

namespace mc::edit {

namespace {

/// The samples of a block and `ring` more on each side, as numbers; the volume's border goes on.
class Surroundings {
 public:
  Surroundings(const EditedSamples& samples, const Index3& block, std::int32_t ring)
      : ring_(ring), side_(kBlockSize + 2 * ring), whole_(samples_of(block)) {
    for (std::size_t a = 0; a < 3; ++a) whole_.lo[a] -= ring, whole_.hi[a] += ring;
    box_ = whole_;
    if (samples.input().leaves() == nullptr) {
      box_ = common_part(whole_, samples.input().volume().lattice.box);
    }
    const auto n = static_cast<std::size_t>(box_.extent(0) * box_.extent(1) * box_.extent(2));
    Buffer<std::byte> bytes(n * samples.input().sample_bytes());
    samples.read_box(box_, bytes);
    values_.resize(n);
    to_doubles(samples.type(), bytes, values_.data());
    if (box_ != whole_) spread();
  }

  [[nodiscard]] std::int32_t side() const { return side_; }
  [[nodiscard]] const Buffer<double>& values() const { return values_; }
  /// Place of a sample, counted from the block's first.
  [[nodiscard]] std::size_t at(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const std::int32_t n = ((k + ring_) * side_ + (j + ring_)) * side_ + (i + ring_);
    return static_cast<std::size_t>(n);
  }
  [[nodiscard]] double value(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return values_[at(i, j, k)];
  }
  /// Whether a sample, counted from the block's first, is one of the volume's.
  [[nodiscard]] bool exists(const Index3& p) const {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int32_t index = whole_.lo[a] + ring_ + p[a];
      if (index < box_.lo[a] || index > box_.hi[a]) return false;
    }
    return true;
  }

 private:
  /// From the part within the volume to the whole cube.
  void spread() {
    Buffer<double> out;
    out.reserve(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_ * side_));
    const auto held = [&](std::size_t a, std::int32_t v) {
      const std::int32_t index = std::clamp(whole_.lo[a] + v, box_.lo[a], box_.hi[a]);
      return static_cast<std::size_t>(index - box_.lo[a]);
    };
    const auto nx = static_cast<std::size_t>(box_.extent(0));
    const auto ny = static_cast<std::size_t>(box_.extent(1));
    for (std::int32_t k = 0; k < side_; ++k) {
      for (std::int32_t j = 0; j < side_; ++j) {
        const double* row = values_.data() + (held(2, k) * ny + held(1, j)) * nx;
        for (std::int32_t i = 0; i < side_; ++i) out.push_back(row[held(0, i)]);
      }
    }
    values_ = std::move(out);
  }

  std::int32_t ring_;
  std::int32_t side_;
  IndexBox whole_;
  IndexBox box_;
  Buffer<double> values_;
};

/// Weights of a kernel at -n .. n. The box's last ones are the part of a sample that it covers; the
/// bell's width is half its radius.
std::vector<double> kernel_weights(SmoothKernel kernel, double radius) {
  const auto n = static_cast<std::int32_t>(std::ceil(radius));
  std::vector<double> out;
  for (std::int32_t at = -n; at <= n; ++at) {
    const double off = std::abs(at);
    if (kernel == SmoothKernel::box) {
      out.push_back(off < n ? 1 : radius - (n - 1));
    } else {
      const double part = off / radius;
      const double exponent = std::max(-2 * part * part * 1.4426950408889634, -126.0);
      out.push_back(static_cast<double>(graph::exact_exp2(static_cast<float>(exponent))));
    }
  }
  return out;
}

/// Sums along the fastest axis, of which eight are left; what comes out has that axis slowest, so
/// that three turns are all axes.
void sum_lines(const std::vector<double>& weights, std::size_t n_lines, std::size_t length_in,
               const double* in, double* out) {
  for (std::size_t line = 0; line < n_lines; ++line) {
    for (std::size_t at = 0; at < kBlockSize; ++at) {
      const double* from = in + line * length_in + at;
      double sum = 0;
      for (std::size_t n = 0; n < weights.size(); ++n) sum += weights[n] * from[n];
      out[at * n_lines + line] = sum;
    }
  }
}

/// The weighted sums of a cube around each sample of a block: along i, then j, then k.
void sum_cube(const std::vector<double>& weights, std::size_t side, const Buffer<double>& cube,
              double* out) {
  Buffer<double> a(side * side * kBlockSize);
  Buffer<double> b(side * kBlockSize * kBlockSize);
  sum_lines(weights, side * side, side, cube.data(), a.data());      // i, k, j: j is fastest
  sum_lines(weights, kBlockSize * side, side, a.data(), b.data());   // j, i, k
  sum_lines(weights, kBlockSize * kBlockSize, side, b.data(), out);  // k, j, i
}

void find_weighted_means(const std::vector<double>& weights, const Surroundings& around,
                         std::span<double, kBlockSamples> out) {
  const auto side = static_cast<std::size_t>(around.side());
  const auto is_number = [](double v) { return v == v; };
  const Buffer<double>& values = around.values();
  if (std::all_of(values.begin(), values.end(), is_number)) {
    double line = 0;
    for (const double w : weights) line += w;
    double plane = 0;
    for (const double w : weights) plane += w * line;
    double cube = 0;
    for (const double w : weights) cube += w * plane;
    sum_cube(weights, side, values, out.data());
    for (double& v : out) v /= cube;
    return;
  }
  Buffer<double> numbers(values.size());
  Buffer<double> present(values.size());
  for (std::size_t n = 0; n < values.size(); ++n) {
    present[n] = is_number(values[n]) ? 1 : 0;
    numbers[n] = is_number(values[n]) ? values[n] : 0;
  }
  std::array<double, kBlockSamples> counts;
  sum_cube(weights, side, numbers, out.data());
  sum_cube(weights, side, present, counts.data());
  for (std::size_t n = 0; n < kBlockSamples; ++n) out[n] /= counts[n];
}

/// The middle of the numbers around each reached sample; of an even count the lower of both.
void find_medians(std::int32_t n, const Surroundings& around, const Mask512& reached,
                  std::span<double, kBlockSamples> out) {
  std::vector<double> window;
  for_rows_of(reached, [&](std::size_t row) {
    for (std::int32_t i = 0; i < kBlockSize; ++i) {
      window.clear();
      for (std::int32_t dk = -n; dk <= n; ++dk) {
        for (std::int32_t dj = -n; dj <= n; ++dj) {
          for (std::int32_t di = -n; di <= n; ++di) {
            const double v = around.value(i + di, static_cast<std::int32_t>(row % kBlockSize) + dj,
                                          static_cast<std::int32_t>(row / kBlockSize) + dk);
            if (v == v) window.push_back(v);
          }
        }
      }
      double& to = out[row * kBlockSize + static_cast<std::size_t>(i)];
      to = std::nan("");
      if (window.empty()) continue;
      const auto middle = window.begin() + static_cast<std::ptrdiff_t>((window.size() - 1) / 2);
      std::nth_element(window.begin(), middle, window.end());
      to = *middle;
    }
  });
}

/// Central differences along the lattice's axes; one-sided at the border, 0 where there is nothing
/// to subtract. To the world by the inverse's transpose.
Vec3 gradient_at(const Surroundings& around, const Affine& to_index, const Index3& p) {
  Vec3 steps{};
  for (std::size_t a = 0; a < 3; ++a) {
    Index3 lo = p;
    Index3 hi = p;
    --lo[a], ++hi[a];
    const int apart = (around.exists(lo) ? 1 : 0) + (around.exists(hi) ? 1 : 0);
    const double rise = around.value(hi[0], hi[1], hi[2]) - around.value(lo[0], lo[1], lo[2]);
    steps[a] = apart > 0 ? rise / apart : 0;
  }
  Vec3 out;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& m = to_index.m;
    out[a] = (m[a] * steps[0] + m[4 + a] * steps[1]) + m[8 + a] * steps[2];
  }
  return out;
}

Index3 local_place(std::size_t n) {
  return {static_cast<std::int32_t>(n % 8), static_cast<std::int32_t>(n / 8 % 8),
          static_cast<std::int32_t>(n / 64)};
}

}  // namespace

void find_means(const Edit& edit, const EditedSamples& before, const Index3& block,
                const Mask512& reached, std::span<double, kBlockSamples> out) {
  const auto n = static_cast<std::int32_t>(std::ceil(edit.kernel_radius));
  assert(n >= 1);
  const Surroundings around(before, block, n);
  if (edit.kernel == SmoothKernel::median) return find_medians(n, around, reached, out);
  find_weighted_means(kernel_weights(edit.kernel, edit.kernel_radius), around, out);
}

void find_slopes(const Affine& to_world, const EditedSamples& before, const Index3& block,
                 const Mask512& reached, std::span<double, kBlockSamples> out) {
  const Surroundings around(before, block, 1);
  const Affine to_index = inverse(to_world);
  for_rows_of(reached, [&](std::size_t row) {
    for (std::size_t n = row * kBlockSize; n < (row + 1) * kBlockSize; ++n) {
      out[n] = length(gradient_at(around, to_index, local_place(n)));
    }
  });
}

void SurfaceSums::add(const SurfaceSums& other) {
  weight += other.weight;
  for (std::size_t a = 0; a < 3; ++a) {
    point[a] += other.point[a];
    gradient[a] += other.gradient[a];
  }
}

std::optional<FlattenPlane> SurfaceSums::plane(bool above) const {
  const double steepness = length(gradient);
  if (!(weight > 0) || !(steepness > 0) || !std::isfinite(steepness)) return std::nullopt;
  FlattenPlane out;
  for (std::size_t a = 0; a < 3; ++a) {
    out.point[a] = point[a] / weight;
    out.normal[a] = (above ? -gradient[a] : gradient[a]) / steepness;
  }
  return out;
}

SurfaceSums sum_surface(const EditRules& rules, const EditedSamples& before, const Index3& block,
                        const BlockWeights& weights) {
  const Surroundings around(before, block, 1);
  const Affine to_index = inverse(rules.to_world);
  const Index3 first = origin_of(block);
  SurfaceSums out;
  for_rows_of(weights.reached, [&](std::size_t row) {
    for (std::size_t n = row * kBlockSize; n < (row + 1) * kBlockSize; ++n) {
      const double w = weights.weight[n];
      const Index3 p = local_place(n);
      for (std::size_t a = 0; a < 3 && w > 0; ++a) {
        Index3 q = p;
        ++q[a];
        const double from = around.value(p[0], p[1], p[2]);
        const double to = around.value(q[0], q[1], q[2]);
        if (!around.exists(q) || (from >= rules.iso) == (to >= rules.iso)) continue;
        const double t = (rules.iso - from) / (to - from);
        const Vec3 gradient = gradient_at(around, to_index, p);
        if (!(t == t) || !(length(gradient) == length(gradient))) continue;
        Vec3 index;
        for (std::size_t b = 0; b < 3; ++b) index[b] = static_cast<double>(first[b] + p[b]);
        index[a] += t;
        const Vec3 place = rules.to_world(index);
        SurfaceSums one;
        one.weight = w;
        for (std::size_t b = 0; b < 3; ++b) {
          one.point[b] = w * place[b];
          one.gradient[b] = w * gradient[b];
        }
        out.add(one);
      }
    }
  });
  return out;
}

}  // namespace mc::edit
