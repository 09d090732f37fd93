// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Volumes in memory behind the two ports, for tests: a dense array as planes, and the same array
// cut into leaves, tiles and absent blocks.

namespace mc::test {

/// A dense volume over an array of its own.
class MemorySlabs final : public SlabReader {
 public:
  struct Layout {
    Affine to_world;
    std::endian endian = std::endian::native;  ///< of the bytes that read() hands out
    std::size_t row_padding = 0;               ///< bytes between rows
    std::size_t lead = 0;                      ///< bytes before the first sample: 1 misaligns all
    bool rereads_cheaply = true;
  };

  /// `samples` holds dims[0]*dims[1]*dims[2] values, i fastest, in native order.
  template <class T>
  MemorySlabs(const std::vector<T>& samples, Index3 dims, Layout layout)
      : MemorySlabs(std::as_bytes(std::span(samples)), field::type_of<T>(), dims, layout) {}
  template <class T>
  MemorySlabs(const std::vector<T>& samples, Index3 dims, const Affine& to_world = {})
      : MemorySlabs(samples, dims, Layout{.to_world = to_world}) {}
  MemorySlabs(std::span<const std::byte> samples, SampleType type, Index3 dims, Layout layout);

  /// For what the constructor does not set: class, frame, units, iso, name.
  Volume& edit() { return volume_; }

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override;
  [[nodiscard]] bool rereads_cheaply() const override { return layout_.rereads_cheaply; }

 private:
  Volume volume_;
  Layout layout_;
  std::size_t row_stride_ = 0;
  std::vector<std::byte> bytes_;
};

/// How MemoryLeaves keeps a block whose 512 samples are equal.
enum class Keep : std::uint8_t { leaf, tile, absent };

/// A sparse volume cut from a dense array. Samples of the array are active, all others inactive
/// background. A block with differing samples, or one that sticks out of the array, is a leaf; a
/// uniform block is what `choose` says of its origin, where `absent` counts only for background.
class MemoryLeaves final : public LeafReader {
 public:
  using Choose = std::function<Keep(const Index3& origin)>;

  /// Background is absent, every other uniform block a tile.
  static Choose sparsest();
  /// Pure function of `seed` and the block's origin: a third of each kind.
  static Choose seeded(std::uint64_t seed);

  /// `origin` is the index of the first sample; multiples of 8 (asserted).
  template <class T>
  MemoryLeaves(const std::vector<T>& samples, Index3 dims, Index3 origin, T background,
               const Affine& to_world = {}, const Choose& choose = sparsest())
      : MemoryLeaves(std::as_bytes(std::span(samples)), field::type_of<T>(), dims, origin,
                     Scalar::of(background), to_world, choose) {}
  MemoryLeaves(std::span<const std::byte> samples, SampleType type, Index3 dims, Index3 origin,
               Scalar background, const Affine& to_world, const Choose& choose);

  Volume& edit() { return volume_; }
  /// One more tile; the caller sees to it that it overlaps nothing. Grows the box if it is active.
  void add_tile(const Tile& tile);
  /// Clears the active bit of samples that the predicate (of the index) names.
  void deactivate(const std::function<bool(const Index3&)>& where);

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] Scalar background() const override { return background_; }
  [[nodiscard]] std::span<const Index3> leaves() const override { return origins_; }
  const std::byte* leaf_values(std::size_t n, std::byte* scratch) const override;
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t n) const override;
  [[nodiscard]] std::span<const Tile> tiles() const override { return tiles_; }

 private:
  void add_block(std::span<const std::byte> samples, const IndexBox& array, const Index3& origin,
                 const Choose& choose);

  Volume volume_;
  Scalar background_;
  std::vector<Index3> origins_;
  std::vector<std::byte> values_;  // 512 samples a leaf
  std::vector<std::array<std::uint64_t, 8>> active_;
  std::vector<Tile> tiles_;
};

}  // namespace mc::test
