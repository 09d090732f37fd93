// SPDX-License-Identifier: MIT
#include "source/mapped_planes.hpp"

#include <cassert>
#include <limits>
#include <utility>

#include "base/checked.hpp"
#include "source/copied_planes.hpp"

namespace mc::source {

MappedPlanes::MappedPlanes(Volume volume, std::vector<PlaneFile> files,
                           std::int32_t planes_per_file, Reading reading)
    : volume_(std::move(volume)),
      files_(std::move(files)),
      planes_per_file_(planes_per_file),
      reading_(reading) {
  const Index3 dims = volume_.lattice.dims();
  row_bytes_ = static_cast<std::size_t>(dims[0]) * sample_size(volume_.type);
  plane_bytes_ = row_bytes_ * static_cast<std::size_t>(dims[1]);
  assert(static_cast<std::size_t>(dims[2]) ==
         files_.size() * static_cast<std::size_t>(planes_per_file_));
}

void MappedPlanes::read(std::int32_t k0, std::int32_t k1, Slab& out) const {
  assert(0 <= k0 && k0 <= k1 && k1 <= volume_.lattice.dims()[2]);
  out.k0 = k0;
  out.row_stride_bytes = row_bytes_;
  out.planes.clear();
  for (std::int32_t k = k0; k < k1; ++k) {
    const PlaneFile& in = files_[static_cast<std::size_t>(k / planes_per_file_)];
    const auto nth = static_cast<std::size_t>(k % planes_per_file_);
    out.planes.push_back(in.file.bytes().data() + in.offset_bytes + nth * plane_bytes_);
  }
}

std::unique_ptr<SlabReader> MappedPlanes::copies(std::size_t n_planes) const {
  if (reading_ == Reading::mapped || files_.size() != 1) return nullptr;
  const PlaneFile& in = files_.front();
  if (in.file.descriptor() < 0) return nullptr;
  const PlaneBytes planes{in.file.descriptor(), in.offset_bytes, plane_bytes_};
  std::call_once(tried_, [&] {
    copies_ = reading_ == Reading::copied ||
              copies_faster(planes, in.file.bytes().subspan(in.offset_bytes));
  });
  if (!copies_) return nullptr;
  return std::make_unique<CopiedPlanes>(volume_, planes, in.file.place(), n_planes);
}

std::optional<std::uint64_t> volume_bytes(std::int64_t nx, std::int64_t ny, std::int64_t nz,
                                          SampleType type) {
  if (nx < 0 || ny < 0 || nz < 0) {
    return std::nullopt;
  }
  const auto bytes = base::checked_mul<std::uint64_t>(
      static_cast<std::uint64_t>(nx), static_cast<std::uint64_t>(ny),
      static_cast<std::uint64_t>(nz), std::uint64_t{sample_size(type)});
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::ptrdiff_t>::max());
  return bytes && *bytes <= kMost ? bytes : std::nullopt;
}

}  // namespace mc::source
