// SPDX-License-Identifier: MIT
#pragma once

#include "mc/process.hpp"

/// Moves each vertex halfway to the mean of its neighbours, once. An edge of two triangles counts
/// its vertices twice, so that those on a border weigh less. There are no normals afterwards.
class Smooth final : public mc::MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "smooth"; }
  [[nodiscard]] std::int32_t reach() const override { return 1; }
  [[nodiscard]] mc::StageBytes bytes() const override { return {0, 4 * sizeof(double), 0}; }
  void describe(mc::MeshObject& object) const override { object.has_normals = false; }
  void apply(mc::MeshWindow& window) const override;
};
