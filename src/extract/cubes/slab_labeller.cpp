// SPDX-License-Identifier: MIT
#include "extract/cubes/slab_labeller.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>

#include "base/disjoint_sets.hpp"
#include "extract/cubes/slab_sampler.hpp"

namespace mc::extraction {

namespace {

double n_cells_of(const IndexBox& box) {
  double n = 1;
  for (int axis = 0; axis < 3; ++axis) n *= static_cast<double>(box.extent(axis));
  return n;
}

/// Finds the run of a row that holds a sample, for samples that come in ascending order.
class RunCursor {
 public:
  RunCursor() = default;
  RunCursor(std::span<const Run> row, std::uint32_t first) : row_(row), first_(first) {}
  /// Precondition: the sample is solid.
  std::uint32_t find(std::int32_t i) {
    while (row_[at_].last < i) ++at_;
    assert(row_[at_].first <= i);
    return first_ + at_;
  }

 private:
  std::span<const Run> row_;
  std::uint32_t first_ = 0;  ///< number of the row's first run in the slab
  std::uint32_t at_ = 0;
};

}  // namespace

ExtractOptions labelling_options(const ExtractOptions& options) {
  ExtractOptions out = options;
  out.normals = Normals::none;
  out.part.reset();
  out.selection = nullptr;
  if (out.border == Border::open) out.border = Border::closed;
  return out;
}

SlabLabeller::SlabLabeller(const Volume& volume, const Affine& to_world,
                           const ExtractOptions& options, SizeKind kind)
    : grid_(volume, to_world, labelling_options(options)),
      border_(options.border),
      unit_(kind, grid_.placement.map, grid_.placement.map(grid_.apex),
            n_cells_of(grid_.classifier.whole())) {}

std::uint64_t SlabLabeller::max_bytes(std::int32_t n_layers) const {
  const std::uint64_t n_planes = static_cast<std::uint64_t>(n_layers) + 1;
  const std::uint64_t most_runs =
      (grid_.classifier.row_samples() + 1) / 2 * grid_.classifier.n_rows();
  // A run, its root, the root's number, sum and size: every run may be a root.
  const std::uint64_t run_bytes =
      sizeof(Run) + 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t) + sizeof(RunSize);
  return n_planes * (grid_.classifier.plane_bytes() + most_runs * run_bytes);
}

/// Joins the runs of row j of a plane to those that touch them in rows before: of the same plane,
/// and of the plane below.
void SlabLabeller::join_rows(std::size_t plane, std::size_t j, SlabLabels& labels) const {
  const auto join = [&](std::size_t other, std::size_t other_j, std::int32_t reach) {
    const std::uint32_t a = labels.plane_start[plane] + runs_[plane].row_start[j];
    const std::uint32_t b = labels.plane_start[other] + runs_[other].row_start[other_j];
    for_each_touching(runs_[plane].row(j), runs_[other].row(other_j), reach,
                      [&](std::size_t n, std::size_t m) {
                        base::unite_sets(labels.root, a + static_cast<std::uint32_t>(n),
                                         b + static_cast<std::uint32_t>(m));
                      });
  };
  const bool diagonal = grid_.options.inside == Inside::below;  // 18 neighbours, else 6
  if (j > 0) join(plane, j - 1, diagonal ? 1 : 0);
  if (plane == 0) return;
  join(plane - 1, j, diagonal ? 1 : 0);
  if (!diagonal) return;
  if (j > 0) join(plane - 1, j - 1, 0);
  if (j + 1 < grid_.classifier.n_rows()) join(plane - 1, j + 1, 0);
}

