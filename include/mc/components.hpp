// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

// The components of an isosurface, and which of them remain.
//
// A component is one connected solid with all of its surface: its outer shell, and a shell for each
// cavity in it. Solid samples are connected as the mesh connects them, which follows from the rule
// for cell faces (mc/extract.hpp): above samples along lattice edges only, to 6 neighbours; below
// samples also across the diagonal of a cell's face, to 18. So a solid is connected by 6 neighbours
// with Inside::above and by 18 with Inside::below.

namespace mc {

/// Which components remain.
struct KeepRule {
  enum class By : std::uint8_t {
    count,   ///< the `n` components of the largest volume
    volume,  ///< those of at least `min_size` cubic world units
    area,    ///< those of at least `min_size` square world units
  };
  By by = By::count;
  std::uint64_t n = 1;
  double min_size = 0;

  bool operator==(const KeepRule&) const = default;
};

/// Components found and kept.
struct ComponentCounts {
  std::uint64_t found = 0;
  std::uint64_t kept = 0;

  [[nodiscard]] std::uint64_t dropped() const { return found - kept; }
  bool operator==(const ComponentCounts&) const = default;
};

/// Applies a rule to the components' sizes: volumes, or areas if the rule is by area. Of sizes that
/// agree in their first 20 bits, about one part in a million, the earlier component counts as the
/// larger one, so that rounding does not decide between components of the same shape.
/// Returns  1 for each component that remains, else 0.
/// Cost     O(n) time, 8 bytes a component.
std::vector<std::uint8_t> select_components(std::span<const double> sizes, const KeepRule& rule);

struct Mesh;  // mc/mesh.hpp

/// The components of a mesh in memory.
struct MeshComponents {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::vector<std::uint32_t> of_vertex;  ///< of each vertex; kNone if no triangle uses it
  std::vector<double> volumes;           ///< of each component, cubic world units
  std::vector<double> areas;             ///< of each component, square world units
};

/// Finds the components of a mesh. They are those that extraction finds in the samples: shells are
/// connected by their vertices, and a closed shell of negative volume is a cavity of the component
/// whose shell is first hit from it. In a mesh with a border a shell with a border is a component
/// of its own, and counts with the volume that a fan from the middle of its border to the border
/// encloses: a mesh does not say where the data ended.
/// Returns  components in the order of their first vertices.
/// Errors   precondition: every id names a vertex (asserted).
/// Cost     O(n log n) time, about 30 bytes a vertex and 30 a triangle.
MeshComponents find_components(const Mesh& mesh);

/// Drops the components that a rule does not keep, and vertices that no triangle uses. What remains
/// keeps its order.
ComponentCounts keep_components(Mesh& mesh, const KeepRule& rule);

}  // namespace mc
