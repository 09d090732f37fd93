// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "edit/block.hpp"
#include "mc/field.hpp"

namespace mc::edit {

/// What lies under a store's blocks: a volume of either kind, in native byte order.
/// Threads  all but the constructor may be called from several threads at once.
class InputSamples {
 public:
  /// Keeps a reference. Cost   sparse: sorts the tiles.
  explicit InputSamples(const VolumeReader& input);

  /// The samples of a block, x fastest; those outside a dense volume are zeros.
  void read_block(const Index3& block, std::byte* out) const;
  /// Which of them are active: all of a dense volume's.
  [[nodiscard]] Mask512 read_active(const Index3& block) const;
  /// The samples of a box within the volume, x fastest.
  void read_box(const IndexBox& box, std::span<std::byte> out) const;

  /// The least box around all leaves and tiles, or the volume's.
  [[nodiscard]] IndexBox extent() const { return extent_; }
  [[nodiscard]] const LeafReader* leaves() const { return leaves_; }
  [[nodiscard]] const SlabReader* slabs() const { return slabs_; }
  [[nodiscard]] AttributeReaders attributes() const {
    return slabs_ != nullptr ? slabs_->attributes() : leaves_->attributes();
  }
  [[nodiscard]] std::size_t sample_bytes() const { return sample_bytes_; }
  [[nodiscard]] const Volume& volume() const { return *volume_; }

 private:
  struct TileGroup {
    std::int32_t size;
    std::vector<std::uint32_t> tiles;  // by (z, y, x)
  };

  void index_tiles();
  [[nodiscard]] std::optional<std::size_t> leaf_at(const Index3& block) const;
  [[nodiscard]] const Tile* tile_at(const Index3& block) const;
  void read_sparse_block(const Index3& block, std::byte* out) const;

  const Volume* volume_;
  const SlabReader* slabs_ = nullptr;
  const LeafReader* leaves_ = nullptr;
  std::size_t sample_bytes_;
  IndexBox extent_;
  std::vector<TileGroup> tiles_;
};

/// Fills n samples of `sample_bytes` each with one value.
void fill_samples(std::byte* out, std::size_t n, const Scalar& value, std::size_t sample_bytes);
/// Turns the bytes of each sample round.
void swap_samples(std::span<std::byte> samples, std::size_t sample_bytes);
/// A leaf's 512 samples, z fastest, with x fastest instead; and back: it is its own inverse.
void transpose_block(const std::byte* in, std::byte* out, std::size_t sample_bytes);
Mask512 transposed(const Mask512& mask);

}  // namespace mc::edit
