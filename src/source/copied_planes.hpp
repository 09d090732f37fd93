// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/plane_pool.hpp"

// Dense samples of one file, copied plane by plane into memory that is used again. Some systems map
// a page of a file more slowly than they copy it.

namespace mc::source {

/// Where the planes of a file are.
struct PlaneBytes {
  int descriptor = -1;
  std::uint64_t offset = 0;
  std::size_t n_bytes = 0;  ///< of a plane
};

class CopiedPlanes final : public SlabReader {
 public:
  /// Borrows the descriptor. `place` is how messages name the file. Takes memory for `n_planes`
  /// that slabs share at once; more are read, too.
  CopiedPlanes(const Volume& volume, const PlaneBytes& planes, std::string place,
               std::size_t n_planes);

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  /// A plane that another slab still holds is not read again: neighbouring slabs share theirs.
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override;
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

 private:
  /// A plane in memory, or on its way there.
  struct Plane {
    std::once_flag filled;
    std::shared_ptr<std::byte> bytes;
  };

  void fill(std::int32_t k, std::byte* to) const;

  const Volume& volume_;
  PlaneBytes planes_;
  std::string place_;
  std::shared_ptr<PlanePool> pool_;
  mutable std::mutex mutex_;
  mutable std::vector<std::weak_ptr<Plane>> known_;
};

/// Whether planes of a mapped file are copied faster than they are read in the mapping: decided by
/// a trial of a few MiB. `mapped` are the bytes of the file from planes.offset on. False if the
/// file is small, or not in memory yet: then the disk decides, and the mapping reads ahead.
[[nodiscard]] bool copies_faster(const PlaneBytes& planes, std::span<const std::byte> mapped);

}  // namespace mc::source
