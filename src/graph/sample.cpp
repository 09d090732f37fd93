// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <utility>

#include "graph/machine.hpp"
#include "graph/surface_sampler.hpp"
#include "mc/graph.hpp"

// Runs a program over a lattice: plane by plane, each in columns of kPiece samples, so that all
// registers stay in the cache and what does not depend on y is computed once for all rows.

namespace mc {

GraphField::GraphField(std::unique_ptr<const graph::Program> program)
    : program_(std::move(program)) {}
GraphField::~GraphField() = default;
GraphField::GraphField(GraphField&& other) noexcept = default;
GraphField& GraphField::operator=(GraphField&& other) noexcept = default;

void GraphField::sample(const Vec3& origin, const Vec3& spacing, const Index3& first,
                        View3<float> out) const {
  constexpr std::int64_t kMost = graph::kPiece;
  graph::Machine machine(*program_);
  const auto at = [&](std::size_t axis, std::int64_t index) {
    return graph::world_at(origin[axis], spacing[axis], first[axis] + index);
  };
  for (std::int32_t k = 0; k < out.dims[2]; ++k) {
    std::fill_n(machine.z(), kMost, at(2, k));
    float* plane = out.data + k * out.plane_stride;
    for (std::int64_t i = 0; i < out.dims[0]; i += kMost) {
      const std::int64_t n = std::min(out.dims[0] - i, kMost);
      for (std::int64_t s = 0; s < n; ++s) machine.x()[s] = at(0, i + s);
      machine.set_count(static_cast<std::size_t>(n));
      machine.run(program_->flat());
      for (std::int32_t j = 0; j < out.dims[1]; ++j) {
        machine.set_y(at(1, j));
        machine.run(program_->deep());
        std::copy_n(machine.row(program_->result), n, plane + j * out.row_stride + i);
      }
    }
  }
}

void GraphField::sample_places(std::span<const std::array<float, 3>> places,
                               std::span<float> out) const {
  graph::Machine machine(*program_);
  for (std::size_t first = 0; first < places.size(); first += graph::kPiece) {
    const std::size_t n = std::min(places.size() - first, graph::kPiece);
    float* const y = machine.y();
    for (std::size_t s = 0; s < n; ++s) {
      const std::array<float, 3>& at = places[first + s];
      machine.x()[s] = at[0], y[s] = at[1], machine.z()[s] = at[2];
    }
    machine.set_count(n);
    machine.run(program_->code);
    std::copy_n(machine.row(program_->result), n, out.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

void GraphField::sample_surface(const Vec3& origin, const Vec3& spacing, const Index3& first,
                                const SurfaceQuery& query, View3<float> out, SideMap& sides) const {
  IndexBox box = query.region;
  for (std::size_t a = 0; a < 3; ++a) {
    box.lo[a] = std::max(box.lo[a], first[a]);
    box.hi[a] = std::min(box.hi[a], first[a] + (out.dims[a] - 1));
    assert(box.lo[a] <= box.hi[a]);
  }
  graph::SurfaceSampler(*program_, {origin, spacing}, query, box, first, out, sides).run();
}

}  // namespace mc
