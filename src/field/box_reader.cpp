// SPDX-License-Identifier: MIT
#include "field/box_reader.hpp"

#include <cassert>
#include <cstring>

namespace mc::field {

void read_box(const SlabReader& reader, const IndexBox& box, std::span<std::byte> out) {
  assert(reader.volume().lattice.box.contains(box));
  if (const auto* own = dynamic_cast<const BoxReader*>(&reader)) return own->read_box(box, out);
  const std::size_t size = sample_size(reader.volume().type);
  const std::size_t row_bytes = static_cast<std::size_t>(box.extent(0)) * size;
  assert(out.size() == row_bytes * static_cast<std::size_t>(box.extent(1) * box.extent(2)));
  Slab slab;
  std::byte* to = out.data();
  for (std::int32_t k = box.lo[2]; k <= box.hi[2]; ++k) {
    reader.read(k, k + 1, slab);
    const std::byte* from = slab.planes[0] + static_cast<std::size_t>(box.lo[0]) * size;
    for (std::int32_t j = box.lo[1]; j <= box.hi[1]; ++j, to += row_bytes) {
      std::memcpy(to, from + static_cast<std::size_t>(j) * slab.row_stride_bytes, row_bytes);
    }
  }
}

}  // namespace mc::field
