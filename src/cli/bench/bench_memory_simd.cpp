// SPDX-License-Identifier: MIT
#include "cli/bench/bench_memory.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "cli/bench/bench_memory_simd.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace mc::cli::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::ScalableTag<std::uint64_t>;

constexpr std::size_t kLine = 64;
constexpr std::size_t kPage = 4096;

std::uint64_t any_lane(hn::Vec<Words> v) { return hn::GetLane(hn::SumOfLanes(Words(), v)); }

/// Ors the line at `line` to `sum`.
HWY_INLINE hn::Vec<Words> or_line(const std::byte* line, hn::Vec<Words> sum) {
  const Words d;
  const auto* words = reinterpret_cast<const std::uint64_t*>(line);
  for (std::size_t w = 0; w < kLine / sizeof(std::uint64_t); w += hn::Lanes(d)) {
    sum = hn::Or(sum, hn::Load(d, words + w));
  }
  return sum;
}

std::uint64_t read_one_stream(const std::byte* data, std::size_t n_bytes) {
  auto sum = hn::Zero(Words());
  for (std::size_t at = 0; at < n_bytes; at += kLine) sum = or_line(data + at, sum);
  return any_lane(sum);
}

std::uint64_t read_eight_streams(const std::byte* data, std::size_t n_bytes) {
  auto sum = hn::Zero(Words());
  for (std::size_t block = 0; block < n_bytes; block += kStreamBlock) {
    for (std::size_t at = 0; at < kPage; at += kLine) {
      for (std::size_t page = 0; page < kStreamBlock; page += kPage) {
        sum = or_line(data + block + page + at, sum);
      }
    }
  }
  return any_lane(sum);
}

void write_past_cache(std::byte* data, std::size_t n_bytes) {
  const Words d;
  auto* words = reinterpret_cast<std::uint64_t*>(data);
  for (std::size_t w = 0; w < n_bytes / sizeof(std::uint64_t); w += hn::Lanes(d)) {
    hn::Stream(hn::Set(d, w), d, words + w);
  }
  hwy::FlushStream();
}

}  // namespace mc::cli::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mc::cli {

namespace {
HWY_EXPORT(read_one_stream);
HWY_EXPORT(read_eight_streams);
HWY_EXPORT(write_past_cache);
}  // namespace

std::uint64_t read_one_stream(const std::byte* data, std::size_t n_bytes) {
  return HWY_DYNAMIC_DISPATCH(read_one_stream)(data, n_bytes);
}

std::uint64_t read_eight_streams(const std::byte* data, std::size_t n_bytes) {
  return HWY_DYNAMIC_DISPATCH(read_eight_streams)(data, n_bytes);
}

void write_past_cache(std::byte* data, std::size_t n_bytes) {
  HWY_DYNAMIC_DISPATCH(write_past_cache)(data, n_bytes);
}

}  // namespace mc::cli
#endif  // HWY_ONCE
