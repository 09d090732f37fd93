// SPDX-License-Identifier: MIT
#include "graph/surface_sampler.hpp"

#include <algorithm>
#include <cassert>

namespace mc::graph {

namespace {

/// Rows of the smallest parts, and planes of columns, which have kPiece places in all.
constexpr std::int32_t kRows = 4;
constexpr std::int32_t kMostPlanes = 16;

/// A run looks at samples up to one step from an end of a crossed edge, whose other end may lie one
/// step farther.
constexpr std::int32_t kReach = 2;

/// A part of the lattice with all that must lie on its side for it to be left out.
IndexBox with_surroundings(const IndexBox& part, const IndexBox& within) {
  return common_part(grown(part, kReach), within);
}

std::int32_t ceil_div(std::int64_t a, std::int64_t b) {
  return static_cast<std::int32_t>((a + b - 1) / b);
}

/// The end of the piece that begins at `lo` in [.., hi].
std::int32_t end_of(std::int32_t lo, std::int32_t size, std::int32_t hi) {
  return hi - lo < size ? hi : lo + size - 1;
}

}  // namespace

Interval WorldGrid::range(std::size_t axis, std::int64_t lo, std::int64_t hi) const {
  const float a = at(axis, lo);
  const float b = at(axis, hi);
  return {std::min(a, b), std::max(a, b)};
}

SurfaceSampler::SurfaceSampler(const Program& program, const WorldGrid& grid,
                               const SurfaceQuery& query, const IndexBox& box, const Index3& first,
                               const View3<float>& out, SideMap& sides)
    : program_(program),
      grid_(grid),
      query_(query),
      iso_(static_cast<float>(query.iso)),
      box_(box),
      first_(first),
      out_(out),
      sides_(sides),
      machine_(program),
      pruner_(program),
      bounds_(program.code.size()),
      code_(34) {}  // halves of 2^31 rows

void SurfaceSampler::run() {
  const std::int32_t n_blocks = ceil_div(box_.extent(2), kMostPlanes);
  const std::int32_t planes = ceil_div(box_.extent(2), n_blocks);
  const auto width = static_cast<std::int32_t>(kPiece) / planes;
  sides_.reset(box_, kRows, planes);
  for (std::int32_t k = box_.lo[2]; k <= box_.hi[2]; k += planes) {
    for (std::int64_t i = box_.lo[0]; i <= box_.hi[0]; i += width) {
      const auto i0 = static_cast<std::int32_t>(i);
      take_column({{i0, box_.lo[1], k},
                   {end_of(i0, width, box_.hi[0]), box_.hi[1], end_of(k, planes, box_.hi[2])}});
    }
  }
}

void SurfaceSampler::take_column(const IndexBox& column) {
  const Side side = bound(column, program_.code);
  if (side != Side::both) return leave_out(column, side == Side::above);
  std::vector<Instruction>& code = code_.front();
  pruner_.prune(program_.code, bounds_, code);
  const auto first_deep = std::partition_point(
      code.begin(), code.end(), [&](const Instruction& i) { return i.out < program_.n_flat; });
  const std::span<const Instruction> deep(first_deep, code.end());
  find_edges(deep);
  run_flat(column, {code.begin(), first_deep});
  divide(column, deep, 1);
}

/// Bounds the values of `code` over a part and its surroundings, and so the field.
SurfaceSampler::Side SurfaceSampler::bound(const IndexBox& part,
                                           std::span<const Instruction> code) {
  const IndexBox all = with_surroundings(part, box_);
  WorldBox world;
  for (std::size_t a = 0; a < 3; ++a) world[a] = grid_.range(a, all.lo[a], all.hi[a]);
  for (const Instruction& i : code) {
    const auto in = [&](std::size_t n) { return bounds_[i.in[n]]; };
    bounds_[i.out] = bounds_of(i, world, in(0), in(1), in(2));
  }
  const Interval field = bounds_[program_.result];
  return field.lo >= iso_ ? Side::above : field.hi < iso_ ? Side::below : Side::both;
}

/// The flat values that are looked at for every row.
void SurfaceSampler::find_edges(std::span<const Instruction> deep) {
  edges_.clear();
  if (program_.result < program_.n_flat) edges_.push_back(program_.result);
  for (const Instruction& instruction : deep) {
    for (std::size_t n = 0; n < instruction.n_in; ++n) {
      if (instruction.in[n] < program_.n_flat) edges_.push_back(instruction.in[n]);
    }
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  ranges_.assign(edges_.size(), {});
}

void SurfaceSampler::run_places(std::size_t n, std::span<const Instruction> flat) {
  machine_.set_count(n);
  machine_.run(flat);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    ranges_[e].include(machine_.row(edges_[e]), n);
  }
}

/// Computes what does not depend on y, first around the column, then in it: that stays.
void SurfaceSampler::run_flat(const IndexBox& column, std::span<const Instruction> flat) {
  const IndexBox around = with_surroundings(column, box_);
  for (const bool inside : {false, true}) {
    std::size_t n = 0;
    for (std::int32_t k = around.lo[2]; k <= around.hi[2]; ++k) {
      for (std::int32_t i = around.lo[0]; i <= around.hi[0]; ++i) {
        if (column.contains(Index3{i, column.lo[1], k}) != inside) continue;
        machine_.x()[n] = grid_.at(0, i);
        machine_.z()[n] = grid_.at(2, k);
        if (++n == kPiece && !inside) {
          run_places(n, flat);
          n = 0;
        }
      }
    }
    if (n > 0) run_places(n, flat);
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) bounds_[edges_[e]] = ranges_[e].interval();
}

void SurfaceSampler::divide(const IndexBox& part, std::span<const Instruction> code,
                            std::size_t depth) {
  const Side side = bound(part, code);
  if (side != Side::both) return leave_out(part, side == Side::above);
  std::vector<Instruction>& shorter = code_[depth];
  pruner_.prune(code, bounds_, shorter);
  const std::int32_t n_blocks = ceil_div(part.extent(1), kRows);
  if (n_blocks == 1) return compute(part, shorter);
  IndexBox lower = part;
  IndexBox upper = part;
  upper.lo[1] = part.lo[1] + (n_blocks / 2) * kRows;
  lower.hi[1] = upper.lo[1] - 1;
  divide(lower, shorter, depth + 1);
  divide(upper, shorter, depth + 1);
}

float* SurfaceSampler::sample_at(std::int32_t i, std::int32_t j, std::int32_t k) const {
  return out_.data + (k - first_[2]) * out_.plane_stride + (j - first_[1]) * out_.row_stride +
         (i - first_[0]);
}

void SurfaceSampler::compute(const IndexBox& part, std::span<const Instruction> code) {
  const std::int64_t width = part.extent(0);
  for (std::int32_t j = part.lo[1]; j <= part.hi[1]; ++j) {
    machine_.set_y(grid_.at(1, j));
    machine_.run(code);
    const float* row = machine_.row(program_.result);
    for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k, row += width) {
      std::copy_n(row, width, sample_at(part.lo[0], j, k));
    }
  }
}

void SurfaceSampler::leave_out(const IndexBox& part, bool above) {
  sides_.leave_out(part, above);
  if (query_.capped) write_faces(part, above ? __builtin_inff() : -__builtin_inff());
}

/// Writes the samples of a part that lie on faces of the region.
void SurfaceSampler::write_faces(const IndexBox& part, float value) {
  const auto on_face = [&](std::size_t axis, std::int32_t at) {
    return at == query_.region.lo[axis] || at == query_.region.hi[axis];
  };
  bool touches = false;
  for (std::size_t a = 0; a < 3; ++a) {
    touches = touches || on_face(a, part.lo[a]) || on_face(a, part.hi[a]);
  }
  if (!touches) return;
  for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k) {
    for (std::int32_t j = part.lo[1]; j <= part.hi[1]; ++j) {
      if (on_face(1, j) || on_face(2, k)) {
        std::fill_n(sample_at(part.lo[0], j, k), part.extent(0), value);
        continue;
      }
      for (const std::int32_t i : {part.lo[0], part.hi[0]}) {
        if (on_face(0, i)) *sample_at(i, j, k) = value;
      }
    }
  }
}

}  // namespace mc::graph
