// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/mapped_file.hpp"

// Dense samples that lie in mapped files: slabs point into the mappings, and nothing is copied
// unless who reads asks for copies().

namespace mc::source {

/// Samples of one file: consecutive planes from `offset_bytes` on.
struct PlaneFile {
  MappedFile file;
  std::size_t offset_bytes = 0;
};

class MappedPlanes final : public SlabReader {
 public:
  /// Each file holds the same number of planes, `planes_per_file`; together they are the volume's.
  /// `reading` decides whether copies() gives any; they need a single file that was kept open.
  /// Precondition: every file is long enough (checked by who parsed it).
  MappedPlanes(Volume volume, std::vector<PlaneFile> files, std::int32_t planes_per_file,
               Reading reading = Reading::fastest);

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override;
  [[nodiscard]] bool rereads_cheaply() const override { return true; }
  [[nodiscard]] std::unique_ptr<SlabReader> copies(std::size_t n_planes) const override;

 private:
  Volume volume_;
  std::vector<PlaneFile> files_;
  std::int32_t planes_per_file_;
  Reading reading_;
  mutable std::once_flag tried_;
  mutable bool copies_ = false;  ///< once tried
  std::size_t row_bytes_;
  std::size_t plane_bytes_;
};

/// nx * ny * nz samples of `type` in bytes. nullopt: more than 2^63 - 1.
[[nodiscard]] std::optional<std::uint64_t> volume_bytes(std::int64_t nx, std::int64_t ny,
                                                        std::int64_t nz, SampleType type);

}  // namespace mc::source
