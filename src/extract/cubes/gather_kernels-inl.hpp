// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see gather_kernels.hpp for what the function does.

#if defined(MC_EXTRACT_CUBES_GATHER_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_CUBES_GATHER_KERNELS_INL
#undef MC_EXTRACT_CUBES_GATHER_KERNELS_INL
#else
#define MC_EXTRACT_CUBES_GATHER_KERNELS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>

#include "extract/cubes/gather_kernels.hpp"
#include "field/visit_type.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX2

/// Vectors of edges are whole ones, but for the last few edges: a gather costs what its lanes cost.
using WholeVector = hn::CappedTag<float, kEdgesAtOnce>;
using HalfVector = hn::Half<WholeVector>;

/// Loads samples at byte offsets from a plane. Four bytes are read for each, which for narrower
/// types end with the plane at the latest.
template <class T, bool Swap, class Floats>
class SampleLoader {
 public:
  using Offsets = hn::Rebind<std::int32_t, Floats>;
  using FloatVector = hn::Vec<Floats>;
  using OffsetVector = hn::Vec<Offsets>;

  explicit SampleLoader(std::int32_t plane_bytes) : last_(plane_bytes - 4) {}

  FloatVector operator()(const std::byte* plane, OffsetVector offset) const {
    const Offsets d;
    const auto* base = reinterpret_cast<const std::int32_t*>(plane);
    if constexpr (std::is_same_v<T, float>) {
      const auto bits = hn::GatherOffset(d, base, offset);
      return hn::BitCast(Floats(), Swap ? swapped4(bits) : bits);
    } else {
      const auto from = hn::Min(offset, hn::Set(d, last_));
      const auto skip = hn::ShiftLeft<3>(hn::Sub(offset, from));
      return hn::ConvertTo(Floats(), number(hn::Shr(hn::GatherOffset(d, base, from), skip)));
    }
  }

 private:
  /// The sample in the low bytes of each lane; the others hold anything.
  static OffsetVector number(OffsetVector bits) {
    constexpr int kUnused = 32 - 8 * static_cast<int>(sizeof(T));
    if constexpr (Swap && sizeof(T) == 2) bits = hn::ShiftRight<16>(swapped4(bits));
    const auto high = hn::ShiftLeft<kUnused>(bits);
    if constexpr (std::is_signed_v<T>) {
      return hn::ShiftRight<kUnused>(high);
    } else {
      const hn::RebindToUnsigned<Offsets> u;
      return hn::BitCast(Offsets(), hn::ShiftRight<kUnused>(hn::BitCast(u, high)));
    }
  }
  static OffsetVector swapped4(OffsetVector v) {
    const hn::Repartition<std::uint8_t, Offsets> bytes;
    alignas(16) static constexpr std::uint8_t kOrder[16] = {3,  2,  1, 0, 7,  6,  5,  4,
                                                            11, 10, 9, 8, 15, 14, 13, 12};
    return hn::BitCast(Offsets(),
                       hn::TableLookupBytes(hn::BitCast(bytes, v), hn::LoadDup128(bytes, kOrder)));
  }

  std::int32_t last_;
};

template <class T, bool Swap, bool Gradients, class Floats>
class EdgeGatherer {
 public:
  using Loader = SampleLoader<T, Swap, Floats>;
  using Offsets = typename Loader::Offsets;
  using FloatVector = typename Loader::FloatVector;
  using OffsetVector = typename Loader::OffsetVector;
  static constexpr std::size_t kLanes = hn::MaxLanes(Floats());

  EdgeGatherer(const PlaneSamples& planes, bool between, std::int32_t plane_bytes)
      : planes_(planes), between_(between), load_(plane_bytes) {}

  /// The samples around one vector of edges. Returns a bit for each that lies inside.
  std::uint64_t gather(const EdgePlaces& edges, std::size_t e, const EdgeSamples& out) const {
    const Offsets d;
    const auto axis = hn::LoadU(d, edges.axis + e);
    const Ends ends{hn::LoadU(d, edges.i + e), hn::LoadU(d, edges.j + e),
                    hn::IfThenElseZero(hn::Eq(axis, hn::Zero(d)), hn::Set(d, 1)),
                    hn::IfThenElseZero(hn::Eq(axis, hn::Set(d, 1)), hn::Set(d, 1))};
    if constexpr (Gradients) {
      if (gather_held<true>(ends, e, out) == kAll) return kAll;
    }
    return gather_held<false>(ends, e, out);
  }

