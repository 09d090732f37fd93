// SPDX-License-Identifier: MIT
#include "source/stream/streamed_planes.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "source/mapped_planes.hpp"
#include "source/stream/spool.hpp"

namespace mc::source {

StreamedPlanes::StreamedPlanes(Volume volume, std::unique_ptr<SampleStream> samples)
    : volume_(std::move(volume)),
      samples_(std::move(samples)),
      range_(volume_.type, volume_.endian) {
  const Index3 dims = volume_.lattice.dims();
  row_bytes_ = static_cast<std::size_t>(dims[0]) * sample_size(volume_.type);
  plane_bytes_ = row_bytes_ * static_cast<std::size_t>(dims[1]);
  pool_ = std::make_shared<PlanePool>(plane_bytes_);
}

StreamedPlanes::~StreamedPlanes() = default;

StreamedPlanes::Plane StreamedPlanes::next_plane() {
  const std::shared_ptr<std::byte> plane = pool_->take();
  samples_->read({plane.get(), plane_bytes_});
  if (measures_range_) range_.add(plane.get(), plane_bytes_ / sample_size(volume_.type));
  if (++next_ == volume_.lattice.dims()[2]) samples_->finish();
  return plane;
}

void StreamedPlanes::read(std::int32_t k0, std::int32_t k1, Slab& out) {
  assert(k0 <= k1 && k1 <= volume_.lattice.dims()[2]);
  assert(k0 >= next_ - static_cast<std::int32_t>(window_.size()));
  out.sides.clear();
  out.shared.clear();
  const auto drop_before = [&](std::int32_t k) {
    while (!window_.empty() && next_ - static_cast<std::int32_t>(window_.size()) < k) {
      window_.pop_front();
    }
  };
  drop_before(k0);
  while (next_ < k1) {
    window_.push_back(next_plane());
    drop_before(k0);
  }
  out.k0 = k0;
  out.row_stride_bytes = row_bytes_;
  out.planes.clear();
  out.shared.assign(window_.begin(), window_.begin() + (k1 - k0));
  for (const Plane& plane : out.shared) out.planes.push_back(plane.get());
}

void StreamedPlanes::read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                                  Slab& out) {
  read(k0, k1, out);
  if (query.region != volume_.lattice.box) return;
  // With samples on both sides there is a surface, and nobody will ask for the range.
  measures_range_ = measures_range_ && !range_.spans(query.iso);
}

std::unique_ptr<SlabReader> StreamedPlanes::spool(Progress& progress) {
  assert(next_ == 0);
  Spool spool(samples_->place(), "its samples are read more than once", progress);
  Buffer<std::byte> block(std::size_t{1} << 18U);  // a plane may be larger than the memory
  std::uint64_t left = std::uint64_t{plane_bytes_} * std::uint64_t(volume_.lattice.dims()[2]);
  while (left > 0) {
    const auto part = std::span(block).first(std::min<std::uint64_t>(left, block.size()));
    samples_->read(part);
    spool.write(part);
    left -= part.size();
  }
  samples_->finish();
  std::vector<PlaneFile> files;
  files.push_back({MappedFile(samples_->place(), spool.release()), 0});
  return std::make_unique<MappedPlanes>(volume_, std::move(files), volume_.lattice.dims()[2]);
}

}  // namespace mc::source
