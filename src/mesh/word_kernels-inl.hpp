// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see word_kernels.hpp for what the function does.

#if defined(MC_MESH_WORD_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_MESH_WORD_KERNELS_INL
#undef MC_MESH_WORD_KERNELS_INL
#else
#define MC_MESH_WORD_KERNELS_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>

#include "mesh/word_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::mesh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline void move_cached(const std::uint32_t* from, std::size_t n, std::uint32_t add,
                        std::uint32_t* to) {
  const hn::ScalableTag<std::uint32_t> d;
  const auto offset = hn::Set(d, add);
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= n; i += hn::Lanes(d)) {
    hn::StoreU(hn::Add(hn::LoadU(d, from + i), offset), d, to + i);
  }
  const hn::CappedTag<std::uint32_t, 1> one;
  for (; i < n; ++i) {
    hn::StoreU(hn::Add(hn::LoadU(one, from + i), hn::Set(one, add)), one, to + i);
  }
}

/// A cache line at a time, since a line that is streamed in parts may go to memory in parts.
inline void move_streamed(const std::uint32_t* from, std::size_t n, std::uint32_t add,
                          std::uint32_t* to) {
  constexpr std::size_t kLine = 64 / sizeof(std::uint32_t);
  const hn::ScalableTag<std::uint32_t> d;
  const auto offset = hn::Set(d, add);
  const std::size_t past = reinterpret_cast<std::uintptr_t>(to) / sizeof(std::uint32_t) % kLine;
  std::size_t i = std::min(n, (kLine - past) % kLine);
  move_cached(from, i, add, to);
  for (; i + kLine <= n; i += kLine) {
    for (std::size_t v = 0; v < kLine; v += hn::Lanes(d)) {
      hn::Stream(hn::Add(hn::LoadU(d, from + i + v), offset), d, to + i + v);
    }
  }
  move_cached(from + i, n - i, add, to + i);
  hwy::FlushStream();
}

inline void move_words(const void* from, std::size_t n, std::uint32_t add, void* to,
                       Stores stores) {
  const auto move = stores == Stores::streamed ? move_streamed : move_cached;
  move(static_cast<const std::uint32_t*>(from), n, add, static_cast<std::uint32_t*>(to));
}

}  // namespace mc::mesh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
