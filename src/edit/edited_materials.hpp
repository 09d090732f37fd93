// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "edit/world.hpp"
#include "mc/field.hpp"

namespace mc::edit {

/// The materials of a volume under edits: a place whose nearest sample was painted has that paint,
/// any other what the input says, or 0. Keeps a reference; edits must rest.
class EditedMaterials final : public AttributeReader {
 public:
  explicit EditedMaterials(const World& world);
  EditedMaterials(const EditedMaterials&) = delete;
  EditedMaterials& operator=(const EditedMaterials&) = delete;

  /// The attributes of the edited volume: these materials, unless nothing was painted and the input
  /// has none, then the input's other attributes.
  [[nodiscard]] AttributeReaders attributes() const {
    const bool has_any = input_ != nullptr || !world_.materials.blocks().empty();
    return AttributeReaders(all_).first(all_.size() - (has_any ? 0 : 1));
  }
  [[nodiscard]] const AttributeInfo& info() const override { return material_attribute(); }
  std::size_t values_at(std::span<const Vec3> places, std::byte* out) const override;

 private:
  [[nodiscard]] bool paint_at(const Vec3& place, std::uint16_t& out) const;

  const World& world_;
  const AttributeReader* input_;             // the input's materials, if it has any
  std::vector<const AttributeReader*> all_;  // the input's others, and this
};

}  // namespace mc::edit
