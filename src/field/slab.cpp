// SPDX-License-Identifier: MIT
#include <cassert>
#include <cstring>
#include <limits>

#include "base/checked.hpp"
#include "mc/field.hpp"

// Slabs that own their samples, and what a SlabReader does unless it knows a cheaper way.

namespace mc {

void Slab::allocate(const IndexBox& box, std::size_t sample_bytes) {
  const auto extent = [&](int axis) { return static_cast<std::size_t>(box.extent(axis)); };
  const auto bytes = base::checked_mul(extent(0), extent(1), extent(2), sample_bytes);
  if (!bytes || *bytes > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max())) {
    throw Error(ErrorKind::limit, {}, "planes of this size do not fit into memory",
                Remedy::smaller_region);
  }
  i0 = box.lo[0];
  j0 = box.lo[1];
  k0 = box.lo[2];
  row_stride_bytes = extent(0) * sample_bytes;
  if (storage.capacity() < *bytes) storage = Buffer<std::byte>();
  storage.resize(*bytes);
  planes.resize(extent(2));
  for (std::size_t n = 0; n < planes.size(); ++n) {
    planes[n] = storage.data() + n * extent(1) * row_stride_bytes;
  }
  shared.clear();
  sides.clear();
}

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
