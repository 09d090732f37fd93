// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see float_text.hpp for what the function does.

#if defined(MC_MESH_FLOAT_TEXT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_MESH_FLOAT_TEXT_INL
#undef MC_MESH_FLOAT_TEXT_INL
#else
#define MC_MESH_FLOAT_TEXT_INL
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "mesh/float_text.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::mesh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

/// Leaves all floats to the caller.
inline void print_floats(const float* /*x*/, std::size_t n, FloatText* to) {
  for (std::size_t i = 0; i < n; ++i) to[i].n = 0;
}

#else

using Lanes = hn::CappedTag<std::uint64_t, 8>;
using Vec = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;

inline Vec lanes_of(std::uint64_t value) { return hn::Set(Lanes(), value); }

/// The product of numbers below 2^32.
inline Vec product(Vec a, Vec b) {
  const hn::Repartition<std::uint32_t, Lanes> halves;
  return hn::MulEven(hn::BitCast(halves, a), hn::BitCast(halves, b));
}
inline Vec product(Vec a, std::uint64_t b) { return product(a, lanes_of(b)); }

/// Products in each 32 or 16 bits of a lane.
template <class Part>
Vec product_of_parts(Vec a, Part b) {
  const hn::Repartition<Part, Lanes> parts;
  return hn::BitCast(Lanes(), hn::Mul(hn::BitCast(parts, a), hn::Set(parts, b)));
}

inline Vec one_if(Mask mask) { return hn::IfThenElseZero(mask, lanes_of(1)); }

/// digits * 10^-n_behind
struct Decimals {
  Vec digits, n_behind;
};

/// The decimals with the fewest digits, zeros at their ends aside, that read back as the floats of
/// these bits, and of those the nearest. All floats are in [10^-3, 10^5).
inline Decimals shortest_decimals(Vec bits) {
  alignas(64) static constexpr std::uint64_t kPowersOf10[16] = {
      1,       10,       100,       1000,       10000,       100000,
      1000000, 10000000, 100000000, 1000000000, 10000000000, 100000000000};
  const Lanes d;
  const Vec one = lanes_of(1);
  const Vec fraction = hn::And(bits, lanes_of(0x7FFFFF));
  const Vec c = hn::Or(fraction, lanes_of(0x800000));  // the float is c 2^-s, s in [7, 33]
  const Vec s = hn::Sub(lanes_of(150), hn::And(hn::ShiftRight<23>(bits), lanes_of(0xFF)));
  // 10^-k is the largest power not above the interval that rounds to the float, which is narrower
  // below a power of two: k = ceil(s log10(2)), or that of 4/3 2^s.
  const Mask is_power = hn::Eq(fraction, hn::Zero(d));
  const Vec log = hn::Add(product(s, 1262611), hn::IfThenElseZero(is_power, lanes_of(524031)));
  const Vec k = hn::ShiftRight<22>(hn::Add(log, lanes_of((1U << 22U) - 1)));
  const Vec power = hn::GatherIndex(d, kPowersOf10, hn::BitCast(hn::RebindToSigned<Lanes>(), k));
  // The float is value / unit in 10^-k. What rounds to it lies so far from it at most; ties go to
  // even: an odd float does not own the ends.
  const Vec value =
      hn::Add(product(c, power), hn::ShiftLeft<32>(product(c, hn::ShiftRight<32>(power))));
  const Vec unit = one << s;
  const Vec open = hn::And(c, one);
  const Vec most_up = hn::Sub(hn::ShiftRight<1>(power), open);
  const Vec most_down =
      hn::Sub(hn::IfThenElse(is_power, hn::ShiftRight<2>(power), hn::ShiftRight<1>(power)), open);
  const Vec units = value >> s;
  const Vec down = hn::And(value, hn::Sub(unit, one));
  const Vec last_digit =
      hn::Sub(units, product(hn::ShiftRight<35>(product(units, 0xCCCCCCCD)), 10));
  const Vec down_to_tens = hn::Add(last_digit << s, down);
  // Lanes are below 2^63: their difference has the sign of the comparison.
  const auto is_less = [](Vec a, Vec b) { return hn::ShiftRight<63>(hn::Sub(a, b)); };
  const Vec tens_out = is_less(most_down, down_to_tens);
  const Vec next_tens_out =
      is_less(most_up, hn::Sub(hn::Add(hn::ShiftLeft<3>(unit), hn::Add(unit, unit)), down_to_tens));
  const Vec unit_out = is_less(most_down, down);
  const Vec next_unit_out = is_less(most_up, hn::Sub(unit, down));
  const Vec nearer_next = is_less(unit, hn::Add(hn::Add(down, down), hn::And(units, one)));
  const Vec only_one_in = hn::Xor(unit_out, next_unit_out);
  const Vec up = hn::Or(hn::And(only_one_in, unit_out), hn::AndNot(only_one_in, nearer_next));
  const Vec tens = hn::Sub(units, last_digit);
  const Vec ten = hn::Add(tens, product(tens_out, 10));
  const Mask takes_ten = hn::Ne(tens_out, next_tens_out);
  return {hn::IfThenElse(takes_ten, ten, hn::Add(units, up)), k};
}

