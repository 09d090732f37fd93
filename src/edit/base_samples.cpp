// SPDX-License-Identifier: MIT
#include "edit/base_samples.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "field/visit_type.hpp"

// Samples of an input by blocks and boxes, whatever its kind. Leaves are found by bisection of the
// reader's own list, tiles by that of one list for each size.

namespace mc::edit {

namespace {

/// Calls f with an unsigned number as wide as a sample.
template <class F>
void visit_width(std::size_t sample_bytes, F&& f) {
  switch (sample_bytes) {
    case 1:
      return f(std::uint8_t{});
    case 2:
      return f(std::uint16_t{});
    case 4:
      return f(std::uint32_t{});
    default:
      assert(sample_bytes == 8);
      return f(std::uint64_t{});
  }
}

std::int32_t floored(std::int32_t v, std::int32_t step) {
  const std::int32_t rest = v % step;
  return rest < 0 ? v - rest - step : v - rest;
}

}  // namespace

void fill_samples(std::byte* out, std::size_t n, const Scalar& value, std::size_t sample_bytes) {
  visit_width(sample_bytes, [&]<class Bits>(Bits) {
    std::fill_n(reinterpret_cast<Bits*>(out), n, value.as<Bits>());
  });
}

void swap_samples(std::span<std::byte> samples, std::size_t sample_bytes) {
  visit_width(sample_bytes, [&]<class Bits>(Bits) {
    for (std::size_t at = 0; at < samples.size(); at += sizeof(Bits)) {
      const auto swapped = field::load_sample<Bits, true>(samples.data() + at);
      std::memcpy(samples.data() + at, &swapped, sizeof swapped);
    }
  });
}

void transpose_block(const std::byte* in, std::byte* out, std::size_t sample_bytes) {
  visit_width(sample_bytes, [&]<class Bits>(Bits) {
    auto* to = reinterpret_cast<Bits*>(out);
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      for (std::size_t j = 0; j < kBlockSize; ++j) {
        for (std::size_t i = 0; i < kBlockSize; ++i, ++to) {
          *to = field::load_sample<Bits, false>(in + (i * 64 + j * 8 + k) * sizeof(Bits));
        }
      }
    }
  });
}

Mask512 transposed(const Mask512& mask) {
  Mask512 out{};
  for (std::size_t k = 0; k < kBlockSize; ++k) {
    for (std::size_t j = 0; j < kBlockSize; ++j) {
      for (std::size_t i = 0; i < kBlockSize; ++i) {
        out[k] |= (mask[i] >> (j * 8 + k) & 1U) << (j * 8 + i);
      }
    }
  }
  return out;
}

InputSamples::InputSamples(const VolumeReader& input)
    : volume_(&volume_of(input)), sample_bytes_(sample_size(volume_->type)) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&input)) {
    slabs_ = dense->get();
    extent_ = volume_->lattice.box;
    return;
  }
  leaves_ = std::get<std::unique_ptr<LeafReader>>(input).get();
  index_tiles();
  for (const Index3& leaf : leaves_->leaves()) {
    extent_ = joined(extent_, samples_of(block_of(leaf)));
  }
}

void InputSamples::index_tiles() {
  const std::span<const Tile> tiles = leaves_->tiles();
  for (std::uint32_t n = 0; n < tiles.size(); ++n) {
    const Tile& tile = tiles[n];
    const std::int32_t past = tile.size - 1;
    extent_ = joined(
        extent_,
        {tile.origin, {tile.origin[0] + past, tile.origin[1] + past, tile.origin[2] + past}});
    auto group = std::find_if(tiles_.begin(), tiles_.end(),
                              [&](const TileGroup& g) { return g.size == tile.size; });
    if (group == tiles_.end()) group = tiles_.insert(group, {tile.size, {}});
    group->tiles.push_back(n);
  }
  for (TileGroup& group : tiles_) {
    std::sort(group.tiles.begin(), group.tiles.end(), [&](std::uint32_t a, std::uint32_t b) {
      return comes_before(tiles[a].origin, tiles[b].origin);
    });
  }
}

