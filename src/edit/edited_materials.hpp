// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "edit/world.hpp"
#include "mc/field.hpp"

namespace mc::edit {

/// The materials of a volume under edits: a place whose nearest sample was painted has that paint,
/// any other what the input says, or 0. Keeps a reference; edits must rest.
class EditedMaterials final : public MaterialReader {
 public:
  explicit EditedMaterials(const World& world);

  /// As a reader hands it on: null where nothing was painted and the input has no materials.
  [[nodiscard]] const MaterialReader* port() const {
    return input_ != nullptr || !world_.materials.blocks().empty() ? this : nullptr;
  }
  std::size_t materials_at(std::span<const Vec3> places,
                           std::span<std::uint16_t> out) const override;

 private:
  [[nodiscard]] bool paint_at(const Vec3& place, std::uint16_t& out) const;

  const World& world_;
  const MaterialReader* input_;
};

}  // namespace mc::edit
