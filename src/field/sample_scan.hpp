// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <stop_token>
#include <utility>
#include <variant>
#include <vector>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Every sample of a volume of either kind, once, on several threads. A volume falls into parts
// that do not depend on the threads: planes; or leaves, then tiles. Accumulators see whole parts.
//
// An accumulator has
//   void row<Swap>(const std::byte* at, std::size_t n)  n adjacent samples of any alignment
//   void weighted(T value, std::uint64_t n)             n equal samples
//   void end_part(std::size_t part)                     the samples since the last call were `part`

namespace mc::field {

/// Progress and cancellation of a scan.
struct Watch {
  Progress& progress;
  const std::stop_token& stop;

  void step(std::uint64_t n_samples) const {
    if (stop.stop_requested()) throw Cancelled();
    progress.advance(n_samples);
  }
};

/// Parts of a volume, see above.
inline std::size_t part_count(const SlabReader& dense) {
  return static_cast<std::size_t>(dense.volume().lattice.dims()[2]);
}
inline std::size_t part_count(const LeafReader& sparse) {
  return sparse.leaves().size() + sparse.tiles().size();
}

/// Samples that one scan reports to Watch: all of a dense volume, those of the leaves of a sparse.
inline std::uint64_t scan_length(const SlabReader& dense) {
  const Index3 dims = dense.volume().lattice.dims();
  return static_cast<std::uint64_t>(dims[0]) * static_cast<std::uint64_t>(dims[1]) *
         static_cast<std::uint64_t>(dims[2]);
}
inline std::uint64_t scan_length(const LeafReader& sparse) {
  return sparse.leaves().size() * LeafReader::kLeafSamples;
}

/// Accumulators that threads take and give back, so that there are no more than threads.
template <class Acc>
class AccumulatorPool {
 public:
  template <class Make>
  std::unique_ptr<Acc> take(const Make& make) {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Acc>(make());
    std::unique_ptr<Acc> out = std::move(free_.back());
    free_.pop_back();
    return out;
  }
  void give(std::unique_ptr<Acc> acc) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(acc));
  }
  std::vector<std::unique_ptr<Acc>> release() { return std::move(free_); }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Acc>> free_;
};

/// Planes [begin, end), a few at a time: sources that decode do so by runs of planes.
template <class T, bool Swap, class Acc>
void scan_planes(const SlabReader& dense, std::size_t begin, std::size_t end, Acc& acc,
                 const Watch& watch) {
  constexpr std::size_t kReadBytes = std::size_t{1} << 24U;
  const Index3 dims = dense.volume().lattice.dims();
  const auto n_row = static_cast<std::size_t>(dims[0]);
  const std::size_t plane_samples = n_row * static_cast<std::size_t>(dims[1]);
  const std::size_t run = std::clamp<std::size_t>(
      kReadBytes / std::max<std::size_t>(1, plane_samples * sizeof(T)), 1, 8);
  Slab slab;
  for (std::size_t k = begin; k < end; k += run) {
    const std::size_t last = std::min(end, k + run);
    dense.read(static_cast<std::int32_t>(k), static_cast<std::int32_t>(last), slab);
    for (std::size_t n = k; n < last; ++n) {
      const std::byte* row = slab.planes[n - k];
      for (std::int32_t j = 0; j < dims[1]; ++j, row += slab.row_stride_bytes) {
        acc.template row<Swap>(row, n_row);
      }
      acc.end_part(n);
      watch.step(plane_samples);
    }
  }
}

template <class T, class Acc>
void scan_leaf(const LeafReader& sparse, std::size_t n, Acc& acc) {
  alignas(64) std::array<std::byte, LeafReader::kLeafSamples * sizeof(std::uint64_t)> scratch;
  std::array<T, LeafReader::kLeafSamples> active;
  const std::byte* values = sparse.leaf_values(n, scratch.data());
  std::size_t n_active = 0;
  const std::array<std::uint64_t, 8> masks = sparse.leaf_active(n);
  for (std::size_t word = 0; word < masks.size(); ++word) {
    for (std::uint64_t mask = masks[word]; mask != 0; mask &= mask - 1) {
      const std::size_t at = word * 64 + static_cast<std::size_t>(std::countr_zero(mask));
      active[n_active++] = load_sample<T, false>(values + at * sizeof(T));
    }
  }
  acc.template row<false>(reinterpret_cast<const std::byte*>(active.data()), n_active);
}

/// Active samples of parts [begin, end); inactive ones are not looked at.
template <class T, class Acc>
void scan_blocks(const LeafReader& sparse, std::size_t begin, std::size_t end, Acc& acc,
                 const Watch& watch) {
  const std::size_t n_leaves = sparse.leaves().size();
  for (std::size_t part = begin; part < end; ++part) {
    if (part < n_leaves) {
      scan_leaf<T>(sparse, part, acc);
      watch.step(LeafReader::kLeafSamples);
    } else if (const Tile& tile = sparse.tiles()[part - n_leaves]; tile.active) {
      const auto size = static_cast<std::uint64_t>(tile.size);
      acc.weighted(tile.value.as<T>(), size * size * size);
    }
    acc.end_part(part);
  }
}

/// Runs accumulators, each made by `make`, over the whole volume and returns those that saw some.
template <class T, class Make>
auto scan(const VolumeReader& reader, const Watch& watch, const Make& make) {
  using Acc = decltype(make());
  AccumulatorPool<Acc> pool;
  const auto in_parallel = [&](std::size_t n_parts, std::size_t grain, const auto& body) {
    base::for_ranges(n_parts, grain, [&](std::size_t begin, std::size_t end) {
      std::unique_ptr<Acc> acc = pool.take(make);
      body(begin, end, *acc);
      pool.give(std::move(acc));
    });
  };
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    const bool swap = (*dense)->volume().endian != std::endian::native;
    in_parallel(part_count(**dense), 8, [&](std::size_t begin, std::size_t end, Acc& acc) {
      swap ? scan_planes<T, true>(**dense, begin, end, acc, watch)
           : scan_planes<T, false>(**dense, begin, end, acc, watch);
    });
  } else {
    const LeafReader& sparse = *std::get<std::unique_ptr<LeafReader>>(reader);
    in_parallel(part_count(sparse), 64, [&](std::size_t begin, std::size_t end, Acc& acc) {
      scan_blocks<T>(sparse, begin, end, acc, watch);
    });
  }
  return pool.release();
}

}  // namespace mc::field
