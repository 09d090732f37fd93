// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <memory>

#include "extract/bits/row_kernels.hpp"
#include "extract/cubes/case_table.hpp"
#include "extract/cubes/triangle_kernels.hpp"
#include "kernel_bench.hpp"

// One layer of cells of a gyroid: numbering and listing its crossed edges, counting and writing its
// triangles.

namespace mc::bench {

namespace {

using extraction::BitPlane;
using extraction::CellLayer;
using extraction::EdgeList;
using extraction::kCases;
using extraction::PlaneIds;
using extraction::RowIds;

constexpr std::size_t kRows = kSide;

struct Bits {
  std::vector<std::uint64_t> words, cells;
  std::vector<std::uint32_t> i_ids = std::vector<std::uint32_t>(kRows);
  std::vector<std::uint32_t> j_ids = std::vector<std::uint32_t>(kRows);

  explicit Bits(std::int32_t k) {
    const std::size_t n_words = extraction::padded_words(kSide);
    words.resize(n_words * kRows + 1);
    cells.resize(n_words + 1);
    const std::vector<double> plane = gyroid_plane(k);
    for (std::size_t n = 0; n < plane.size(); ++n) {
      const std::size_t i = n % kSide;
      words[n / kSide * n_words + i / 64] |= std::uint64_t{plane[n] >= 0} << i % 64;
    }
    for (std::size_t w = 0; w < kSide / 64; ++w) cells[w] = extraction::cell_mask(kSide, w);
  }
  [[nodiscard]] BitPlane view() const {
    return {words.data(), cells.data(), extraction::padded_words(kSide), kSide, kRows};
  }
  PlaneIds ids() { return {i_ids.data(), j_ids.data()}; }
  RowIds row_ids() const { return {i_ids.data(), j_ids.data()}; }
  [[nodiscard]] bool at(std::size_t i, std::size_t j) const {
    return (view().row(j)[i / 64] >> i % 64 & 1) != 0;
  }
};

/// The layer, with what the kernels make of it and what a plain walk over its cells makes.
struct Layer {
  Bits lower{kSide / 3}, upper{kSide / 3 + 1};
  std::vector<std::uint32_t> k_ids = std::vector<std::uint32_t>(kRows);
  std::vector<std::uint32_t> plain_lower, plain_upper, plain_k;  ///< ids of edges, by sample
  /// Edges: i, j and axis.
  std::array<std::vector<std::int32_t>, 3> listed;
  std::array<std::vector<std::int32_t>, 3> plain_list;
  std::vector<std::uint32_t> triangles, wanted;
  std::uint32_t n_plane = 0, n_listed = 0;
  std::size_t n_ids = 0;
  std::uint64_t n_counted = 0;

  Layer() {
    // i- and j-edges of the lower plane, then k-edges, then those of the upper plane.
    std::uint32_t next = 0;
    plain_lower = number(lower, next);
    n_wanted_plane = next;
    plain_k.resize(kSide * kRows);
    for (std::size_t n = 0; n < plain_k.size(); ++n) {
      plain_k[n] = next;
      if (lower.at(n % kSide, n / kSide) != upper.at(n % kSide, n / kSide)) ++next;
    }
    plain_upper = number(upper, next);
    for (std::size_t j = 0; j + 1 < kRows; ++j) {
      for (std::size_t i = 0; i + 1 < kSide; ++i) add_cell(i, j);
    }
    list_plainly();
    for (auto& column : listed) column.resize(3 * kSide * kRows);
    triangles.resize(15 * kSide * kRows + extraction::kEmitSlack);
    std::uint32_t id = extraction::number_plane(lower.view(), 0, lower.ids());
    id = extraction::number_between(lower.view(), upper.view(), id, k_ids.data());
    extraction::number_plane(upper.view(), id, upper.ids());
  }

  /// Ids of a plane's i-edges at [2n] and its j-edges at [2n + 1], by their lower sample n.
  static std::vector<std::uint32_t> number(const Bits& bits, std::uint32_t& next) {
    std::vector<std::uint32_t> ids(2 * kSide * kRows);
    for (std::size_t j = 0; j < kRows; ++j) {
      for (std::size_t i = 0; i < kSide; ++i) {
        ids[2 * (j * kSide + i)] = next;
        if (i + 1 < kSide && bits.at(i, j) != bits.at(i + 1, j)) ++next;
      }
      for (std::size_t i = 0; i < kSide; ++i) {
        ids[2 * (j * kSide + i) + 1] = next;
        if (j + 1 < kRows && bits.at(i, j) != bits.at(i, j + 1)) ++next;
      }
    }
    return ids;
  }

