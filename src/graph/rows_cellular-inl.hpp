// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see rows.hpp for what the function does.

#if defined(MC_GRAPH_ROWS_CELLULAR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_ROWS_CELLULAR_INL
#undef MC_GRAPH_ROWS_CELLULAR_INL
#else
#define MC_GRAPH_ROWS_CELLULAR_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "graph/lanes-inl.hpp"
#include "graph/rows.hpp"
#include "mc/graph.hpp"

// Cellular noise: one point in each cell, and the distance to the nearest or the second nearest. It
// is exact, and so continuous: cells are visited until none can hold a nearer point.

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {
namespace {

/// Cells are visited by their offset on each axis, near ones first.
constexpr std::array<int, 7> kOffsets{0, -1, 1, -2, 2, -3, 3};

// A metric measures each axis by itself and joins the axes; distances are compared as `join` gives
// them. All points nearer than the farthest that the two nearest can be lie within kReach cells:
// that is sqrt(3) (Manhattan: 3, Chebyshev: 3/2), where the sample's cell and its nearest
// neighbour, one point each, are worst.
struct Euclidean {
  static constexpr std::size_t kReach = 2;
  static HWY_INLINE F measure(F v) { return v * v; }
  static HWY_INLINE F join(F a, F b) { return a + b; }
  static HWY_INLINE F distance(F joined) { return hn::Sqrt(joined); }
};
struct Manhattan {
  static constexpr std::size_t kReach = 3;
  static HWY_INLINE F measure(F v) { return hn::Abs(v); }
  static HWY_INLINE F join(F a, F b) { return a + b; }
  static HWY_INLINE F distance(F joined) { return joined; }
};
struct Chebyshev {
  static constexpr std::size_t kReach = 2;
  static HWY_INLINE F measure(F v) { return hn::Abs(v); }
  static HWY_INLINE F join(F a, F b) { return greatest(a, b); }
  static HWY_INLINE F distance(F joined) { return joined; }
};

/// The cells along one axis: of each its hash, where its middle lies as seen from the sample, and
/// what its point's distance measures at least.
template <class Metric>
struct Axis {
  static constexpr std::size_t kCells = 2 * Metric::kReach + 1;
  std::array<W, kCells> primed;
  std::array<F, kCells> middle;
  std::array<F, kCells> least;

  /// A point is up to half of jitter away from the middle.
  HWY_INLINE Axis(const Split& at, std::uint32_t prime, float jitter) {
    for (std::size_t n = 0; n < kCells; ++n) {
      const int offset = kOffsets[n];
      primed[n] = at.cell * set(prime) + set(static_cast<std::uint32_t>(offset) * prime);
      middle[n] = set(static_cast<float>(offset) + 0.5F) - at.rest;
      least[n] = Metric::measure(greatest(hn::Abs(middle[n]) - set(0.5F * jitter), set(0.0F)));
    }
  }
};

/// What is kept of the points: the nearest distance; and the hash there; or the second nearest.
enum class Keep : std::uint8_t { first, owner, second };

/// The nearest points so far. Cells are skipped only where no lane can gain, and then it would gain
/// nothing: rounding is monotone. So the result does not depend on how many lanes there are.
template <class Metric, Keep kKeep>
struct Nearest {
  F first, second;
  W owner;

  HWY_INLINE Nearest() : first(set(0x1p60F)), second(set(0x1p60F)), owner(set(0U)) {}

  [[nodiscard]] HWY_INLINE bool may_gain(F least) const {
    return !hn::AllFalse(Floats(), hn::Lt(least, kKeep == Keep::second ? second : first));
  }
  HWY_INLINE void take(F distance, W hash) {
    if constexpr (kKeep == Keep::second) {
      second = hn::Min(second, hn::Max(first, distance));
    } else if constexpr (kKeep == Keep::owner) {
      owner = as_words(hn::IfThenElse(hn::Lt(distance, first), as_floats(hash), as_floats(owner)));
    }
    first = hn::Min(first, distance);
  }
};

/// The cells of one line along x. `others` are the line's hashes, and measures of its points' y
/// (and z) are made from their hashes by `measured`; `least` is what those are at least.
template <class Metric, Keep kKeep, class Measured>
HWY_INLINE void visit_line(const Axis<Metric>& x, W others, F least, F jitter,
                           Nearest<Metric, kKeep>& nearest, const Measured& measured) {
  for (std::size_t n = 0; n < Axis<Metric>::kCells; ++n) {
    if (!nearest.may_gain(Metric::join(least, x.least[n]))) {
      continue;
    }
    const W hash = hash_of(x.primed[n] ^ others);
    const F of_x = Metric::measure(x.middle[n] + point_offset<0>(hash) * jitter);
    nearest.take(Metric::join(measured(hash), of_x), hash);
  }
}

template <class Metric, Keep kKeep>
HWY_INLINE Nearest<Metric, kKeep> nearest2(const Split& sx, const Split& sy, W seed, float jitter) {
  const Axis<Metric> x(sx, kPrimeX, jitter);
  const Axis<Metric> y(sy, kPrimeY, jitter);
  const F spread = set(jitter);
  Nearest<Metric, kKeep> nearest;
  for (std::size_t m = 0; m < Axis<Metric>::kCells; ++m) {
    if (nearest.may_gain(y.least[m])) {
      visit_line(x, seed ^ y.primed[m], y.least[m], spread, nearest, [&](W hash) HWY_ATTR {
        return Metric::measure(y.middle[m] + point_offset<11>(hash) * spread);
      });
    }
  }
  return nearest;
}

template <class Metric, Keep kKeep>
HWY_INLINE Nearest<Metric, kKeep> nearest3(const Split& sx, const Split& sy, const Split& sz,
                                           W seed, float jitter) {
  const Axis<Metric> x(sx, kPrimeX, jitter);
  const Axis<Metric> y(sy, kPrimeY, jitter);
  const Axis<Metric> z(sz, kPrimeZ, jitter);
  const F spread = set(jitter);
  Nearest<Metric, kKeep> nearest;
  for (std::size_t k = 0; k < Axis<Metric>::kCells; ++k) {
    if (!nearest.may_gain(z.least[k])) {
      continue;
    }
    for (std::size_t m = 0; m < Axis<Metric>::kCells; ++m) {
      const F least = Metric::join(y.least[m], z.least[k]);
      if (nearest.may_gain(least)) {
        visit_line(x, seed ^ y.primed[m] ^ z.primed[k], least, spread, nearest,
                   [&](W hash) HWY_ATTR {
                     const F dy = y.middle[m] + point_offset<11>(hash) * spread;
                     const F dz = z.middle[k] + point_offset<22>(hash) * spread;
                     return Metric::join(Metric::measure(dy), Metric::measure(dz));
                   });
      }
    }
  }
  return nearest;
}

template <class Metric, Keep kKeep>
HWY_INLINE F told(const Nearest<Metric, kKeep>& nearest, CellReturn what) {
  if constexpr (kKeep == Keep::owner) {
    return signed_unit(hash_of(nearest.owner));
  } else if constexpr (kKeep == Keep::first) {
    return Metric::distance(nearest.first);
  } else {
    const F second = Metric::distance(nearest.second);
    return what == CellReturn::f2 ? second : second - Metric::distance(nearest.first);
  }
}

template <class Metric, Keep kKeep>
void keep_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  const float frequency = instruction.p[0];
  const float jitter = instruction.p[1];
  const auto what = static_cast<CellReturn>(instruction.p[2]);
  const W seed = set(instruction.seed);
  if (instruction.op == Op::cellular2) {
    return for_each_vector(a, b, frequency, n, out, [&](F px, F py) HWY_ATTR {
      const Split x = split(px);
      const Split y = split(py);
      const F nan = (x.rest - x.rest) + (y.rest - y.rest);  // 0, or NaN, which no comparison sees
      return told(nearest2<Metric, kKeep>(x, y, seed, jitter), what) + nan;
    });
  }
  for_each_vector(a, b, c, frequency, n, out, [&](F px, F py, F pz) HWY_ATTR {
    const Split x = split(px);
    const Split y = split(py);
    const Split z = split(pz);
    const F nan = ((x.rest - x.rest) + (y.rest - y.rest)) + (z.rest - z.rest);
    return told(nearest3<Metric, kKeep>(x, y, z, seed, jitter), what) + nan;
  });
}

template <class Metric>
void metric_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  switch (static_cast<CellReturn>(instruction.p[2])) {
    case CellReturn::value:
      return keep_row<Metric, Keep::owner>(instruction, a, b, c, n, out);
    case CellReturn::f1:
      return keep_row<Metric, Keep::first>(instruction, a, b, c, n, out);
    default:
      return keep_row<Metric, Keep::second>(instruction, a, b, c, n, out);
  }
}

}  // namespace

void cellular_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  switch (static_cast<CellMetric>(instruction.p[3])) {
    case CellMetric::euclidean:
      return metric_row<Euclidean>(instruction, a, b, c, n, out);
    case CellMetric::manhattan:
      return metric_row<Manhattan>(instruction, a, b, c, n, out);
    case CellMetric::chebyshev:
      return metric_row<Chebyshev>(instruction, a, b, c, n, out);
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