 private:
  static constexpr std::uint64_t kAll = (std::uint64_t{1} << kLanes) - 1;  ///< a bit for each lane

  struct Ends {
    OffsetVector i, j;    ///< of the lower end
    OffsetVector di, dj;  ///< to the upper end
  };

  /// Bytes from one sample to the next of its row, and from row to row; none where there is no
  /// next.
  struct Steps {
    OffsetVector to_next_i, to_last_i, to_next_j, to_last_j;
    FloatVector scale_i, scale_j;
  };

  /// All samples lie at least one from the border if `Inner`: where they do not, they are held
  /// there and nothing else is done.
  template <bool Inner>
  std::uint64_t gather_held(const Ends& ends, std::size_t e, const EdgeSamples& out) const {
    const Offsets d;
    const Floats f;
    std::uint64_t inside = kAll;
    const auto i = held<Inner>(0, ends.i, ends.di, inside);
    const auto j = held<Inner>(1, ends.j, ends.dj, inside);
    if (Inner && inside != kAll) return inside;
    const auto size = hn::Set(d, std::int32_t{sizeof(T)});
    const auto row = hn::Set(d, static_cast<std::int32_t>(planes_.row_bytes));
    const auto lower = hn::Add(hn::Mul(hn::Sub(j, hn::Set(d, planes_.first[1])), row),
                               hn::Mul(hn::Sub(i, hn::Set(d, planes_.first[0])), size));
    const auto upper = hn::Add(lower, hn::Add(hn::Mul(ends.di, size), hn::Mul(ends.dj, row)));
    const std::byte* const upper_plane = between_ ? planes_.after : planes_.here;
    hn::StoreU(load_(planes_.here, lower), f, out.a + e);
    hn::StoreU(load_(upper_plane, upper), f, out.b + e);
    if constexpr (Gradients) {
      const std::byte* const upper_before = between_ ? planes_.here : planes_.before;
      const std::byte* const upper_after = between_ ? planes_.after_next : planes_.after;
      gradient(planes_.before, planes_.here, planes_.after, lower, steps<Inner>(i, j),
               planes_.lower_scale, out.lower_gradient, e);
      gradient(upper_before, upper_plane, upper_after, upper,
               steps<Inner>(hn::Add(i, ends.di), hn::Add(j, ends.dj)), planes_.upper_scale,
               out.upper_gradient, e);
    }
    return inside;
  }

  /// Lower indices along one axis, held where all that is loaded lies in the planes; clears the
  /// bits in `inside` of those that had to be.
  template <bool Inner>
  OffsetVector held(std::size_t a, OffsetVector index, OffsetVector step,
                    std::uint64_t& inside) const {
    constexpr std::int32_t kRing = Inner ? 1 : 0;
    const Offsets d;
    const auto least = hn::Set(d, planes_.lo[a] + kRing);
    const auto most = hn::Sub(hn::Set(d, planes_.hi[a] - kRing), step);
    const auto within = hn::Min(hn::Max(index, least), most);
    std::uint64_t same = 0;
    hn::StoreMaskBits(d, hn::Eq(within, index), reinterpret_cast<std::uint8_t*>(&same));
    inside &= same;
    return within;
  }

  template <bool Inner>
  Steps steps(OffsetVector i, OffsetVector j) const {
    const Offsets d;
    const Floats f;
    const auto size = hn::Set(d, std::int32_t{sizeof(T)});
    const auto row = hn::Set(d, static_cast<std::int32_t>(planes_.row_bytes));
    const auto half = hn::Set(f, 0.5F);
    if constexpr (Inner) {
      return {size, size, row, row, half, half};
    } else {
      const auto one = hn::Set(f, 1.0F);
      const auto after_i = hn::Gt(i, hn::Set(d, planes_.lo[0]));
      const auto after_j = hn::Gt(j, hn::Set(d, planes_.lo[1]));
      const auto before_i = hn::Lt(i, hn::Set(d, planes_.hi[0]));
      const auto before_j = hn::Lt(j, hn::Set(d, planes_.hi[1]));
      const auto scale = [&](hn::Mask<Offsets> both) {
        return hn::IfThenElse(hn::RebindMask(f, both), half, one);
      };
      return {hn::IfThenElseZero(before_i, size), hn::IfThenElseZero(after_i, size),
              hn::IfThenElseZero(before_j, row),  hn::IfThenElseZero(after_j, row),
              scale(hn::And(before_i, after_i)),  scale(hn::And(before_j, after_j))};
    }
  }

