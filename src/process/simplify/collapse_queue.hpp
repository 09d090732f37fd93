// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mc::process {

/// Vertices that wait for their collapse, the cheapest first. Costs within 1/16 of a power of two
/// count as equal; of equal ones, the vertex that was put in first comes first.
/// Cost     O(1) for each call; 12 bytes a vertex.
class CollapseQueue {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  explicit CollapseQueue(std::size_t n_vertices)
      : links_(n_vertices), buckets_of_(n_vertices, kNoBucket) {
    ends_.fill({kNone, kNone});
  }

  /// Puts a vertex in, or moves it to the end of the bucket of its cost, which is 0 or more.
  void put(std::uint32_t vertex, float cost);
  /// Takes a vertex out if it is there.
  void remove(std::uint32_t vertex);
  /// Takes the first vertex out; kNone if there is none.
  std::uint32_t take();

 private:
  struct Link {
    std::uint32_t before, after;  ///< or first and last of a bucket
  };
  // Costs from 2^-40 to 2^24, in sixteenths of powers of two.
  static constexpr std::uint32_t kBuckets = 64 * 16;
  static constexpr std::uint16_t kNoBucket = 0xFFFF;

  static std::uint32_t bucket_of(float cost);

  std::array<Link, kBuckets> ends_;
  std::array<std::uint64_t, kBuckets / 64> filled_{};  ///< a bit for each bucket
  std::vector<Link> links_;
  std::vector<std::uint16_t> buckets_of_;
};

}  // namespace mc::process