  void list_plainly() {
    const auto add = [this](std::size_t i, std::size_t j, int axis) {
      plain_list[0].push_back(static_cast<std::int32_t>(i));
      plain_list[1].push_back(static_cast<std::int32_t>(j));
      plain_list[2].push_back(axis);
    };
    for (std::size_t j = 0; j < kRows; ++j) {
      for (std::size_t i = 0; i + 1 < kSide; ++i) {
        if (lower.at(i, j) != lower.at(i + 1, j)) add(i, j, 0);
      }
      for (std::size_t i = 0; i < kSide && j + 1 < kRows; ++i) {
        if (lower.at(i, j) != lower.at(i, j + 1)) add(i, j, 1);
      }
    }
  }

  void add_cell(std::size_t i, std::size_t j) {
    std::size_t which = 0;
    for (std::size_t c = 0; c < 8; ++c) {
      const Bits& plane = (c & 4) == 0 ? lower : upper;
      which |= std::size_t{plane.at(i + (c & 1), j + (c >> 1 & 1))} << c;
    }
    for (std::size_t e = 0; e < 3U * kCases[which].n_triangles; ++e) {
      const extraction::CellEdge edge = kCases[which].edges[e];
      const std::size_t axis = edge.axis();
      const std::size_t c = edge.lower();
      const std::size_t n = (j + (c >> 1 & 1)) * kSide + i + (c & 1);
      if (axis == 2) {
        wanted.push_back(plain_k[n]);
      } else {
        wanted.push_back(((c & 4) == 0 ? plain_lower : plain_upper)[2 * n + axis]);
      }
    }
  }

  void number_lower() { n_plane = extraction::number_plane(lower.view(), 0, lower.ids()); }
  void list_lower() {
    n_listed = 0;
    EdgeList list{{}, listed[0].data(), listed[1].data(), listed[2].data(), listed[0].size(), 0};
    extraction::list_plane(lower.view(), 0, kRows, n_listed, lower.ids(), list);
  }
  void count() { n_counted = extraction::count_triangles(lower.view(), upper.view()); }
  void emit() {
    const CellLayer cells{lower.view(), upper.view(), lower.row_ids(), upper.row_ids(),
                          k_ids.data()};
    n_ids = extraction::emit_triangles(cells, 0, kRows - 1, false, triangles.data());
  }

  [[nodiscard]] bool numbered_right() const {
    for (std::size_t j = 0; j < kRows; ++j) {
      if (lower.i_ids[j] != plain_lower[2 * j * kSide]) return false;
      if (lower.j_ids[j] != plain_lower[2 * j * kSide + 1]) return false;
    }
    return n_plane == n_wanted_plane;
  }
  [[nodiscard]] bool listed_right() const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (!std::equal(plain_list[a].begin(), plain_list[a].end(), listed[a].begin())) return false;
    }
    return n_listed == plain_list[0].size();
  }
  [[nodiscard]] bool emitted_right() const {
    return n_ids == wanted.size() && std::equal(wanted.begin(), wanted.end(), triangles.begin());
  }

  std::uint32_t n_wanted_plane = 0;
};

}  // namespace

void add_cells() {
  const auto layer = std::make_shared<Layer>();
  const double n_cells = (kSide - 1.0) * (kSide - 1.0);
  const auto n_triangles = static_cast<double>(layer->wanted.size() / 3);
  add_kernel(
      "number_plane", "samples", kSide * kSide, [layer] { layer->number_lower(); },
      [layer] { return layer->numbered_right(); });
  add_kernel(
      "list_plane", "edges", layer->n_wanted_plane, [layer] { layer->list_lower(); },
      [layer] { return layer->listed_right(); });
  add_kernel(
      "count_triangles", "cells", n_cells, [layer] { layer->count(); },
      [layer] { return 3 * layer->n_counted == layer->wanted.size(); });
  add_kernel(
      "emit_triangles", "triangles", n_triangles, [layer] { layer->emit(); },
      [layer] { return layer->emitted_right(); });
}

}  // namespace mc::bench
