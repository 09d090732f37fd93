// SPDX-License-Identifier: MIT
#include "extract/components/run_table.hpp"

#include <cassert>

#include "base/disjoint_sets.hpp"

namespace mc::extraction {

void RunTable::add(const SlabLabels& slab, bool is_last) {
  const std::size_t n_planes = slab.n_planes() - (is_last ? 0 : 1);  // that the slab owns
  const std::uint32_t n_own = slab.plane_start[n_planes];
  const std::uint64_t base = parent_.size();
  if (base + slab.root.size() >= kNone) {
    throw Error(ErrorKind::limit, {},
                "the volume has more than 2^32 runs of solid samples, too many to tell its "
                "components apart",
                Remedy::smaller_region);
  }
  const auto global = [base](std::uint32_t run) { return static_cast<std::uint32_t>(base + run); };
  for (std::size_t p = 0; p < n_planes; ++p) plane_start_.push_back(base + slab.plane_start[p]);
  for (std::uint32_t run = 0; run < n_own; ++run) parent_.push_back(global(slab.root[run]));
  assert(top_.empty() || top_.size() == slab.plane_start[1]);
  for (std::uint32_t run = 0; run < top_.size(); ++run) {
    if (top_[run] != kNone) base::unite_sets(parent_, top_[run], global(run));
    add_size(global(run), top_size_[run]);
  }
  top_.assign(slab.root.size() - n_own, kNone);
  top_size_.assign(top_.size(), 0);
  for (std::uint32_t run = n_own; run < slab.root.size(); ++run) {
    if (slab.root[run] < n_own) top_[run - n_own] = global(slab.root[run]);
  }
  for (const RunSize& sum : slab.sizes) {
    if (sum.run < n_own) {
      add_size(global(sum.run), sum.size);
    } else {
      top_size_[sum.run - n_own] += sum.size;
    }
  }
}

std::uint64_t RunTable::bytes() const {
  // A component has a run that is its root, and a size.
  const std::uint64_t components = sizes_.size() * (2 * sizeof(std::uint64_t) + 1);
  return parent_.bytes() + sizes_.bytes() + plane_start_.size() * sizeof(std::uint64_t) +
         n_runs() / 8 + components;
}

std::vector<std::uint64_t> RunTable::number_components() {
  std::uint32_t n = 0;
  for (std::size_t run = 0; run < parent_.size(); ++run) {
    assert(parent_[run] <= run);
    parent_[run] = parent_[run] == run ? n++ : parent_[parent_[run]];
  }
  std::vector<std::uint64_t> sizes(n);
  for (std::size_t s = 0; s < sizes_.size(); ++s) sizes[parent_[sizes_[s].run]] += sizes_[s].size;
  return sizes;
}

RunBits RunTable::kept(std::span<const std::uint8_t> components) const {
  RunBits bits(parent_.size());
  for (std::size_t run = 0; run < parent_.size(); ++run) {
    if (components[parent_[run]] != 0) bits.set(run);
  }
  return bits;
}

}  // namespace mc::extraction
