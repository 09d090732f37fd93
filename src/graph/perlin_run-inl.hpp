// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: Perlin noise along x, where y and z stay.
//
// Most rows are such: coordinates, scaled or moved. A gradient's product is then a number, plus or
// minus x, or not: of a few columns of lattice points at a time that is worked out once and looked
// up by all samples between them. A sample's bits are those of perlin2 and perlin3: sums of two
// commute, signs may be turned before or after a product, and adding a zero changes no number but
// -0, which no row gives that runs beside the lattice's lines.

#if defined(MC_GRAPH_PERLIN_RUN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_PERLIN_RUN_INL
#undef MC_GRAPH_PERLIN_RUN_INL
#else
#define MC_GRAPH_PERLIN_RUN_INL
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstddef>

#include "graph/float_math.hpp"
#include "graph/lanes-inl.hpp"
#include "graph/perlin-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {

using Lookup = decltype(hn::IndicesFromVec(Words(), W()));

HWY_INLINE F looked_up(F table, Lookup lanes) {
  return as_floats(hn::TableLookupLanes(as_words(table), lanes));
}

/// What lattice points of a line along x give to a sample x further on: x times slope plus rest.
struct Gradients {
  F slope, rest;
  HWY_INLINE F at(Lookup point, F x) const {
    return x * looked_up(slope, point) + looked_up(rest, point);
  }
};

/// A line of lattice points along x: all of their hashes but x, and the sample as seen from it.
struct Line2 {
  W mixed;
  F y;
  [[nodiscard]] HWY_INLINE Gradients gradients(W x_primed) const {
    const W h = hash_of(x_primed ^ mixed);
    const F main = flipped<29>(set(kMainGradient2), h);
    const F side = flipped<30>(set(kSideGradient2), h);
    return {chosen(h, side, main), y * chosen(h, main, side)};
  }
};
struct Line3 {
  W mixed;
  F y, z;
  /// Where y is first it comes with z, so that x has no part, or with x.
  [[nodiscard]] HWY_INLINE Gradients gradients(W x_primed) const {
    const F one = set(1.0F);
    const W h = hash_of(x_primed ^ mixed);
    const W z_second = takes_z(h);
    const F first = flipped<28>(y, h);
    const F second = flipped<29>(chosen(z_second, z, y), h);
    return {chosen(h, chosen(z_second, set(0.0F), flipped<29>(one, h)), flipped<28>(one, h)),
            chosen(h, chosen(z_second, first + second, first), second)};
  }
};

/// The columns of lattice points base, base + 1, ..., of as many points as a vector has lanes, on
/// each of the lines that surround a row of samples.
template <class Line, std::size_t kLines>
class Columns {
 public:
  HWY_INLINE Columns(const Line (&lines)[kLines], W first) : lines_(lines) { move_to(first); }

  /// Makes the columns hold both ends of all these cells; false where they are too far apart.
  HWY_INLINE bool cover(W cells) {
    if (holds(cells)) return true;
    move_to(cells);
    return holds(cells);
  }

  /// Both ends' gradients on each line, blended along x.
  HWY_INLINE void blend(const Split& x, F (&out)[kLines]) const {
    const Words d;
    const W place = x.cell - base_;
    const Lookup near = hn::IndicesFromVec(d, place);
    const Lookup far = hn::IndicesFromVec(d, place + set(1U));
    const F u = fade(x.rest);
    const F beyond = x.rest - set(1.0F);
    for (std::size_t n = 0; n < kLines; ++n) {
      out[n] = lerp(u, gradients_[n].at(near, x.rest), gradients_[n].at(far, beyond));
    }
  }

 private:
  HWY_INLINE bool holds(W cells) const {
    const Words d;
    return hn::AllTrue(d, hn::Lt(cells - base_, set(std::uint32_t(hn::Lanes(d)) - 1U)));
  }
  HWY_INLINE void move_to(W cells) {
    base_ = set(hn::GetLane(cells));
    const W primed = (base_ + hn::Iota(Words(), 0)) * set(kPrimeX);
    for (std::size_t n = 0; n < kLines; ++n) {
      gradients_[n] = lines_[n].gradients(primed);
    }
  }

  const Line (&lines_)[kLines];
  Gradients gradients_[kLines];
  W base_;
};

inline bool stays(Row row, std::size_t n) {
  std::uint32_t change = 0;
  for (std::size_t i = 0; i < n; ++i) {
    change |= std::bit_cast<std::uint32_t>(row[i]) ^ std::bit_cast<std::uint32_t>(row[0]);
  }
  return change == 0;
}

/// Whether x rises by so few cells that columns serve more than one vector of samples.
inline bool rises_slowly(Row x, float frequency, std::size_t n) {
  const float rise = (x[n - 1] - x[0]) * frequency;
  return hn::Lanes(Floats()) > 1 && rise >= 0 && rise <= 0.625F * static_cast<float>(n);
}

/// Whether the coordinate is an integer, or is one seen from the cell's other side.
inline bool is_whole(float v) {
  const float rest = v - exact_floor(v);
  return !(rest > 0 && rest < 1);
}

/// perlin2 over a row along x.
inline void perlin2_run(Row x, float y_scaled, float frequency, W seed, std::size_t n, OutRow out) {
  const Floats d;
  const F f = set(frequency);
  const F py = set(y_scaled);
  const Split y = split(py);
  const W y0 = y.cell * set(kPrimeY);
  const Line2 lines[2] = {{seed ^ y0, y.rest}, {seed ^ (y0 + set(kPrimeY)), y.rest - set(1.0F)}};
  const F v = fade(y.rest);
  Columns<Line2, 2> columns(lines, split(hn::LoadU(d, x) * f).cell);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const F px = hn::LoadU(d, x + i) * f;
    const Split at = split(px);
    F value = px;
    if (columns.cover(at.cell)) {
      F edge[2];
      columns.blend(at, edge);
      value = lerp(v, edge[0], edge[1]) * set(kPerlin2Scale);
    } else {
      value = perlin2(px, py, seed);
    }
    hn::StoreU(value, d, out + i);
  }
}

/// perlin3 over a row along x; y and z are not both whole.
inline void perlin3_run(Row x, float y_scaled, float z_scaled, float frequency, W seed,
                        std::size_t n, OutRow out) {
  const Floats d;
  const F f = set(frequency);
  const F py = set(y_scaled);
  const F pz = set(z_scaled);
  const Split y = split(py);
  const Split z = split(pz);
  const W y0 = y.cell * set(kPrimeY);
  const W y1 = y0 + set(kPrimeY);
  const W z0 = seed ^ (z.cell * set(kPrimeZ));
  const W z1 = seed ^ (z.cell * set(kPrimeZ) + set(kPrimeZ));
  const F by = y.rest - set(1.0F);
  const F bz = z.rest - set(1.0F);
  const Line3 lines[4] = {
      {y0 ^ z0, y.rest, z.rest}, {y1 ^ z0, by, z.rest}, {y0 ^ z1, y.rest, bz}, {y1 ^ z1, by, bz}};
  const F v = fade(y.rest);
  const F w = fade(z.rest);
  Columns<Line3, 4> columns(lines, split(hn::LoadU(d, x) * f).cell);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const F px = hn::LoadU(d, x + i) * f;
    const Split at = split(px);
    F value = px;
    if (columns.cover(at.cell)) {
      F edge[4];
      columns.blend(at, edge);
      value = lerp(w, lerp(v, edge[0], edge[1]), lerp(v, edge[2], edge[3])) * set(kPerlin3Scale);
    } else {
      value = perlin3(px, py, pz, seed);
    }
    hn::StoreU(value, d, out + i);
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
