// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see gather_kernels.hpp for what the function does.

#if defined(MC_EXTRACT_GATHER_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_GATHER_KERNELS_INL
#undef MC_EXTRACT_GATHER_KERNELS_INL
#else
#define MC_EXTRACT_GATHER_KERNELS_INL
#endif

#include <hwy/highway.h>

#include <bit>
#include <limits>
#include <type_traits>

#include "extract/gather_kernels.hpp"
#include "field/visit_type.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX2

using Floats = hn::CappedTag<float, kEdgesAtOnce>;
using FloatVector = hn::Vec<Floats>;
using Offsets = hn::Rebind<std::int32_t, Floats>;
using OffsetVector = hn::Vec<Offsets>;

/// Loads samples at byte offsets from a plane. Four bytes are read for each, which for narrower
/// types end with the plane at the latest.
template <class T, bool Swap>
class SampleLoader {
 public:
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

template <class T, bool Swap, bool Gradients>
class EdgeGatherer {
 public:
  EdgeGatherer(const PlaneSamples& planes, bool between, std::int32_t plane_bytes)
      : planes_(planes), between_(between), load_(plane_bytes) {}

  /// The samples around one vector of edges. Returns a bit for each that lies inside.
  std::uint64_t gather(const EdgePlaces& edges, std::size_t e, const EdgeSamples& out) const {
    const Offsets d;
    const Floats f;
    const auto size = hn::Set(d, std::int32_t{sizeof(T)});
    const auto row = hn::Set(d, static_cast<std::int32_t>(planes_.row_bytes));
    const auto axis = hn::LoadU(d, edges.axis + e);
    const auto along_i = hn::Eq(axis, hn::Zero(d));
    const auto along_j = hn::Eq(axis, hn::Set(d, 1));
    std::uint64_t inside = ~std::uint64_t{0};
    const auto i = clamped(0, hn::LoadU(d, edges.i + e), along_i, inside);
    const auto j = clamped(1, hn::LoadU(d, edges.j + e), along_j, inside);
    const auto lower = hn::Add(hn::Mul(hn::Sub(j, hn::Set(d, planes_.first[1])), row),
                               hn::Mul(hn::Sub(i, hn::Set(d, planes_.first[0])), size));
    const auto upper = hn::Add(
        lower, hn::Add(hn::IfThenElseZero(along_i, size), hn::IfThenElseZero(along_j, row)));
    const std::byte* const upper_plane = between_ ? planes_.after : planes_.here;
    hn::StoreU(load_(planes_.here, lower), f, out.a + e);
    hn::StoreU(load_(upper_plane, upper), f, out.b + e);
    if constexpr (Gradients) {
      const std::byte* const upper_before = between_ ? planes_.here : planes_.before;
      const std::byte* const upper_after = between_ ? planes_.after_next : planes_.after;
      gradient(planes_.before, planes_.here, planes_.after, lower, size, row, out.lower_gradient,
               e);
      gradient(upper_before, upper_plane, upper_after, upper, size, row, out.upper_gradient, e);
    }
    return inside;
  }

 private:
  static constexpr std::int32_t kRing = Gradients ? 1 : 0;

  /// Lower indices along one axis, held where all that is loaded lies in the planes; clears the
  /// bits in `inside` of those that had to be.
  OffsetVector clamped(std::size_t a, OffsetVector index, hn::Mask<Offsets> along,
                       std::uint64_t& inside) const {
    const Offsets d;
    const auto step = hn::IfThenElseZero(along, hn::Set(d, 1));
    const auto least = hn::Set(d, planes_.lo[a] + kRing);
    const auto most = hn::Sub(hn::Set(d, planes_.hi[a] - kRing), step);
    const auto held = hn::Min(hn::Max(index, least), most);
    std::uint64_t same = 0;
    hn::StoreMaskBits(d, hn::Eq(held, index), reinterpret_cast<std::uint8_t*>(&same));
    inside &= same;
    return held;
  }

  void gradient(const std::byte* before, const std::byte* here, const std::byte* after,
                OffsetVector at, OffsetVector size, OffsetVector row,
                const std::array<float*, 3>& out, std::size_t e) const {
    const Floats f;
    const auto half = hn::Set(f, 0.5F);
    const auto store = [&](std::size_t a, FloatVector next, FloatVector previous) {
      hn::StoreU(hn::Mul(hn::Sub(next, previous), half), f, out[a] + e);
    };
    store(0, load_(here, hn::Add(at, size)), load_(here, hn::Sub(at, size)));
    store(1, load_(here, hn::Add(at, row)), load_(here, hn::Sub(at, row)));
    store(2, load_(after, at), load_(before, at));
  }

  const PlaneSamples& planes_;
  bool between_;
  SampleLoader<T, Swap> load_;
};

template <class T, bool Swap, bool Gradients>
Gathered gather_typed(const PlaneSamples& planes, const EdgePlaces& edges, bool between,
                      std::int32_t plane_bytes, const EdgeSamples& out) {
  const EdgeGatherer<T, Swap, Gradients> gatherer(planes, between, plane_bytes);
  const std::size_t lanes = hn::Lanes(Floats());
  Gathered done;
  for (; done.n + lanes <= edges.n; done.n += lanes) {
    const std::uint64_t inside = gatherer.gather(edges, done.n, out);
    for (std::uint64_t bad = ~inside & ((std::uint64_t{1} << lanes) - 1); bad != 0;
         bad &= bad - 1) {
      out.failed[done.n_failed++] =
          static_cast<std::uint32_t>(done.n + static_cast<std::size_t>(std::countr_zero(bad)));
    }
  }
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

}  // namespace HWY_NAMESPACE
}  // namespace mc::extraction
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
