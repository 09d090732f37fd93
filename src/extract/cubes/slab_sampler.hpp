// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "extract/cubes/edge_vertex.hpp"
#include "extract/cubes/gather_kernels.hpp"
#include "extract/cubes/vertex_writer.hpp"
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
    assert(slab_.k0 <= k && static_cast<std::size_t>(k - slab_.k0) < slab_.planes.size());
    assert(slab_.j0 <= j);
    return slab_.planes[static_cast<std::size_t>(k - slab_.k0)] +
           static_cast<std::size_t>(j - slab_.j0) * slab_.row_stride_bytes;
  }
  [[nodiscard]] T raw(const Index3& p) const noexcept {
    assert(box_.contains(p));
    return field::load_sample<T, Swap>(row(p[1], p[2]) +
                                       static_cast<std::size_t>(p[0] - slab_.i0) * sizeof(T));
  }
  [[nodiscard]] Real<T> at(const Index3& p) const noexcept {
    return static_cast<Real<T>>(field::number(raw(p)));
  }

 private:
  const Slab& slab_;
  IndexBox box_;
};

/// Gathers the samples around the edges of a batch.
template <class T, bool Swap>
class SlabGatherer {
 public:
  using R = Real<T>;
  using Sampler = SlabSampler<T, Swap>;

  SlabGatherer(const Slab& slab, const Sampler& sampler, const EdgeVertices<T, Sampler>& vertices,
               bool with_gradients)
      : stride_(slab.row_stride_bytes),
        slab_(slab),
        sampler_(sampler),
        vertices_(vertices),
        with_gradients_(with_gradients) {}

  /// Those of the batch's edges from `first` on: all start in plane k and, unless `capped`, lie in
  /// the box. Of those that lead out of it the samples are zero. The batch's places are padded.
  void gather(EdgeBatch<R>& batch, std::size_t first, std::int32_t k, bool capped) const {
    const Gathered done = gather_at_once(batch, first, k);
    for (std::size_t f = 0; f < done.n_failed; ++f) clear(batch, first + batch.failed[f]);
    if (done.n != 0) return;
    if (capped) {
      for (std::size_t e = first; e < batch.n; ++e) gather_one(batch, e);
    } else {
      gather_values(batch, first, k);
      if (with_gradients_) gather_gradients(batch, first, k);
    }
  }

 private:
  /// Edges that are asked for before their turn: planes lie too far apart to stay in a core's
  /// cache.
  static constexpr std::size_t kAhead = 24;

  static R load(const std::byte* at) {
    return static_cast<R>(field::number(field::load_sample<T, Swap>(at)));
  }
  [[nodiscard]] const std::byte* plane(std::int32_t k) const {
    return slab_.planes[static_cast<std::size_t>(k - slab_.k0)];
  }
  [[nodiscard]] std::size_t offset(std::int32_t i, std::int32_t j) const {
    return static_cast<std::size_t>(j - slab_.j0) * stride_ +
           static_cast<std::size_t>(i - slab_.i0) * sizeof(T);
  }

  /// All edges, or none, as gather_edges() does.
  Gathered gather_at_once(EdgeBatch<R>& batch, std::size_t first, std::int32_t k) const {
    if constexpr (std::is_same_v<R, float>) {
      const IndexBox& box = sampler_.box();
      const bool between = batch.axis[first] == 2;
      const std::int32_t upper = k + (between ? 1 : 0);
      if (k < box.lo[2] || upper > box.hi[2]) return {};
      const auto nearest = [&](std::int32_t n) {
        return plane(std::clamp(n, box.lo[2], box.hi[2]));
      };
      const auto scale = [&](std::int32_t n) {
        return n > box.lo[2] && n < box.hi[2] ? 0.5F : 1.0F;
      };
      const bool wants_after = with_gradients_ || between;
      const PlaneSamples planes{.type = field::type_of<T>(),
                                .swap = Swap,
                                .before = with_gradients_ ? nearest(k - 1) : nullptr,
                                .here = plane(k),
                                .after = wants_after ? nearest(k + 1) : nullptr,
                                .after_next = with_gradients_ && between ? nearest(k + 2) : nullptr,
                                .lower_scale = scale(k),
                                .upper_scale = scale(upper),
                                .row_bytes = stride_,
                                .first = {slab_.i0, slab_.j0},
                                .lo = {box.lo[0], box.lo[1]},
                                .hi = {box.hi[0], box.hi[1]}};
      const auto from = [first](auto& buffer) {
        return buffer.empty() ? nullptr : buffer.data() + first;
      };
      const auto gradients = [&](auto& of) {
        return std::array{from(of[0]), from(of[1]), from(of[2])};
      };
      const EdgePlaces edges{from(batch.i), from(batch.j), from(batch.k), from(batch.axis),
                             batch.n - first};
      return gather_edges(planes, edges, between, with_gradients_,
                          {.a = from(batch.a),
                           .b = from(batch.b),
                           .lower_gradient = gradients(batch.lower_gradient),
                           .upper_gradient = gradients(batch.upper_gradient),
                           .failed = batch.failed.data()});
    } else {
      return {};
    }
  }

