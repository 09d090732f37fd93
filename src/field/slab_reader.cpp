// SPDX-License-Identifier: MIT
#include <cassert>
#include <cstring>

#include "mc/field.hpp"

// What a dense reader does unless it knows better.

namespace mc {

void SlabReader::read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& /*query*/,
                              Slab& out) const {
  out.sides.clear();
  read(k0, k1, out);
}

void SlabReader::read_box(const IndexBox& box, std::span<std::byte> out) const {
  assert(volume().lattice.box.contains(box));
  const std::size_t size = sample_size(volume().type);
  const std::size_t row_bytes = static_cast<std::size_t>(box.extent(0)) * size;
  assert(out.size() == row_bytes * static_cast<std::size_t>(box.extent(1) * box.extent(2)));
  Slab slab;
  std::byte* to = out.data();
  for (std::int32_t k = box.lo[2]; k <= box.hi[2]; ++k) {
    read(k, k + 1, slab);
    const std::byte* from = slab.planes[0] + static_cast<std::size_t>(box.lo[0]) * size;
    for (std::int32_t j = box.lo[1]; j <= box.hi[1]; ++j, to += row_bytes) {
      std::memcpy(to, from + static_cast<std::size_t>(j) * slab.row_stride_bytes, row_bytes);
    }
  }
}

}  // namespace mc
