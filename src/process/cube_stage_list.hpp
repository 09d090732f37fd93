// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "mc/process.hpp"

namespace mc::process {

/// The cube stages of a run, taken together.
class CubeStageList {
 public:
  /// Keeps references to the stages.
  explicit CubeStageList(CubeStages stages) : stages_(stages) {}

  /// Errors   usage: a number of cells that is odd, less than 2, or not that of the first stage.
  void check() const;
  [[nodiscard]] bool empty() const { return stages_.empty(); }
  /// Precondition: not empty.
  [[nodiscard]] std::int32_t n_cells() const { return stages_.front()->n_cells(); }
  [[nodiscard]] bool measure() const;
  [[nodiscard]] std::uint64_t held_bytes() const;
  /// Scratch of the stage that takes most.
  [[nodiscard]] std::uint64_t vertex_bytes() const;
  [[nodiscard]] std::uint64_t triangle_bytes() const;
  /// Whether vertices have normals at any time, if they have any before or not.
  [[nodiscard]] bool with_normals(bool before) const;
  void describe(MeshObject& object) const;
  void apply(MeshCube& cube) const;
  /// "a, b"
  [[nodiscard]] std::string names() const;

 private:
  CubeStages stages_;
};

}  // namespace mc::process