/// The eight digits of numbers below 10^8 as numbers, zeros in front; the first is the lowest byte.
inline Vec eight_digits(Vec n) {
  // Two parts of four digits become four of two, and those eight of one.
  const Vec high = hn::ShiftRight<45>(product(n, 0xD1B71759));
  const Vec low = hn::Sub(n, product(high, 10000));
  const Vec fours = hn::Or(high, hn::ShiftLeft<32>(low));
  const Vec hundreds = hn::And(hn::ShiftRight<20>(product_of_parts<std::uint32_t>(fours, 10486)),
                               lanes_of(0x7F0000007F));
  const Vec twos = hn::Or(
      hundreds, hn::ShiftLeft<16>(hn::Sub(fours, product_of_parts<std::uint32_t>(hundreds, 100))));
  const Vec tens = hn::And(hn::ShiftRight<10>(product_of_parts<std::uint16_t>(twos, 103)),
                           lanes_of(0x000F000F000F000F));
  return hn::Or(tens, hn::ShiftLeft<8>(hn::Sub(twos, product_of_parts<std::uint16_t>(tens, 10))));
}

/// How many of eight digits there are up to the last that is not zero.
inline Vec count_to_last(Vec digits) {
  Vec seen = digits;  // a byte is not zero if it or one behind it is not
  seen = hn::Or(seen, hn::ShiftRight<8>(seen));
  seen = hn::Or(seen, hn::ShiftRight<16>(seen));
  seen = hn::Or(seen, hn::ShiftRight<32>(seen));
  const Vec flags = hn::And(hn::ShiftRight<7>(hn::Add(seen, lanes_of(0x7F7F7F7F7F7F7F7F))),
                            lanes_of(0x0101010101010101));
  return hn::SumsOf8(hn::BitCast(hn::Repartition<std::uint8_t, Lanes>(), flags));
}

/// Text of up to 15 bytes, the first the lowest, and its length.
struct Texts {
  Vec low, high, n;
};