  void gather_values(EdgeBatch<R>& batch, std::size_t first, std::int32_t k) const {
    const std::int32_t *const i = batch.i.data(), *const j = batch.j.data();
    const std::int32_t* const axis = batch.axis.data();
    R *const a = batch.a.data(), *const b = batch.b.data();
    const std::byte* const lower = plane(k);
    const bool between = axis[first] == 2;
    const std::ptrdiff_t to_upper[3] = {sizeof(T), static_cast<std::ptrdiff_t>(stride_),
                                        between ? plane(k + 1) - lower : 0};
    for (std::size_t e = first; e < batch.n; ++e) {
      const std::byte* const at = lower + offset(i[e], j[e]);
      a[e] = load(at);
      b[e] = load(at + to_upper[axis[e]]);
    }
  }

  void gather_one(EdgeBatch<R>& batch, std::size_t e) const {
    const LatticeEdge edge = batch.edge(e);
    if (vertices_.leads_out(edge) != 0) {
      clear(batch, e);
      return;
    }
    const Index3 upper = step(edge.lower, edge.axis);
    batch.a[e] = sampler_.at(edge.lower);
    batch.b[e] = sampler_.at(upper);
    if (with_gradients_) gather_gradients_of(batch, e);
  }

  void gather_gradients_of(EdgeBatch<R>& batch, std::size_t e) const {
    const LatticeEdge edge = batch.edge(e);
    const std::array<R, 3> lower = vertices_.gradient(edge.lower);
    const std::array<R, 3> upper = vertices_.gradient(step(edge.lower, edge.axis));
    for (std::size_t a = 0; a < 3; ++a) {
      batch.lower_gradient[a][e] = lower[a];
      batch.upper_gradient[a][e] = upper[a];
    }
  }

  void clear(EdgeBatch<R>& batch, std::size_t e) const {
    batch.a[e] = batch.b[e] = R{};
    for (std::size_t a = 0; a < 3 && with_gradients_; ++a) {
      batch.lower_gradient[a][e] = batch.upper_gradient[a][e] = R{};
    }
  }

  void gather_gradients(EdgeBatch<R>& batch, std::size_t first, std::int32_t k) const {
    const IndexBox& box = sampler_.box();
    const bool between = batch.axis[first] == 2;
    if (k <= box.lo[2] || k + (between ? 1 : 0) >= box.hi[2]) {
      for (std::size_t e = first; e < batch.n; ++e) gather_gradients_of(batch, e);
      return;
    }
    const std::int32_t *const i = batch.i.data(), *const j = batch.j.data();
    const std::int32_t* const axis = batch.axis.data();
    R* const lower[3] = {batch.lower_gradient[0].data(), batch.lower_gradient[1].data(),
                         batch.lower_gradient[2].data()};
    R* const upper[3] = {batch.upper_gradient[0].data(), batch.upper_gradient[1].data(),
                         batch.upper_gradient[2].data()};
    const std::byte* const here = plane(k);
    const std::ptrdiff_t before = plane(k - 1) - here;
    const std::ptrdiff_t behind = plane(k + 1) - here;
    const std::ptrdiff_t upper_before = between ? -behind : before;
    const std::ptrdiff_t upper_behind = between ? plane(k + 2) - plane(k + 1) : behind;
    const std::ptrdiff_t to_upper[3] = {sizeof(T), static_cast<std::ptrdiff_t>(stride_), behind};
    // An edge whose ends both have neighbours on all sides; unsigned, so that one test is enough.
    const auto inner = [](std::int64_t extent) {
      return static_cast<std::uint32_t>(std::max<std::int64_t>(0, extent - 3));
    };
    const std::uint32_t inner_i = inner(box.extent(0));
    const std::uint32_t inner_j = inner(box.extent(1));
    for (std::size_t e = first; e < batch.n; ++e) {
      if (static_cast<std::uint32_t>(i[e] - box.lo[0] - 1) >= inner_i ||
          static_cast<std::uint32_t>(j[e] - box.lo[1] - 1) >= inner_j) {
        gather_gradients_of(batch, e);
        continue;
      }
      const std::size_t later = std::min(e + kAhead, batch.n - 1);
      const std::byte* const next = here + offset(i[later], j[later]);
      __builtin_prefetch(next + before);
      __builtin_prefetch(next + behind);
      __builtin_prefetch(next + (between ? behind + upper_behind : 0));
      const std::byte* const a = here + offset(i[e], j[e]);
      const std::byte* const b = a + to_upper[axis[e]];
      lower[0][e] = (load(a + sizeof(T)) - load(a - sizeof(T))) * R{0.5};
      lower[1][e] = (load(a + stride_) - load(a - stride_)) * R{0.5};
      lower[2][e] = (load(a + behind) - load(a + before)) * R{0.5};
      upper[0][e] = (load(b + sizeof(T)) - load(b - sizeof(T))) * R{0.5};
      upper[1][e] = (load(b + stride_) - load(b - stride_)) * R{0.5};
      upper[2][e] = (load(b + upper_behind) - load(b + upper_before)) * R{0.5};
    }
  }

  std::size_t stride_;
  const Slab& slab_;
  const Sampler& sampler_;
  const EdgeVertices<T, Sampler>& vertices_;
  bool with_gradients_;
};

}  // namespace mc::extraction