std::optional<std::size_t> InputSamples::leaf_at(const Index3& block) const {
  const std::span<const Index3> origins = leaves_->leaves();
  const Index3 origin = origin_of(block);
  const auto at = std::lower_bound(origins.begin(), origins.end(), origin, comes_before);
  if (at == origins.end() || *at != origin) return std::nullopt;
  return static_cast<std::size_t>(at - origins.begin());
}

const Tile* InputSamples::tile_at(const Index3& block) const {
  const std::span<const Tile> tiles = leaves_->tiles();
  const Index3 p = origin_of(block);
  for (const TileGroup& group : tiles_) {
    const Index3 origin{floored(p[0], group.size), floored(p[1], group.size),
                        floored(p[2], group.size)};
    const auto at = std::lower_bound(
        group.tiles.begin(), group.tiles.end(), origin,
        [&](std::uint32_t n, const Index3& o) { return comes_before(tiles[n].origin, o); });
    if (at != group.tiles.end() && tiles[*at].origin == origin) return &tiles[*at];
  }
  return nullptr;
}

void InputSamples::read_sparse_block(const Index3& block, std::byte* out) const {
  if (const auto leaf = leaf_at(block)) {
    alignas(64) std::array<std::byte, kBlockSamples * sizeof(std::uint64_t)> scratch;
    transpose_block(leaves_->leaf_values(*leaf, scratch.data()), out, sample_bytes_);
    return;
  }
  const Tile* tile = tile_at(block);
  fill_samples(out, kBlockSamples, tile != nullptr ? tile->value : leaves_->background(),
               sample_bytes_);
}

Mask512 InputSamples::read_active(const Index3& block) const {
  Mask512 all;
  all.fill(~std::uint64_t{0});
  if (leaves_ == nullptr) return all;
  if (const auto leaf = leaf_at(block)) return transposed(leaves_->leaf_active(*leaf));
  const Tile* tile = tile_at(block);
  return tile != nullptr && tile->active ? all : Mask512{};
}

void InputSamples::read_block(const Index3& block, std::byte* out) const {
  if (leaves_ != nullptr) return read_sparse_block(block, out);
  const IndexBox whole = samples_of(block);
  const IndexBox box = common_part(whole, volume_->lattice.box);
  const std::size_t block_bytes = kBlockSamples * sample_bytes_;
  if (box == whole) return read_box(box, {out, block_bytes});
  std::memset(out, 0, block_bytes);
  if (is_empty(box)) return;
  alignas(64) std::array<std::byte, kBlockSamples * sizeof(std::uint64_t)> part;
  const std::size_t row_bytes = static_cast<std::size_t>(box.extent(0)) * sample_bytes_;
  const auto n_rows = static_cast<std::size_t>(box.extent(1) * box.extent(2));
  read_box(box, {part.data(), row_bytes * n_rows});
  // A dense box starts at 0, so that only ends of blocks stick out.
  const auto ny = static_cast<std::size_t>(box.extent(1));
  for (std::size_t row = 0; row < n_rows; ++row) {
    const std::size_t at = (row / ny * kBlockSize + row % ny) * kBlockSize * sample_bytes_;
    std::memcpy(out + at, part.data() + row * row_bytes, row_bytes);
  }
}

void InputSamples::read_box(const IndexBox& box, std::span<std::byte> out) const {
  if (slabs_ != nullptr) {
    slabs_->read_box(box, out);
    if (volume_->endian != std::endian::native) swap_samples(out, sample_bytes_);
    return;
  }
  for_blocks_of(box, [&](const Index3& block) {
    alignas(64) std::array<std::byte, kBlockSamples * sizeof(std::uint64_t)> samples;
    read_sparse_block(block, samples.data());
    copy_from_block(block, samples.data(), sample_bytes_, box, out.data());
  });
}

}  // namespace mc::edit
