// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "mc/mesh.hpp"
#include "pipe/tasks.hpp"
#include "process/figures.hpp"

namespace mc::pipe {

/// Adds up what tasks found, in their order.
class TotalsSum {
 public:
  explicit TotalsSum(bool measured) {
    if (measured) {
      totals_.area = 0;
      totals_.volume = 0;
    }
  }
  void add(const TaskTotals& task) {
    totals_.n_vertices += task.n_vertices;
    totals_.n_triangles += task.n_triangles;
    totals_.n_boundary_edges += task.n_boundary_edges;
    totals_.bounds.include(task.bounds);
    totals_.n_asked += task.n_asked;
    totals_.n_skipped += task.n_skipped;
    add_each(totals_.n_clamped, task.n_clamped);
    for (const LayerSum& layer : task.layers) {
      *totals_.area += layer.area;
      *totals_.volume += layer.volume;
    }
    if (task.sums) {
      if (!sums_) sums_.emplace();
      sums_->add(*task.sums);
    }
  }
  [[nodiscard]] MeshTotals totals(const Vec3& origin) const {
    MeshTotals out = totals_;
    if (sums_) {
      out.area = sums_->area.value();
      out.volume = sums_->volume.value();
    }
    if (out.n_boundary_edges != 0) {
      out.volume.reset();  // an open surface encloses none
    }
    if (!out.bounds.empty()) {
      for (std::size_t a = 0; a < 3; ++a) {
        out.bounds.lo[a] += origin[a];
        out.bounds.hi[a] += origin[a];
      }
    }
    return out;
  }

 private:
  MeshTotals totals_;
  std::optional<process::SurfaceSums> sums_;
};

}  // namespace mc::pipe
