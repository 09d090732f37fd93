// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "extract/components/runs.hpp"
#include "mc/components.hpp"

// All solid runs of a volume, slab after slab, joined to components.

namespace mc::extraction {

/// A list that grows page by page, so that it is never copied.
template <class T>
class PagedList {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T& operator[](std::size_t n) { return pages_[n >> kPageBits][n & kPageMask]; }
  [[nodiscard]] const T& operator[](std::size_t n) const {
    return pages_[n >> kPageBits][n & kPageMask];
  }
  void push_back(const T& value) {
    if (size_ >> kPageBits == pages_.size()) {
      pages_.push_back(std::make_unique_for_overwrite<T[]>(kPageMask + 1));
    }
    (*this)[size_++] = value;
  }
  [[nodiscard]] std::uint64_t bytes() const { return pages_.size() * (kPageMask + 1) * sizeof(T); }

 private:
  static constexpr std::size_t kPageBits = 16, kPageMask = (std::size_t{1} << kPageBits) - 1;

  std::vector<std::unique_ptr<T[]>> pages_;
  std::size_t size_ = 0;
};

/// Adds to the size of the component that a run belongs to.
struct RunSize {
  std::uint32_t run;
  std::uint64_t size;  ///< in SizeUnit; sums wrap around
};

/// Labels of the runs in one slab of planes.
struct SlabLabels {
  std::vector<std::uint32_t> plane_start;  ///< first run of each plane, and the number of all
  std::vector<std::uint32_t> root;         ///< of each run: the first run of its component so far
  std::vector<RunSize> sizes;              ///< by root

  [[nodiscard]] std::size_t n_planes() const { return plane_start.size() - 1; }
};

/// A bit for each run.
class RunBits {
 public:
  RunBits() = default;
  explicit RunBits(std::size_t n) : words_((n + 63) / 64, 0) {}
  [[nodiscard]] bool operator[](std::size_t n) const {
    return (words_[n / 64] >> (n % 64) & 1U) != 0;
  }
  void set(std::size_t n) { words_[n / 64] |= std::uint64_t{1} << (n % 64); }
  [[nodiscard]] std::uint64_t bytes() const { return words_.size() * sizeof(std::uint64_t); }

 private:
  std::vector<std::uint64_t> words_;
};

/// Joins slabs. Successive slabs share a plane: the last of one is the first of the next.
class RunTable {
 public:
  /// Adds the next slab, in order.
  /// Errors   limit: 2^32 - 1 runs or more.
  void add(const SlabLabels& slab, bool is_last);

  [[nodiscard]] std::uint64_t n_runs() const { return parent_.size(); }
  /// The first run of a plane; planes count from the first slab's first.
  [[nodiscard]] std::span<const std::uint64_t> plane_starts() const { return plane_start_; }

  /// Bytes in use, and those that components() and kept() will take.
  [[nodiscard]] std::uint64_t bytes() const;

  /// Numbers the components in the order of their first samples. Call once, after all slabs.
  /// Returns  the sum of sizes of each.
  std::vector<std::uint64_t> number_components();
  /// Which runs belong to a component that remains.
  [[nodiscard]] RunBits kept(std::span<const std::uint8_t> components) const;
  /// The component of a run, after number_components().
  [[nodiscard]] std::uint32_t component(std::size_t run) const { return parent_[run]; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  void add_size(std::uint32_t run, std::uint64_t size) {
    if (size != 0) sizes_.push_back({run, size});
  }

  PagedList<std::uint32_t> parent_;  ///< of each run; later its component
  PagedList<RunSize> sizes_;
  std::vector<std::uint64_t> plane_start_;
  std::vector<std::uint32_t> top_;       ///< of the shared plane's runs: their root, or kNone
  std::vector<std::uint64_t> top_size_;  ///< of those without a root
};

}  // namespace mc::extraction