/// Adds the sizes of the triangles in one row of cells to their components.
template <class Vertices>
void SlabLabeller::measure_row(const Vertices& vertices, std::int32_t layer, std::size_t p,
                               std::size_t j, const SlabLabels& labels) {
  const std::array<BitPlane, 2> planes{grid_.classifier.view(bits_[p]),
                                       grid_.classifier.view(bits_[p + 1])};
  std::array<RunCursor, 4> cursors;
  for (std::size_t n = 0; n < 4; ++n) {
    const std::size_t plane = p + n / 2, row = j + n % 2;
    cursors[n] = {runs_[plane].row(row), labels.plane_start[plane] + runs_[plane].row_start[row]};
  }
  const Index3 first = grid_.classifier.first_of(layer);
  const IndexBox& box = grid_.classifier.box();
  const std::int32_t y = first[1] + static_cast<std::int32_t>(j);
  const bool outer_row =
      y < box.lo[1] || y >= box.hi[1] || first[2] < box.lo[2] || first[2] >= box.hi[2];
  const bool skips_caps = unit_.kind() == SizeKind::area && border_ == Border::open;
  for (std::size_t w = 0; 64 * w < planes[0].n_samples; ++w) {
    const CellWords words(planes[0], planes[1], j, w);
    for_each_bit(words.active() & planes[0].cells[w], [&](int bit) {
      const Index3 cell{first[0] + index_in_row(w, bit), y, first[2]};
      if (skips_caps && (outer_row || cell[0] < box.lo[0] || cell[0] >= box.hi[0])) return;
      for_each_triangle_size(vertices, grid_.placement, grid_.options.precision, unit_,
                             grid_.options.inside, cell, words.case_at(bit),
                             [&](Corner corner, std::int64_t size) {
                               const std::int32_t i = index_in_row(w, bit) + corner.along(kAxes[0]);
                               const std::uint32_t run = cursors[corner / 2].find(i);
                               sums_[number_[labels.root[run]]] += static_cast<std::uint64_t>(size);
                             });
    });
  }
}

template <class T, bool Swap>
void SlabLabeller::measure(const Slab& slab, std::int32_t l0, SlabLabels& out) {
  const VertexRules<T> rules(grid_.options, grid_.to_world, grid_.classifier.threshold());
  const SlabSampler<T, Swap> sampler(slab, grid_.classifier.box());
  const EdgeVertices<T, SlabSampler<T, Swap>> vertices(rules, sampler);
  for (std::size_t p = 0; p + 1 < out.n_planes(); ++p) {
    for (std::size_t j = 0; j + 1 < grid_.classifier.n_rows(); ++j) {
      measure_row(vertices, l0 + static_cast<std::int32_t>(p), p, j, out);
    }
  }
}

void SlabLabeller::label(const Slab& slab, std::int32_t l0, std::int32_t l1, SlabLabels& out) {
  const std::size_t n_planes = static_cast<std::size_t>(l1 - l0) + 1;
  if (bits_.size() < n_planes) {
    bits_.resize(n_planes);
    for (PlaneBits& plane : bits_) grid_.classifier.shape(plane);
    runs_.resize(n_planes);
  }
  out.plane_start.assign(1, 0);
  out.root.clear();
  out.sizes.clear();
  for (std::size_t p = 0; p < n_planes; ++p) {
    grid_.classifier.classify(slab, l0 + static_cast<std::int32_t>(p), 0, grid_.classifier.n_rows(),
                              bits_[p]);
    runs_[p].list(grid_.classifier.view(bits_[p]), grid_.options.inside);
    for (std::size_t n = 0; n < runs_[p].runs.size(); ++n) {
      out.root.push_back(static_cast<std::uint32_t>(out.root.size()));
    }
    out.plane_start.push_back(static_cast<std::uint32_t>(out.root.size()));
    for (std::size_t j = 0; j < grid_.classifier.n_rows(); ++j) join_rows(p, j, out);
  }
  number_.resize(out.root.size());
  std::uint32_t n_roots = 0;
  for (std::uint32_t run = 0; run < out.root.size(); ++run) {
    out.root[run] = base::find_set(out.root, run);
    if (out.root[run] == run) {
      number_[run] = n_roots++;
      out.sizes.push_back({run, 0});
    }
  }
  sums_.assign(n_roots, 0);
  const Threshold& threshold = grid_.classifier.threshold();
  field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    threshold.swap ? measure<T, true>(slab, l0, out) : measure<T, false>(slab, l0, out);
  });
  for (std::uint32_t n = 0; n < n_roots; ++n) out.sizes[n].size = sums_[n];
}

}  // namespace mc::extraction
