// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "extract/cubes/edge_vertex.hpp"
#include "extract/cubes/vertex_kernels.hpp"
#include "mc/mesh.hpp"

// Vertices are made in batches: the samples around crossed edges are gathered one edge at a time,
// all arithmetic then runs on vectors. A batch stays in the first cache.

namespace mc::extraction {

/// Crossed edges waiting for their vertices, structure of arrays. Scratch: keeps its memory.
template <class R>
struct EdgeBatch {
  /// Edges that are worth a call of the kernels.
  static constexpr std::size_t kEnough = 1024;
  static constexpr std::size_t kBytesAnEdge = 5 * sizeof(std::int32_t) + 9 * sizeof(R);

  std::size_t n = 0;
  Buffer<std::int32_t> i, j, k, axis;
  Buffer<R> a, b, t;  ///< samples at the lower and the upper end; parameter
  std::array<Buffer<R>, 3> lower_gradient, upper_gradient;
  Buffer<std::uint32_t> failed;

  /// Makes room for so many edges and one more vector.
  void reserve(std::size_t n_edges, bool with_gradients) {
    const std::size_t room = n_edges + kEdgesAtOnce;
    if (i.size() < room) {
      for (Buffer<std::int32_t>* buffer : {&i, &j, &k, &axis}) buffer->resize(room);
      for (Buffer<R>* buffer : {&a, &b, &t}) buffer->resize(room);
      failed.resize(room);
    }
    if (with_gradients && lower_gradient[0].size() < room) {
      for (Buffer<R>& buffer : lower_gradient) buffer.resize(room);
      for (Buffer<R>& buffer : upper_gradient) buffer.resize(room);
    }
  }

  /// Edges that there is room for.
  [[nodiscard]] std::size_t room() const { return i.size() - kEdgesAtOnce; }

  /// Repeats the last edge up to a whole vector: where it is, and what is there.
  void pad_places() {
    for (Buffer<std::int32_t>* buffer : {&i, &j, &k, &axis}) repeat(*buffer);
  }
  void pad_samples(bool with_gradients) {
    for (Buffer<R>* buffer : {&a, &b}) repeat(*buffer);
    if (with_gradients) {
      for (Buffer<R>& buffer : lower_gradient) repeat(buffer);
      for (Buffer<R>& buffer : upper_gradient) repeat(buffer);
    }
  }
  template <class V>
  void repeat(Buffer<V>& buffer) const {
    assert(n >= 1 && n + kEdgesAtOnce <= buffer.size());
    std::fill_n(buffer.begin() + static_cast<std::ptrdiff_t>(n), kEdgesAtOnce, buffer[n - 1]);
  }

  [[nodiscard]] LatticeEdge edge(std::size_t e) const {
    return {{i[e], j[e], k[e]}, Axis(static_cast<std::size_t>(axis[e]))};
  }
};

/// Appends vertices to a chunk, in the order of their edges.
template <class T, class Sampler>
class VertexWriter {
 public:
  using R = Real<T>;

  VertexWriter(const VertexRules<T>& rules, const Sampler& sampler, Precision precision,
               EdgeBatch<R>& batch, MeshChunk& chunk, Bounds& bounds)
      : rules_(rules),
        vertices_(rules, sampler),
        sampler_(sampler),
        f64_(precision == Precision::f64),
        batch_(batch),
        chunk_(chunk),
        bounds_(bounds),
        turn_(rules.placement.cofactors) {
    for (double& x : turn_) x *= rules.placement.outward;
    batch_.n = 0;
  }

  [[nodiscard]] bool wants_gradients() const { return rules_.normals == Normals::gradient; }

  /// An edge, the samples at its ends, and the gradients there where they are wanted.
  struct CutEdge {
    LatticeEdge edge;
    R a, b;
    std::array<R, 3> lower_gradient, upper_gradient;
  };

  /// Adds one edge. Call flush() after the last.
  void write(const LatticeEdge& e) {
    if (batch_.n == EdgeBatch<R>::kEnough) flush();
    batch_.reserve(EdgeBatch<R>::kEnough, wants_gradients());
    CutEdge cut{e, {}, {}, {}, {}};
    if (vertices_.leads_out(e) == 0) {
      const Index3 upper = step(e.lower, e.axis);
      cut.a = sampler_.at(e.lower);
      cut.b = sampler_.at(upper);
      if (wants_gradients()) {
        cut.lower_gradient = vertices_.gradient(e.lower);
        cut.upper_gradient = vertices_.gradient(upper);
      }
    }
    append(cut);
  }

