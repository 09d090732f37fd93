// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: what the noises share. Vectors of samples, arithmetic with
// the meaning of float_math.hpp, cells and their hashes.

#if defined(MC_GRAPH_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_LANES_INL
#undef MC_GRAPH_LANES_INL
#else
#define MC_GRAPH_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "graph/hash.hpp"
#include "graph/rows.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Integers = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using W = hn::Vec<Words>;
using I = hn::Vec<Integers>;

static_assert(HWY_MAX_BYTES / sizeof(float) <= kRowStep, "a row has room for its last vector");

HWY_INLINE F set(float v) { return hn::Set(Floats(), v); }
HWY_INLINE W set(std::uint32_t v) { return hn::Set(Words(), v); }

HWY_INLINE F as_floats(W v) { return hn::BitCast(Floats(), v); }
HWY_INLINE W as_words(F v) { return hn::BitCast(Words(), v); }
HWY_INLINE W as_words(I v) { return hn::BitCast(Words(), v); }

// x86's minps and maxps are these very selects; what other machines have differs for NaN.
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
HWY_INLINE F least(F a, F b) { return hn::Min(b, a); }
HWY_INLINE F greatest(F a, F b) { return hn::Max(b, a); }
#else
HWY_INLINE F least(F a, F b) { return hn::IfThenElse(hn::Lt(b, a), b, a); }
HWY_INLINE F greatest(F a, F b) { return hn::IfThenElse(hn::Gt(b, a), b, a); }
#endif

HWY_INLINE F clamped(F v, float lo, float hi) { return least(greatest(v, set(lo)), set(hi)); }

/// A coordinate split into its cell and the rest. Beyond 2^30 cells it is held there; for NaN the
/// rest is NaN and the cell means nothing.
struct Split {
  W cell;
  F rest;
};

/// Floor of |v| <= 2^30. Any number for NaN, which only an instruction may convert.
HWY_INLINE I cell_of(F v) {
#if HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SCALAR
  v = hn::IfThenElseZero(hn::Eq(v, v), v);
#endif
  return hn::ConvertTo(Integers(), hn::Floor(v));
}

/// The floor of a number, which names a cell. As a float it is never -0.
struct Cell {
  W number;
  F floor;
};

/// Of |v| <= 2^30; of |v| <= 2^22 where kNear, which takes fewer instructions: adding 1.5 * 2^23
/// leaves the floor in the lowest bits, and nothing can overflow.
template <bool kNear>
HWY_INLINE Cell cell_at(F v) {
  if constexpr (kNear) {
    const F unit = set(0x1.8p23F);
    const F shifted = hn::Floor(v) + unit;
    return {as_words(shifted) - as_words(unit), shifted - unit};
  } else {
    const I cell = cell_of(v);
    return {as_words(cell), hn::ConvertTo(Floats(), cell)};
  }
}

/// Whether these coordinates, and sums of them, are such as kNear wants. NaN is not.
HWY_INLINE bool are_near(F x, F y, F z) {
  const F sum = (hn::Abs(x) + hn::Abs(y)) + hn::Abs(z);
  return hn::AllTrue(Floats(), hn::Lt(sum, set(0x1p20F)));
}

template <bool kNear = false>
HWY_INLINE Split split(F v) {
  const F held = kNear ? v : clamped(v, -0x1p30F, 0x1p30F);
  const Cell cell = cell_at<kNear>(held);
  return {cell.number, held - cell.floor};
}

HWY_INLINE F fade(F t) { return (((set(6.0F) * t - set(15.0F)) * t) + set(10.0F)) * ((t * t) * t); }

HWY_INLINE F lerp(F t, F a, F b) { return a + t * (b - a); }

/// hash_point() of the seed and the primed coordinates, combined by xor in any order.
HWY_INLINE W hash_of(W mixed) {
  const W h = mixed * set(0x2C1B3C6DU);
  return (h ^ hn::ShiftRight<15>(h)) * set(0x297A2D39U);
}

