// SPDX-License-Identifier: MIT
#include "edit/edited_materials.hpp"

#include <cmath>
#include <cstring>
#include <vector>

namespace mc::edit {

EditedMaterials::EditedMaterials(const World& world)
    : world_(world),
      input_(find_attribute(world.samples.input().attributes(), material_attribute())) {
  for (const AttributeReader* reader : world.samples.input().attributes()) {
    if (reader != input_) all_.push_back(reader);
  }
  all_.push_back(this);
}

bool EditedMaterials::paint_at(const Vec3& place, std::uint16_t& out) const {
  Index3 nearest{};
  for (std::size_t a = 0; a < 3; ++a) {
    nearest[a] = static_cast<std::int32_t>(std::floor(place[a] + 0.5));
  }
  const Block* block = world_.materials.find(block_of(nearest));
  if (block == nullptr) return false;
  constexpr std::int32_t kWithin = kBlockSize - 1;
  const auto i = static_cast<std::size_t>(nearest[0] & kWithin);
  const auto j = static_cast<std::size_t>(nearest[1] & kWithin);
  const auto k = static_cast<std::size_t>(nearest[2] & kWithin);
  if ((block->active[k] >> (kBlockSize * j + i) & 1U) == 0) return false;
  std::memcpy(&out, block->samples() + ((k * kBlockSize + j) * kBlockSize + i) * sizeof out,
              sizeof out);
  return true;
}

std::size_t EditedMaterials::values_at(std::span<const Vec3> places, std::byte* values) const {
  const std::span out(reinterpret_cast<std::uint16_t*>(values), places.size());
  std::vector<std::size_t> bare;
  std::vector<Vec3> bare_places;
  for (std::size_t n = 0; n < places.size(); ++n) {
    out[n] = 0;
    if (paint_at(places[n], out[n]) || input_ == nullptr) continue;
    bare.push_back(n);
    bare_places.push_back(places[n]);
  }
  if (bare.empty() || input_ == nullptr) return 0;
  std::vector<std::uint16_t> found(bare.size());
  const std::size_t n_clamped =
      input_->values_at(bare_places, reinterpret_cast<std::byte*>(found.data()));
  for (std::size_t n = 0; n < bare.size(); ++n) out[bare[n]] = found[n];
  return n_clamped;
}

}  // namespace mc::edit
