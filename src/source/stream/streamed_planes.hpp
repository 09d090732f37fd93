// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "mc/field.hpp"
#include "source/mapped_planes.hpp"
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

class StreamedPlanes final : public SlabReader {
 public:
  StreamedPlanes(Volume volume, std::unique_ptr<SampleStream> samples);
  ~StreamedPlanes() override;

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override;
  void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                    Slab& out) const override;
  [[nodiscard]] bool rereads_cheaply() const override { return kept_ != nullptr; }
  [[nodiscard]] bool reads_once() const override { return kept_ == nullptr; }
  void keep_planes(Progress& progress) override;
  [[nodiscard]] FieldStatistics seen() const override { return passing_->range.seen(); }

 private:
  class Pool;
  using Plane = std::shared_ptr<const std::byte>;

  /// What changes as planes pass by.
  struct Passing {
    Passing(std::unique_ptr<SampleStream> of, SampleRange empty)
        : samples(std::move(of)), range(std::move(empty)) {}

    std::mutex mutex;
    std::unique_ptr<SampleStream> samples;
    std::deque<Plane> window;  ///< planes [next - window.size(), next)
    std::int32_t next = 0;
    SampleRange range;
    bool ranging = true;  ///< whether the range is still of interest
  };

  Plane next_plane() const;

  Volume volume_;
  std::size_t row_bytes_, plane_bytes_;
  std::shared_ptr<Pool> pool_;
  std::unique_ptr<Passing> passing_;
  std::unique_ptr<MappedPlanes> kept_;
};

}  // namespace mc::source
