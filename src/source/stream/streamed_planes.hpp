// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <utility>

#include "mc/field.hpp"
#include "source/plane_pool.hpp"
#include "source/stream/sample_range.hpp"

// Dense samples that pass by once: each plane is read straight into memory that all slabs which
// need it share, and that is used again when the last of them is through.

namespace mc::source {

/// The samples of a volume, one after the other.
class SampleStream {
 public:
  virtual ~SampleStream() = default;
  /// Fills all of `out`. Errors   input: they end before.
  virtual void read(std::span<std::byte> out) = 0;
  /// All have been read. Errors   input: more follows, where that is a fault.
  virtual void finish() = 0;
  /// How messages name it.
  [[nodiscard]] virtual const std::string& place() const = 0;
};

class StreamedPlanes final : public PlaneStream {
 public:
  StreamedPlanes(Volume volume, std::unique_ptr<SampleStream> samples);
  ~StreamedPlanes() override;

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) override;
  void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                    Slab& out) override;
  [[nodiscard]] std::unique_ptr<SlabReader> spool(Progress& progress) override;
  [[nodiscard]] FieldStatistics statistics() const override { return range_.seen(); }

 private:
  using Plane = std::shared_ptr<const std::byte>;

  Plane next_plane();

  Volume volume_;
  std::size_t row_bytes_, plane_bytes_;
  std::shared_ptr<PlanePool> pool_;
  std::unique_ptr<SampleStream> samples_;
  std::deque<Plane> window_;  // planes [next_ - window_.size(), next_)
  std::int32_t next_ = 0;
  SampleRange range_;
  bool measures_range_ = true;  // until samples on both sides of the surface have passed
};

}  // namespace mc::source
