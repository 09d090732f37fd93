// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "edit/edited_materials.hpp"
#include "edit/edited_reader.hpp"

// An edited sparse volume as leaves and tiles.

namespace mc::edit {

namespace {

class EditedLeaves final : public LeafReader {
 public:
  EditedLeaves(const World& world, Volume volume)
      : samples_(world.samples), materials_(world), volume_(std::move(volume)) {
    std::vector<Index3> stored;
    stored.reserve(samples_.layer().blocks().size());
    for (const auto& [at, block] : samples_.layer().blocks()) stored.push_back(at);
    std::sort(stored.begin(), stored.end(), comes_before);
    merge_leaves(stored);
    if (samples_.filled()) return;
    for (const Tile& tile : samples_.input().leaves()->tiles()) add_tile(tile, stored);
  }

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] AttributeReaders attributes() const override { return materials_.attributes(); }
  [[nodiscard]] Scalar background() const override { return samples_.background(); }
  [[nodiscard]] std::span<const Index3> leaves() const override { return origins_; }
  [[nodiscard]] std::span<const Tile> tiles() const override { return tiles_; }
  [[nodiscard]] std::uint64_t held_bytes() const override {
    return samples_.filled() ? 0 : samples_.input().leaves()->held_bytes();
  }

  const std::byte* leaf_values(std::size_t n, std::byte* scratch) const override {
    if (sources_[n] != kStored) {
      return samples_.input().leaves()->leaf_values(sources_[n], scratch);
    }
    transpose_block(stored(n).samples(), scratch, samples_.input().sample_bytes());
    return scratch;
  }
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t n) const override {
    if (sources_[n] != kStored) return samples_.input().leaves()->leaf_active(sources_[n]);
    return transposed(stored(n).active);
  }

 private:
  static constexpr std::size_t kStored = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] const Block& stored(std::size_t n) const {
    const Block* block = samples_.layer().find(block_of(origins_[n]));
    assert(block != nullptr);
    return *block;
  }

  void merge_leaves(const std::vector<Index3>& stored) {
    const std::span<const Index3> input =
        samples_.filled() ? std::span<const Index3>{} : samples_.input().leaves()->leaves();
    auto at = stored.begin();
    const auto put_stored = [&] {
      origins_.push_back(origin_of(*at++));
      sources_.push_back(kStored);
    };
    for (std::size_t n = 0; n < input.size(); ++n) {
      const Index3 block = block_of(input[n]);
      while (at != stored.end() && comes_before(*at, block)) put_stored();
      if (at != stored.end() && *at == block) {
        put_stored();
        continue;
      }
      origins_.push_back(input[n]);
      sources_.push_back(n);
    }
    while (at != stored.end()) put_stored();
  }

  /// A tile, or what is left of it: halved along each axis until a part holds no stored block or is
  /// one. `stored`: those that may lie in it.
  void add_tile(const Tile& tile, const std::vector<Index3>& stored) {
    const std::int32_t past = tile.size - 1;
    const IndexBox box{tile.origin,
                       {tile.origin[0] + past, tile.origin[1] + past, tile.origin[2] + past}};
    const IndexBox blocks = blocks_of(box);
    std::vector<Index3> inside;
    const auto first = std::partition_point(stored.begin(), stored.end(),
                                            [&](const Index3& b) { return b[2] < blocks.lo[2]; });
    for (auto at = first; at != stored.end() && (*at)[2] <= blocks.hi[2]; ++at) {
      if (blocks.contains(*at)) inside.push_back(*at);
    }
    if (inside.empty()) return tiles_.push_back(tile);
    if (tile.size == kBlockSize) return;
    const std::int32_t parts = tile.size / kBlockSize % 2 == 0 ? 2 : tile.size / kBlockSize;
    Tile part = tile;
    part.size = tile.size / parts;
    for (std::int32_t n = 0; n < parts * parts * parts; ++n) {
      part.origin = {tile.origin[0] + n % parts * part.size,
                     tile.origin[1] + n / parts % parts * part.size,
                     tile.origin[2] + n / parts / parts * part.size};
      add_tile(part, inside);
    }
  }

  const EditedSamples& samples_;
  EditedMaterials materials_;
  Volume volume_;
  std::vector<Index3> origins_;
  std::vector<std::size_t> sources_;  // the input's leaf, or kStored
  std::vector<Tile> tiles_;
};

}  // namespace

std::unique_ptr<LeafReader> make_leaf_reader(const World& world, const Volume& volume) {
  return std::make_unique<EditedLeaves>(world, volume);
}

}  // namespace mc::edit
