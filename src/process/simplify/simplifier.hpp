// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "process/simplify/collapse_mesh.hpp"
#include "process/simplify/collapse_queue.hpp"
#include "process/simplify/quadric.hpp"

namespace mc::process {

/// When to stop.
struct CollapseLimits {
  std::size_t max_collapses = 0;
  double min_triangles = 0;  ///< as many as are nearest to this remain
  double max_error = 0;      ///< of a collapse, in cells
};

/// Collapses the edges of one mesh, the cheapest first. Costs are evaluated anew only for vertices
/// next to a collapse.
class Simplifier {
 public:
  explicit Simplifier(CollapseMesh mesh);

  void run(const CollapseLimits& limits);
  [[nodiscard]] CollapseMesh& mesh() { return mesh_; }
  /// Vertices that may collapse, at the start.
  [[nodiscard]] std::size_t n_free() const { return n_free_; }
  /// Whether a vertex is gone, and the one that it was collapsed onto in the end.
  [[nodiscard]] bool is_gone(std::uint32_t vertex) const { return moved_to_[vertex] != vertex; }
  std::uint32_t end_of(std::uint32_t vertex);

 private:
  /// The neighbour that a vertex collapses onto. Of equal costs, the lower number is the better.
  struct Choice {
    float cost = std::numeric_limits<float>::infinity();
    std::uint32_t onto = CollapseQueue::kNone;

    bool operator<(const Choice& other) const {
      return cost < other.cost || (cost == other.cost && onto < other.onto);
    }
  };
  /// Before all others.
  static constexpr Choice kBest{-1, 0};

  /// What the cost of a collapse onto a vertex depends on.
  struct Place {
    Vec3 at{};
    double error = 0;   ///< of the vertex's quadric there
    double weight = 0;  ///< of the quadric
  };

  void add_triangles();
  void set_place(std::uint32_t vertex);
  [[nodiscard]] float cost(std::uint32_t from, std::uint32_t onto) const;
  void choose(std::uint32_t vertex, const Choice& worse_than);
  void reconsider(std::uint32_t vertex, std::uint32_t gone, std::uint32_t changed);
  void collapse(std::uint32_t a, std::uint32_t b);

  CollapseMesh mesh_;
  std::vector<Quadric> quadrics_;
  std::vector<Place> places_;
  std::vector<Choice> choices_;
  std::vector<std::uint32_t> moved_to_;
  std::vector<std::uint32_t> ring_;  ///< scratch
  CollapseQueue queue_;
  std::size_t n_free_ = 0;
  double max_square_ = 0;  ///< of the error
};

/// Bytes that a Simplifier takes for each vertex and triangle of its mesh.
inline constexpr std::uint32_t kSimplifierVertexBytes =
    sizeof(Vec3) + 3 * sizeof(float) + 3 * sizeof(std::uint32_t) + 1 + sizeof(Quadric) +
    sizeof(Vec3) + 2 * sizeof(double) + 2 * sizeof(std::uint32_t) + sizeof(std::uint32_t) + 10;
inline constexpr std::uint32_t kSimplifierTriangleBytes = 8 * sizeof(std::uint32_t);

}  // namespace mc::process
