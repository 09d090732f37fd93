// SPDX-License-Identifier: MIT
#include "cli/bench/bench_bandwidth.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <vector>

#include "base/parallel.hpp"
#include "cli/bench/bench_array.hpp"
#include "cli/bench/bench_memory.hpp"

namespace mc::cli {

namespace {

/// What is read goes here, so that reading is not optimised away.
std::atomic<std::uint64_t> seen{0};

/// Calls body(first byte, bytes) for runs of whole blocks that cover n_bytes, on all threads.
template <class Body>
void for_blocks(std::size_t n_bytes, Body&& body) {
  constexpr std::size_t kBlocksAtOnce = 64;  // 2 MiB
  base::for_ranges(n_bytes / kStreamBlock, kBlocksAtOnce, [&](std::size_t b0, std::size_t b1) {
    body(b0 * kStreamBlock, (b1 - b0) * kStreamBlock);
  });
}

void touch(BenchArray::Pages pages) {
  const BenchArray fresh(kBandwidthBytes, pages);
  for_blocks(fresh.size(),
             [&](std::size_t at, std::size_t n) { std::memset(fresh.data() + at, 1, n); });
}

/// The ways to move memory, in the order of Bandwidth's members.
std::vector<TimedBody> ways(const BenchArray& array, int threads) {
  std::byte* const data = array.data();
  const std::size_t size = array.size();
  return {
      {threads,
       [=] {
         for_blocks(size,
                    [=](std::size_t at, std::size_t n) { seen += read_one_stream(data + at, n); });
       }},
      {threads, [=] { read_memory(data, size); }},
      {threads,
       [=] {
         for_blocks(size, [=](std::size_t at, std::size_t n) { std::memset(data + at, 1, n); });
       }},
      {threads,
       [=] {
         for_blocks(size, [=](std::size_t at, std::size_t n) { write_past_cache(data + at, n); });
       }},
      {threads, [] { touch(BenchArray::Pages::small); }},
      {threads, [] { touch(BenchArray::Pages::huge); }}};
}

}  // namespace

void read_memory(const std::byte* data, std::size_t n_bytes) {
  for_blocks(n_bytes,
             [=](std::size_t at, std::size_t n) { seen += read_eight_streams(data + at, n); });
  // What is left of a block, a byte at a time.
  std::uint64_t sum = 0;
  for (std::size_t at = n_bytes / kStreamBlock * kStreamBlock; at < n_bytes; ++at) {
    sum |= std::to_integer<std::uint64_t>(data[at]);
  }
  seen += sum;
}

double Bandwidth::read() const {
  return static_cast<double>(n_bytes) / std::min(read_one_stream.median, read_eight_streams.median);
}

std::vector<Bandwidth> measure_bandwidth(const std::vector<int>& threads,
                                         const RoundLimits& limits) {
  const BenchArray array(kBandwidthBytes);
  std::memset(array.data(), 1, array.size());
  std::vector<Bandwidth> results;
  for (const int n : threads) {
    const std::vector<Timing> t = time_rounds(ways(array, n), limits);
    results.push_back({n, array.size(), t[0], t[1], t[2], t[3], t[4], t[5]});
  }
  return results;
}

}  // namespace mc::cli