  /// Adds n edges inside the box, edge_at(m) each.
  template <class EdgeAt>
  void write_inside(std::size_t n, EdgeAt&& edge_at) {
    batch_.reserve(EdgeBatch<R>::kEnough, wants_gradients());
    for (std::size_t m = 0; m < n;) {
      if (batch_.n == EdgeBatch<R>::kEnough) flush();
      const std::size_t end = std::min(n, m + EdgeBatch<R>::kEnough - batch_.n);
      for (; m < end; ++m) append(edge_at(m));
    }
  }

  /// Edges that were added and have no vertices yet.
  [[nodiscard]] std::size_t n_waiting() const { return batch_.n; }

  /// Makes the vertices of the batch's edges. Of edges that lead out, a, b and gradients are zero.
  void flush() {
    if (batch_.n == 0) return;
    batch_.pad_places();
    batch_.pad_samples(wants_gradients());
    flush_padded();
  }

  /// The same of a batch that is filled up to a whole vector.
  void flush_padded() {
    cut_edges(rules_.edge, batch_.a.data(), batch_.b.data(), batch_.n, batch_.t.data());
    if (rules_.capped) cut_outer_edges();
    batch_.repeat(batch_.t);
    if (f64_) {
      place(chunk_.positions_f64);
    } else {
      place(chunk_.positions);
    }
    if (rules_.normals != Normals::none) orient();
    batch_.n = 0;
  }

 private:
  void append(const CutEdge& cut) {
    assert(batch_.n < batch_.room());
    const std::size_t at = batch_.n++;
    batch_.i[at] = cut.edge.lower[0];
    batch_.j[at] = cut.edge.lower[1];
    batch_.k[at] = cut.edge.lower[2];
    batch_.axis[at] = static_cast<std::int32_t>(cut.edge.axis);
    batch_.a[at] = cut.a;
    batch_.b[at] = cut.b;
    for (std::size_t a = 0; wants_gradients() && a < 3; ++a) {
      batch_.lower_gradient[a][at] = cut.lower_gradient[a];
      batch_.upper_gradient[a][at] = cut.upper_gradient[a];
    }
  }

  void cut_outer_edges() {
    for (std::size_t e = 0; e < batch_.n; ++e) {
      const int out = vertices_.leads_out(batch_.edge(e));
      if (out != 0) batch_.t[e] = vertices_.outer_parameter(out);
    }
  }

  template <class P>
  void place(Buffer<P>& positions) {
    const std::size_t before = positions.size();
    positions.resize(before + 3 * (batch_.n + kEdgesAtOnce));
    place_vertices(
        {batch_.i.data(), batch_.j.data(), batch_.k.data(), batch_.axis.data(), batch_.n},
        batch_.t.data(), rules_.placement.map, positions.data() + before, bounds_);
    positions.resize(before + 3 * batch_.n);
  }

  void orient() {
    const std::size_t before = chunk_.normals.size();
    chunk_.normals.resize(before + 3 * (batch_.n + kEdgesAtOnce));
    float* out = chunk_.normals.data() + before;
    const auto set = [&](std::size_t e) {
      const std::array<float, 3> normal = vertices_.normal(batch_.edge(e), batch_.t[e]);
      std::copy(normal.begin(), normal.end(), out + 3 * e);
    };
    if (wants_gradients()) {
      const auto& lower = batch_.lower_gradient;
      const auto& upper = batch_.upper_gradient;
      const std::size_t n_failed =
          orient_vertices(EdgeGradients<R>{{lower[0].data(), lower[1].data(), lower[2].data()},
                                           {upper[0].data(), upper[1].data(), upper[2].data()}},
                          batch_.t.data(), batch_.n, turn_, out, batch_.failed.data());
      for (std::size_t f = 0; f < n_failed; ++f) set(batch_.failed[f]);
    } else {
      for (std::size_t e = 0; e < batch_.n; ++e) set(e);
    }
    chunk_.normals.resize(before + 3 * batch_.n);
  }

  const VertexRules<T>& rules_;
  EdgeVertices<T, Sampler> vertices_;
  const Sampler& sampler_;
  bool f64_;
  EdgeBatch<R>& batch_;
  MeshChunk& chunk_;
  Bounds& bounds_;
  std::array<double, 9> turn_;  ///< cofactors, signed to point out of the solid
};

}  // namespace mc::extraction