  void gradient(const std::byte* before, const std::byte* here, const std::byte* after,
                OffsetVector at, const Steps& to, float scale_k, const std::array<float*, 3>& out,
                std::size_t e) const {
    const Floats f;
    const auto store = [&](std::size_t a, FloatVector next, FloatVector previous,
                           FloatVector scale) {
      hn::StoreU(hn::Mul(hn::Sub(next, previous), scale), f, out[a] + e);
    };
    store(0, load_(here, hn::Add(at, to.to_next_i)), load_(here, hn::Sub(at, to.to_last_i)),
          to.scale_i);
    store(1, load_(here, hn::Add(at, to.to_next_j)), load_(here, hn::Sub(at, to.to_last_j)),
          to.scale_j);
    store(2, load_(after, at), load_(before, at), hn::Set(f, scale_k));
  }

  const PlaneSamples& planes_;
  bool between_;
  Loader load_;
};

/// Edges from e on, at most one vector of them. Returns the edge after the last.
template <class Gatherer>
HWY_INLINE std::size_t gather_next(const Gatherer& gatherer, const EdgePlaces& edges, std::size_t e,
                                   const EdgeSamples& out, std::size_t& n_failed) {
  const std::size_t n = std::min(Gatherer::kLanes, edges.n - e);
  const std::uint64_t valid = (std::uint64_t{1} << n) - 1;
  for (std::uint64_t bad = ~gatherer.gather(edges, e, out) & valid; bad != 0; bad &= bad - 1) {
    out.failed[n_failed++] =
        static_cast<std::uint32_t>(e + static_cast<std::size_t>(std::countr_zero(bad)));
  }
  return e + n;
}

template <class T, bool Swap, bool Gradients>
Gathered gather_typed(const PlaneSamples& planes, const EdgePlaces& edges, bool between,
                      std::int32_t plane_bytes, const EdgeSamples& out) {
  using Whole = EdgeGatherer<T, Swap, Gradients, WholeVector>;
  using Half = EdgeGatherer<T, Swap, Gradients, HalfVector>;
  const Whole whole(planes, between, plane_bytes);
  const Half half(planes, between, plane_bytes);
  Gathered done{edges.n, 0};
  std::size_t e = 0;
  while (edges.n - e > Half::kLanes) e = gather_next(whole, edges, e, out, done.n_failed);
  if (e < edges.n) gather_next(half, edges, e, out, done.n_failed);
  return done;
}

/// Bytes of a plane up to its last sample, or none if it cannot be gathered from.
inline std::int32_t bytes_to_gather(const PlaneSamples& planes, bool gradients) {
  const std::int32_t ring = gradients ? 1 : 0;
  for (std::size_t a = 0; a < 2; ++a) {
    if (planes.lo[a] < planes.first[a] || planes.hi[a] - planes.lo[a] < 1 + 2 * ring) return 0;
  }
  const std::uint64_t bytes =
      static_cast<std::uint64_t>(planes.hi[1] - planes.first[1]) * planes.row_bytes +
      (static_cast<std::uint64_t>(planes.hi[0] - planes.first[0]) + 1) * sample_size(planes.type);
  return bytes < 4 || bytes > std::numeric_limits<std::int32_t>::max()
             ? 0
             : static_cast<std::int32_t>(bytes);
}

Gathered gather_edges(const PlaneSamples& planes, const EdgePlaces& edges, bool between,
                      bool gradients, const EdgeSamples& out) {
  const std::int32_t bytes = bytes_to_gather(planes, gradients);
  if (bytes == 0) return {};
  return field::visit_type(planes.type, [&]<class T>(field::TypeTag<T> /*tag*/) -> Gathered {
    if constexpr (std::is_same_v<T, float> || (std::is_integral_v<T> && sizeof(T) <= 2)) {
      const auto with = [&]<bool Swap>(std::bool_constant<Swap> /*swap*/) {
        return gradients ? gather_typed<T, Swap, true>(planes, edges, between, bytes, out)
                         : gather_typed<T, Swap, false>(planes, edges, between, bytes, out);
      };
      return planes.swap ? with(std::true_type{}) : with(std::false_type{});
    } else {
      return {};
    }
  });
}

#else

Gathered gather_edges(const PlaneSamples& /*planes*/, const EdgePlaces& /*edges*/, bool /*between*/,
                      bool /*gradients*/, const EdgeSamples& /*out*/) {
  return {};
}

#endif

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
