// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

/// Progress, cancellation and memory of a scan.
struct Watch {
  Progress& progress;
  const std::stop_token& stop;
  std::uint64_t memory_bytes;

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

inline std::size_t part_count(const VolumeReader& reader) {
  const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader);
  return dense != nullptr ? part_count(**dense)
                          : part_count(*std::get<std::unique_ptr<LeafReader>>(reader));
}
inline std::uint64_t scan_length(const VolumeReader& reader) {
  const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader);
  return dense != nullptr ? scan_length(**dense)
                          : scan_length(*std::get<std::unique_ptr<LeafReader>>(reader));
}

/// Planes of one read: sources that decode do so by runs of planes.
inline std::size_t planes_at_once(const Volume& volume) {
  constexpr std::uint64_t kReadBytes = std::uint64_t{1} << 24U;
  const Index3 dims = volume.lattice.dims();
  const std::uint64_t plane_bytes = static_cast<std::uint64_t>(dims[0]) *
                                    static_cast<std::uint64_t>(dims[1]) * sample_size(volume.type);
  return std::clamp<std::uint64_t>(kReadBytes / std::max<std::uint64_t>(1, plane_bytes), 1, 8);
}

/// Planes [begin, end), into a slab that is used again.
template <class T, bool Swap, class Acc>
void scan_planes(const SlabReader& dense, std::size_t begin, std::size_t end, Slab& slab, Acc& acc,
                 const Watch& watch) {
  const Index3 dims = dense.volume().lattice.dims();
  const auto n_row = static_cast<std::size_t>(dims[0]);
  const std::size_t plane_samples = n_row * static_cast<std::size_t>(dims[1]);
  dense.read(static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end), slab);
  for (std::size_t n = begin; n < end; ++n) {
    const std::byte* row = slab.planes[n - begin];
    for (std::int32_t j = 0; j < dims[1]; ++j, row += slab.row_stride_bytes) {
      acc.template row<Swap>(row, n_row);
    }
    acc.end_part(n);
    watch.step(plane_samples);
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

/// What one thread of a scan holds.
template <class Acc>
struct Scanner {
  std::optional<Acc> acc;  ///< once it has seen a part
  Slab slab;
};

/// As many scanners as there are threads, or fewer where their memory would be more than half of
/// what the scan may take.
inline std::size_t scanners_within(std::uint64_t memory_bytes, std::uint64_t bytes_each) {
  const auto n_threads = static_cast<std::uint64_t>(base::thread_count());
  return std::clamp<std::uint64_t>(memory_bytes / 2 / std::max<std::uint64_t>(1, bytes_each), 1,
                                   n_threads);
}

/// Runs accumulators, each made by `make` and of `acc_bytes`, over the whole volume and returns
/// those that saw some.
template <class T, class Make>
auto scan(const VolumeReader& reader, const Watch& watch, std::uint64_t acc_bytes,
          const Make& make) {
  using Acc = decltype(make());
  std::vector<Scanner<Acc>> scanners;
  const auto in_parallel = [&](std::size_t n_parts, std::size_t grain, std::uint64_t bytes_each,
                               const auto& body) {
    scanners.resize(scanners_within(watch.memory_bytes, bytes_each));
    const std::array<base::Step, 1> steps{{{false, [&](std::size_t run, std::size_t slot) {
                                              Scanner<Acc>& scanner = scanners[slot];
                                              if (!scanner.acc) scanner.acc.emplace(make());
                                              body(run * grain,
                                                   std::min(n_parts, (run + 1) * grain), scanner);
                                            }}}};
    base::pipeline((n_parts + grain - 1) / grain, scanners.size(), steps);
  };
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    const Volume& volume = (*dense)->volume();
    const bool swap = volume.endian != std::endian::native;
    const std::size_t run = planes_at_once(volume);
    const std::uint64_t slab_bytes =
        (*dense)->rereads_cheaply() ? 0
                                    : run * scan_length(**dense) / part_count(**dense) * sizeof(T);
    in_parallel(part_count(**dense), run, acc_bytes + slab_bytes,
                [&](std::size_t begin, std::size_t end, Scanner<Acc>& s) {
                  swap ? scan_planes<T, true>(**dense, begin, end, s.slab, *s.acc, watch)
                       : scan_planes<T, false>(**dense, begin, end, s.slab, *s.acc, watch);
                });
  } else {
    const LeafReader& sparse = *std::get<std::unique_ptr<LeafReader>>(reader);
    in_parallel(part_count(sparse), 64, acc_bytes,
                [&](std::size_t begin, std::size_t end, Scanner<Acc>& s) {
                  scan_blocks<T>(sparse, begin, end, *s.acc, watch);
                });
  }
  std::vector<Acc> out;
  for (Scanner<Acc>& scanner : scanners) {
    if (scanner.acc) out.push_back(std::move(*scanner.acc));
  }
  return out;
}

}  // namespace mc::field