/// hash_of() of several, which take each step together: one by one, the processor would see few of
/// them at a time, and wait for their products.
template <std::size_t kCount>
HWY_INLINE void hash_all(W (&h)[kCount]) {
  for (W& v : h) v = v * set(0x2C1B3C6DU);
  for (W& v : h) v = v ^ hn::ShiftRight<15>(v);
  for (W& v : h) v = v * set(0x297A2D39U);
}

/// The hash as a number in [-1, 1), of its 24 best bits.
HWY_INLINE F signed_unit(W hash) {
  const I bits = hn::ShiftRight<8>(hn::BitCast(Integers(), hash));
  return hn::ConvertTo(Floats(), bits) * set(0x1p-23F);
}

/// A number within [-1/2, 1/2] from the bits of a hash below the first kSkip.
template <int kSkip>
HWY_INLINE F point_offset(W hash) {
  const I bits = hn::BitCast(Integers(), hn::ShiftLeft<kSkip>(hash));
  return hn::ConvertTo(Floats(), bits) * set(0x1p-32F);
}

/// v, or -v where the bit (its number) of h is set.
template <int kBit>
HWY_INLINE F flipped(F v, W h) {
  return as_floats(as_words(v) ^ (hn::ShiftLeft<31 - kBit>(h) & set(0x80000000U)));
}

/// Where the highest bit of h is set, `yes`; else `no`. As integers: a float may be NaN.
HWY_INLINE F chosen(W h, F yes, F no) {
  const Integers d;
  I sign = hn::BitCast(d, h);
#if HWY_TARGET == HWY_SSSE3  // Highway 1.0 forgets that its selects look at all bits there
  sign = hn::BroadcastSignBit(sign);
#endif
  return hn::BitCast(Floats(),
                     hn::IfNegativeThenElse(sign, hn::BitCast(d, yes), hn::BitCast(d, no)));
}

// The cosine and sine of 22.5 degrees.
constexpr float kMainGradient2 = 0.923879533F;
constexpr float kSideGradient2 = 0.382683432F;

/// Eight unit gradients at odd multiples of 22.5 degrees, none along an axis.
HWY_INLINE F gradient2(W hash, F x, F y) {
  const F u = chosen(hash, y, x);
  const F v = chosen(hash, x, y);
  return flipped<29>(u, hash) * set(kMainGradient2) + flipped<30>(v, hash) * set(kSideGradient2);
}

/// Whether z is the second coordinate that gradient3 takes: in the highest bit.
HWY_INLINE W takes_z(W hash) {
  return (hash ^ hn::ShiftLeft<1>(hash)) | (hash & hn::ShiftLeft<3>(hash));
}

/// The twelve edge directions of a cube, four of them twice. With h, the hash's four highest bits:
/// u is x below 8, else y; v is y below 4, x for 12 and 14, else z.
HWY_INLINE F gradient3(W hash, F x, F y, F z) {
  const F u = chosen(hash, y, x);
  const F v = chosen(takes_z(hash), z, chosen(hash, x, y));
  return flipped<28>(u, hash) + flipped<29>(v, hash);
}

/// Calls out = f(coordinates times frequency) for the vectors of a row.
template <class Noise>
HWY_INLINE void for_each_vector(Row x, Row y, float frequency, std::size_t n, OutRow out,
                                const Noise& noise) {
  const Floats d;
  const F f = set(frequency);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::StoreU(noise(hn::LoadU(d, x + i) * f, hn::LoadU(d, y + i) * f), d, out + i);
  }
}

template <class Noise>
HWY_INLINE void for_each_vector(Row x, Row y, Row z, float frequency, std::size_t n, OutRow out,
                                const Noise& noise) {
  const Floats d;
  const F f = set(frequency);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::StoreU(noise(hn::LoadU(d, x + i) * f, hn::LoadU(d, y + i) * f, hn::LoadU(d, z + i) * f), d,
               out + i);
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
