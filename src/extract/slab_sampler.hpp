// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "extract/edge_vertex.hpp"
#include "extract/vertex_writer.hpp"
#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Samples of a slab, one by one and along rows.

namespace mc::extraction {

/// Samples of a slab, addressed by the volume's indices.
template <class T, bool Swap>
class SlabSampler {
 public:
  SlabSampler(const Slab& slab, const IndexBox& box) : slab_(slab), box_(box) {}

  [[nodiscard]] const IndexBox& box() const noexcept { return box_; }
  [[nodiscard]] const std::byte* row(std::int32_t j, std::int32_t k) const noexcept {
    return slab_.planes[static_cast<std::size_t>(k - slab_.k0)] +
           static_cast<std::size_t>(j) * slab_.row_stride_bytes;
  }
  [[nodiscard]] T raw(const Index3& p) const noexcept {
    return field::load_sample<T, Swap>(row(p[1], p[2]) +
                                       static_cast<std::size_t>(p[0]) * sizeof(T));
  }
  [[nodiscard]] Real<T> at(const Index3& p) const noexcept {
    return static_cast<Real<T>>(field::number(raw(p)));
  }

 private:
  const Slab& slab_;
  IndexBox box_;
};

/// A row of samples and those it is compared with for gradients: one-sided at the box's border.
template <class T, bool Swap>
class GradientRow {
 public:
  using R = Real<T>;

  GradientRow(const SlabSampler<T, Swap>& s, std::int32_t j, std::int32_t k)
      : lo_i_(s.box().lo[0]), hi_i_(s.box().hi[0]), row_(s.row(j, k)) {
    const IndexBox& box = s.box();
    const std::int32_t j0 = std::max(j - 1, box.lo[1]);
    const std::int32_t j1 = std::min(j + 1, box.hi[1]);
    const std::int32_t k0 = std::max(k - 1, box.lo[2]);
    const std::int32_t k1 = std::min(k + 1, box.hi[2]);
    before_j_ = s.row(j0, k);
    behind_j_ = s.row(j1, k);
    before_k_ = s.row(j, k0);
    behind_k_ = s.row(j, k1);
    scale_j_ = scale(j0, j1);
    scale_k_ = scale(k0, k1);
  }

  /// EdgeVertices::gradient() at sample i of the row.
  void at(std::int32_t i, R& gi, R& gj, R& gk) const noexcept {
    const std::int32_t i0 = std::max(i - 1, lo_i_);
    const std::int32_t i1 = std::min(i + 1, hi_i_);
    gi = (sample(row_, i1) - sample(row_, i0)) * scale(i0, i1);
    gj = (sample(behind_j_, i) - sample(before_j_, i)) * scale_j_;
    gk = (sample(behind_k_, i) - sample(before_k_, i)) * scale_k_;
  }
  [[nodiscard]] R value(std::int32_t i) const noexcept { return sample(row_, i); }

 private:
  static R scale(std::int32_t before, std::int32_t behind) {
    return behind - before == 2 ? R{0.5} : R{1};
  }
  static R sample(const std::byte* row, std::int32_t i) noexcept {
    return static_cast<R>(
        field::number(field::load_sample<T, Swap>(row + static_cast<std::size_t>(i) * sizeof(T))));
  }

  std::int32_t lo_i_, hi_i_;
  const std::byte *row_, *before_j_, *behind_j_, *before_k_, *behind_k_;
  R scale_j_, scale_k_;
};

/// Gathers the samples around edges [first, last) of a batch, which all start in row (j, k) and run
/// along `axis`; their i is already there.
template <class T, bool Swap>
void gather_run(const SlabSampler<T, Swap>& s, EdgeBatch<Real<T>>& batch, std::size_t first,
                std::size_t last, std::int32_t j, std::int32_t k, std::int32_t axis,
                bool with_gradients) {
  using R = Real<T>;
  const std::size_t n = last - first;
  const auto fill = [&](auto& buffer, auto value) {
    std::fill_n(buffer.begin() + static_cast<std::ptrdiff_t>(first), n, value);
  };
  fill(batch.j, j);
  fill(batch.k, k);
  fill(batch.axis, axis);
  const IndexBox& box = s.box();
  const std::int32_t j2 = j + (axis == 1 ? 1 : 0);
  const std::int32_t k2 = k + (axis == 2 ? 1 : 0);
  const std::int32_t di = axis == 0 ? 1 : 0;
  const auto clear = [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to; ++e) {
      batch.a[e] = batch.b[e] = R{};
      for (std::size_t a = 0; a < 3 && with_gradients; ++a) {
        batch.lower_gradient[a][e] = batch.upper_gradient[a][e] = R{};
      }
    }
  };
  // Edges that lead out of the box: whole rows of them, or the ends of a row along i.
  if (j < box.lo[1] || k < box.lo[2] || j2 > box.hi[1] || k2 > box.hi[2]) {
    clear(first, last);
    return;
  }
  if (first < last && batch.i[first] < box.lo[0]) {
    clear(first, first + 1);
    ++first;
  }
  if (first < last && batch.i[last - 1] + di > box.hi[0]) {
    clear(last - 1, last);
    --last;
  }
  const std::int32_t* i = batch.i.data();
  if (with_gradients) {
    const GradientRow<T, Swap> lower(s, j, k);
    const GradientRow<T, Swap> upper(s, j2, k2);
    auto& g = batch.lower_gradient;
    auto& h = batch.upper_gradient;
    for (std::size_t e = first; e < last; ++e) {
      batch.a[e] = lower.value(i[e]);
      batch.b[e] = upper.value(i[e] + di);
      lower.at(i[e], g[0][e], g[1][e], g[2][e]);
      upper.at(i[e] + di, h[0][e], h[1][e], h[2][e]);
    }
    return;
  }
  const std::byte* const lower = s.row(j, k);
  const std::byte* const upper = s.row(j2, k2) + static_cast<std::size_t>(di) * sizeof(T);
  for (std::size_t e = first; e < last; ++e) {
    const std::size_t at = static_cast<std::size_t>(i[e]) * sizeof(T);
    batch.a[e] = static_cast<R>(field::number(field::load_sample<T, Swap>(lower + at)));
    batch.b[e] = static_cast<R>(field::number(field::load_sample<T, Swap>(upper + at)));
  }
}

}  // namespace mc::extraction
