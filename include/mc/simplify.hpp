// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "mc/process.hpp"

// Simplification: fewer triangles for nearly the same surface.

namespace mc {

/// How far to simplify.
struct SimplifyGoal {
  enum class By : std::uint8_t {
    ratio,  ///< to `ratio` of the triangles
    count,  ///< to about `count` triangles
    error,  ///< as long as the quadric error of a step is at most `error` cells
  };
  By by = By::ratio;
  double ratio = 1;  ///< in [0, 1]
  std::uint64_t count = 0;
  double error = 0;  ///< root of the mean square distance to the planes of the triangles that a
                     ///< vertex stands for, in cells (cube roots of their volume)

  bool operator==(const SimplifyGoal&) const = default;
};

/// Collapses edges onto one of their vertices, those of the least quadric error first, so the
/// vertices that remain keep their positions and normals. Each cube is simplified as far as the
/// goal says, whatever the others are like.
/// Mesh     an edge collapses only where the mesh stays manifold and oriented, keeps its components
///          and Euler number, has no degenerate or duplicate triangle that it did not have before,
///          and no triangle turns by more than 75 degrees or against the normal of a corner.
///          Vertices on a border stay. Where this forbids it, the goal is not reached.
/// Distances of the vertices before each pass from the triangles near the vertex that they were
///          collapsed onto, in practice the nearest ones of all.
/// Source   Garland and Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH
///          1997. Differs: vertices do not move; equal costs within 6 % count as equal, and the one
///          that has waited longest comes first.
/// Cost     O(triangles) time: about a microsecond a triangle on one core.
class Simplify : public CubeStage {
 public:
  explicit Simplify(const SimplifyGoal& goal) : goal_(goal) {}
  [[nodiscard]] std::string_view name() const override { return "simplify"; }
  [[nodiscard]] StageBytes bytes() const override;
  [[nodiscard]] bool measures() const override { return true; }
  void apply(MeshCube& cube) const override;

 private:
  SimplifyGoal goal_;
};

}  // namespace mc