/// The nine digits of a decimal with a point between them, after as many zeros as it takes.
inline Texts with_point(const Decimals& decimals) {
  const Vec one = lanes_of(1);
  // Digits are at least 2^23: seven to nine.
  const Mask eight = hn::Lt(decimals.digits, lanes_of(100000000));
  const Mask seven = hn::Lt(decimals.digits, lanes_of(10000000));
  const Vec nine_digits =
      product(decimals.digits,
              hn::IfThenElse(seven, lanes_of(100), hn::IfThenElse(eight, lanes_of(10), one)));
  const Vec n_added = hn::Add(one_if(eight), one_if(seven));
  const Vec n_behind = hn::Add(decimals.n_behind, n_added);  // of nine digits
  const Vec first = hn::ShiftRight<57>(product(nine_digits, 0x55E63B89));
  const Vec others = eight_digits(hn::Sub(nine_digits, product(first, 100000000)));
  // So many zeros in front that there is a digit before the point.
  const Vec n_zeros =
      hn::IfThenElseZero(hn::Gt(n_behind, lanes_of(8)), hn::Sub(n_behind, lanes_of(8)));
  const Vec n_whole = hn::Sub(hn::Add(lanes_of(9), n_zeros), n_behind);
  const Vec low = hn::Or(first, hn::ShiftLeft<8>(others));
  const Vec high = hn::ShiftRight<56>(others);
  const Vec shift = hn::ShiftLeft<3>(n_zeros);
  const Vec ascii = lanes_of(0x3030303030303030);
  const Vec all_low = hn::Or(low << shift, ascii);
  const Vec all_high =
      hn::Or(hn::Or(high << shift, hn::ShiftRight<8>(low) >> hn::Sub(lanes_of(56), shift)), ascii);
  const Vec point = hn::ShiftLeft<3>(n_whole);
  const Vec whole = hn::Sub(one << point, one);
  const Vec text_low = hn::Or(hn::Or(hn::And(all_low, whole), lanes_of('.') << point),
                              hn::ShiftLeft<8>(hn::AndNot(whole, all_low)));
  const Vec text_high = hn::Or(hn::ShiftLeft<8>(all_high), hn::ShiftRight<56>(all_low));
  const Vec n_digits = hn::Add(hn::Add(count_to_last(others), one), n_zeros);
  const Vec n = hn::IfThenElse(hn::Gt(n_digits, n_whole), hn::Add(n_digits, one), n_whole);
  return {text_low, text_high, n};
}

inline void print_vector(const float* x, FloatText* to) {
  const Lanes d;
  const hn::Rebind<std::uint32_t, Lanes> singles;
  const hn::Rebind<float, Lanes> floats;
  const Vec bits = hn::PromoteTo(d, hn::BitCast(singles, hn::LoadU(floats, x)));
  const Vec size = hn::And(bits, lanes_of(0x7FFFFFFF));
  constexpr std::uint64_t kLeast = 0x3A83126F;  // 1e-3F
  constexpr std::uint64_t kEnd = 0x47C35000;    // 1e5F
  const Mask in_range = hn::And(hn::Gt(size, lanes_of(kLeast - 1)), hn::Lt(size, lanes_of(kEnd)));
  const Mask is_zero = hn::Eq(size, hn::Zero(d));
  Texts text = with_point(shortest_decimals(hn::IfThenElse(in_range, size, lanes_of(kLeast))));
  text.low = hn::IfThenElse(is_zero, lanes_of('0'), text.low);
  text.n = hn::IfThenElse(is_zero, lanes_of(1), text.n);
  const Mask negative = hn::Ne(size, bits);
  text.high = hn::IfThenElse(
      negative, hn::Or(hn::ShiftLeft<8>(text.high), hn::ShiftRight<56>(text.low)), text.high);
  text.low = hn::IfThenElse(negative, hn::Or(hn::ShiftLeft<8>(text.low), lanes_of('-')), text.low);
  text.n = hn::IfThenElseZero(hn::Or(in_range, is_zero), hn::Add(text.n, one_if(negative)));
  text.high = hn::Or(hn::And(text.high, lanes_of(0x00FFFFFFFFFFFFFF)), hn::ShiftLeft<56>(text.n));
  alignas(64) std::uint64_t low[hn::MaxLanes(Lanes())];
  alignas(64) std::uint64_t high[hn::MaxLanes(Lanes())];
  hn::Store(text.low, d, low);
  hn::Store(text.high, d, high);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    const std::uint64_t both[2] = {low[i], high[i]};
    static_assert(sizeof both == sizeof(FloatText));
    hwy::CopyBytes<sizeof both>(both, &to[i]);
  }
}

inline void print_floats(const float* x, std::size_t n, FloatText* to) {
  const std::size_t n_lanes = hn::Lanes(Lanes());
  std::size_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) print_vector(x + i, to + i);
  if (i == n) return;
  float last[hn::MaxLanes(Lanes())] = {};
  FloatText text[hn::MaxLanes(Lanes())];
  std::copy_n(x + i, n - i, last);
  print_vector(last, text);
  std::copy_n(text, n - i, to + i);
}

#endif

}  // namespace mc::mesh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
