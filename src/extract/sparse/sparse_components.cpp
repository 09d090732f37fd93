// SPDX-License-Identifier: MIT
#include "extract/sparse/sparse_components.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "extract/cubes/slab_labeller.hpp"
#include "extract/cubes/surface_sums.hpp"
#include "extract/sparse/block_sampler.hpp"
#include "extract/sparse/leaf_queue.hpp"

namespace mc::extraction {

using field::bit_index;
using field::n_ones;
using field::set;

namespace {

/// Nodes of a solid background, each of which has a number: 2^24 of them span 16384 samples along
/// each axis.
constexpr std::uint64_t kMaxBackgroundNodes = 1U << 24U;

double n_cells_of(const SparsePlan& plan) {
  const IndexBox stored = plan.index().stored_blocks();
  double n = 1;
  for (int axis = 0; axis < 3; ++axis) n *= 8.0 * static_cast<double>(stored.extent(axis) + 2);
  return n;
}

}  // namespace

SparseComponents::SparseComponents(const LeafReader& reader, const Affine& to_world,
                                   const ExtractOptions& options, SizeKind kind)
    : reader_(reader),
      to_world_(to_world),
      options_(labelling_options(options)),
      border_(options.border),
      plan_(reader, options_),
      placement_(to_world, options_),
      unit_(kind, placement_.map,
            placement_.map(middle_of(options.region.value_or(reader.volume().lattice.box))),
            n_cells_of(plan_)),
      solid_above_(options.inside == Inside::above),
      joiner_(options.inside),
      tiles_(plan_.index().big_tiles()) {
  list_blocks();
  list_nodes();
  number_runs(blocks_);
  number_runs(nodes_);
  first_tile_ = static_cast<std::uint32_t>(parent_.size());
  list_background();
  joiner_.join(
      blocks_, [this](const Index3& block) { return block_number(block); }, parent_);
  joiner_.join(
      nodes_, [this](const Index3& node) { return node_number(node); }, parent_);
  join_tiles();
  join_background();
  number_components();
}

void SparseComponents::list_blocks() {
  for (const SurfaceBlock& block : plan_.blocks()) {
    const Mask512* bits = plan_.mixed_bits(block);
    if (bits == nullptr) continue;
    blocks_.at.push_back(block.at);
    Mask512& solid = blocks_.solid.emplace_back(*bits);
    for (std::uint64_t& word : solid) word = solid_above_ ? word : ~word;
  }
}

/// The blocks of nodes that are solid throughout; of a region's border only those that lie inside.
void SparseComponents::list_nodes() {
  for (const BlockIndex::UniformBlocks& blocks : plan_.index().uniform_blocks()) {
    Mask512 solid = solid_above_ ? blocks.above : blocks.below;
    for (std::size_t w = 0; w < 8; ++w) {
      for_each_bit(solid[w], [&](int bit) {
        const Index3 block = sum_of(origin_of(blocks.node), place_of(w, bit));
        const IndexBox samples = field::samples_of(block);
        if (!plan_.box().contains(samples)) solid[w] &= ~(std::uint64_t{1} << bit);
      });
    }
    nodes_.at.push_back(blocks.node);
    nodes_.solid.push_back(solid);
  }
}

void SparseComponents::number_runs(SolidCells& cells) {
  for (const Mask512& solid : cells.solid) {
    cells.first.push_back(static_cast<std::uint32_t>(parent_.size()));
    std::size_t n = parent_.size();
    for (const std::uint64_t plane : solid)
      n += static_cast<std::size_t>(std::popcount(run_starts(plane)));
    if (n >= kNone) {
      throw Error(ErrorKind::limit, reader_.volume().name,
                  "the grid has more than 2^32 runs of solid samples, too many to tell its "
                  "components apart",
                  Remedy::smaller_region);
    }
    while (parent_.size() < n) parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
  }
}

/// Numbers tiles, the nodes of a solid background, and what lies outside all of them.
void SparseComponents::list_background() {
  std::uint64_t n = tiles_.size();
  if (plan_.index().background_above() == solid_above_) {
    const IndexBox blocks = plan_.capped()
                                ? IndexBox{block_of(plan_.box().lo), block_of(plan_.box().hi)}
                                : plan_.index().stored_blocks();
    const IndexBox nodes = field::blocks_of(blocks);
    background_ = plan_.capped() ? nodes : grown(nodes, 1);
    std::uint64_t n_nodes = 1;
    for (int axis = 0; axis < 3; ++axis) {
      n_nodes *= std::min<std::uint64_t>(static_cast<std::uint64_t>(background_->extent(axis)),
                                         kMaxBackgroundNodes + 1);
      if (n_nodes > kMaxBackgroundNodes) {
        throw Error(ErrorKind::limit, reader_.volume().name,
                    "the background is solid and spans too much to tell components apart",
                    Remedy::smaller_region);
      }
    }
    first_background_ = first_tile_ + static_cast<std::uint32_t>(n);
    n += n_nodes;
  }
  outside_ = first_tile_ + static_cast<std::uint32_t>(n);
  while (parent_.size() <= outside_) parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
}

bool SparseComponents::touches_box(const Index3& lo, const Index3& hi) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (hi[a] < plan_.box().lo[a] || lo[a] > plan_.box().hi[a]) return false;
  }
  return true;
}

/// The number of what a node belongs to as a whole: a tile, background, or what lies outside.
std::uint32_t SparseComponents::node_number(const Index3& node) const {
  const Index3 lo{node[0] * 64, node[1] * 64, node[2] * 64};
  if (plan_.capped() && !touches_box(lo, {lo[0] + 63, lo[1] + 63, lo[2] + 63})) {
    return is_solid_outside() ? outside_ : kNone;
  }
  if (const auto tile = plan_.index().big_tile_number(node)) {
    return tiles_[*tile].above == solid_above_ ? first_tile_ + static_cast<std::uint32_t>(*tile)
                                               : kNone;
  }
  if (!background_) return kNone;
  if (!background_->contains(node)) return outside_;
  std::int64_t n = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const auto a = static_cast<std::size_t>(axis);
    n = n * background_->extent(axis) + (node[a] - background_->lo[a]);
  }
  return first_background_ + static_cast<std::uint32_t>(n);
}

/// The node of the background that has this number.
Index3 SparseComponents::background_node(std::uint32_t number) const {
  const auto at = static_cast<std::int64_t>(number - first_background_);
  const std::int64_t nx = background_->extent(0), ny = background_->extent(1);
  return {background_->lo[0] + static_cast<std::int32_t>(at % nx),
          background_->lo[1] + static_cast<std::int32_t>(at / nx % ny),
          background_->lo[2] + static_cast<std::int32_t>(at / (nx * ny))};
}

/// Whether what lies beyond the region, or beyond all that is stored, is solid.
bool SparseComponents::is_solid_outside() const {
  return plan_.capped() ? options_.border == Border::solid : background_.has_value();
}

/// The number of what a block belongs to that has one kind of samples.
std::uint32_t SparseComponents::block_number(const Index3& block) const {
  const IndexBox samples = field::samples_of(block);
  if (plan_.capped() && options_.border == Border::solid && !plan_.box().contains(samples)) {
    const bool inside_solid =
        !touches_box(samples.lo, samples.hi) || plan_.index().at(block).above == solid_above_;
    return inside_solid ? outside_ : kNone;
  }
  const Index3 node = block_of(block);
  const std::size_t n = nodes_.find(node);
  if (n == kNoBlock) return node_number(node);
  const BitIndex place = bit_index(block);
  return test(nodes_.solid[n], place) ? nodes_.run_at(n, place) : kNone;
}

/// Joins tiles to the tiles and the background beside them; stored nodes have done so themselves.
void SparseComponents::join_tiles() {
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    const BlockIndex::UniformNodes& tile = tiles_[t];
    if (tile.above != solid_above_) continue;
    const auto number = first_tile_ + static_cast<std::uint32_t>(t);
    const auto join = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
      const auto out = [&](std::int32_t v) { return v < 0 || v >= tile.size ? 1U : 0U; };
      const unsigned n_out = out(x) + out(y) + out(z);
      if (n_out == 0 || n_out > (solid_above_ ? 1U : 2U)) return;
      const Index3 node = sum_of(tile.origin, {x, y, z});
      if (nodes_.find(node) != kNoBlock) return;
      const std::uint32_t other = node_number(node);
      if (other != kNone) base::unite_sets(parent_, number, other);
    };
    for (std::int32_t z = -1; z <= tile.size; ++z) {
      for (std::int32_t y = -1; y <= tile.size; ++y) {
        const bool face = z == -1 || z == tile.size || y == -1 || y == tile.size;
        for (std::int32_t x = -1; x <= tile.size; x += face ? 1 : tile.size + 1) join(x, y, z);
      }
    }
  }
}

/// Joins the nodes of a solid background that are not stored.
void SparseComponents::join_background() {
  if (!background_) return;
  for (std::int32_t z = background_->lo[2]; z <= background_->hi[2]; ++z) {
    for (std::int32_t y = background_->lo[1]; y <= background_->hi[1]; ++y) {
      for (std::int32_t x = background_->lo[0]; x <= background_->hi[0]; ++x) {
        const Index3 node{x, y, z};
        const std::uint32_t number = nodes_.find(node) == kNoBlock ? node_number(node) : kNone;
        if (number == kNone || number < first_background_) continue;
        for (const Index3& d : joiner_.directions()) {
          const Index3 next = sum_of(node, d);
          if (nodes_.find(next) != kNoBlock) continue;
          const std::uint32_t other = node_number(next);
          if (other != kNone) base::unite_sets(parent_, number, other);
        }
      }
    }
  }
}

/// Numbers the components by their first samples, so that a dense volume of the same samples has
/// them in the same order.
void SparseComponents::number_components() {
  struct Root {
    Index3 first;
    std::uint32_t number;
  };
  std::vector<Root> roots;
  std::vector<std::uint32_t> place(parent_.size(), kNone);  // of each root among the roots
  const auto add = [&](std::uint32_t number, const Index3& sample) {
    const std::uint32_t root = base::find_set(parent_, number);
    if (place[root] == kNone) {
      place[root] = static_cast<std::uint32_t>(roots.size());
      roots.push_back({sample, root});
    } else if (comes_before(sample, roots[place[root]].first)) {
      roots[place[root]].first = sample;
    }
  };
  const auto add_cells = [&](const SolidCells& cells, std::int32_t size) {
    for (std::size_t n = 0; n < cells.at.size(); ++n) {
      std::uint32_t run = cells.first[n];
      for (std::size_t z = 0; z < 8; ++z) {
        for_each_bit(run_starts(cells.solid[n][z]), [&](int bit) {
          Index3 p = sum_of(origin_of(cells.at[n]), place_of(z, bit));
          for (std::int32_t& v : p) v *= size;
          add(run++, p);
        });
      }
    }
  };
  add_cells(blocks_, 1);
  add_cells(nodes_, 8);
  const auto samples = [](const Index3& node) {
    return Index3{node[0] * 64, node[1] * 64, node[2] * 64};
  };
  for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
    if (tiles_[t].above == solid_above_) add(first_tile_ + t, samples(tiles_[t].origin));
  }
  for (std::uint32_t n = first_background_; background_ && n < outside_; ++n) {
    const Index3 node = background_node(n);
    if (nodes_.find(node) == kNoBlock && node_number(node) == n) add(n, samples(node));
  }
  if (is_solid_outside()) add(outside_, {-kReach, -kReach, -kReach});
  std::sort(roots.begin(), roots.end(),
            [](const Root& a, const Root& b) { return comes_before(a.first, b.first); });
  for (std::uint32_t n = 0; n < roots.size(); ++n) place[roots[n].number] = n;
  for (std::uint32_t n = 0; n < parent_.size(); ++n) {
    place[n] = place[base::find_set(parent_, n)];
  }
  parent_ = std::move(place);
  sums_.assign(roots.size(), 0);
  if (is_solid_outside()) unbounded_ = parent_[outside_];
}

template <class T>
void SparseComponents::measure_typed(std::size_t first, std::size_t last,
                                     std::vector<RunSize>& out) const {
  std::vector<std::byte> scratch(BlockSampler<double>::kScratchBytes);
  BlockSampler<T> sampler(reader_, plan_.index(), plan_.box(), scratch.data());
  VertexRules<T> rules(options_, to_world_, plan_.threshold());
  rules.capped = plan_.capped();
  const EdgeVertices<T, BlockSampler<T>> vertices(rules, sampler);
  BlockWalk<2> walk(plan_.blocks());
  BlockSamples samples;
  const bool skips_caps = unit_.kind() == SizeKind::area && border_ == Border::open;
  for (std::size_t n = first; n < last; ++n) {
    const Index3 block = plan_.blocks()[n].at;
    walk.move_to(n);
    sampler.move_to(block, nullptr);
    const BlockBits above = plan_.bits_around(walk, 0, 0, 0);
    const Mask512 cells = find_cells(above, plan_.samples_around(block, samples));
    std::array<std::optional<std::size_t>, 8> known;  // places of the neighbours among blocks_
    const auto component_at = [&](const Index3& p) {
      const auto at = static_cast<std::size_t>((p[0] >> 3) + 2 * (p[1] >> 3) + 4 * (p[2] >> 3));
      const Index3 there = sum_of(block, block_of(p));
      if (!known[at]) known[at] = blocks_.find(there);
      return parent_[*known[at] != kNoBlock ? blocks_.run_at(*known[at], bit_index(p))
                                            : block_number(there)];
    };
    for (std::size_t k = 0; k < 8; ++k) {
      for_each_bit(cells[k], [&](int bit) {
        const Index3 within = place_of(k, bit);
        const Index3 cell = sum_of(origin_of(block), within);
        if (skips_caps && plan_.capped() &&
            !plan_.box().contains(IndexBox{cell, sum_of(cell, {1, 1, 1})})) {
          return;
        }
        for_each_triangle_size(vertices, placement_, options_.precision, unit_, options_.inside,
                               cell, case_in(above, within), [&](Corner corner, std::int64_t size) {
                                 const std::uint32_t component = component_at(corner.of(within));
                                 if (out.empty() || out.back().run != component) {
                                   out.push_back({component, 0});
                                 }
                                 out.back().size += static_cast<std::uint64_t>(size);
                               });
      });
    }
  }
}

void SparseComponents::measure(std::size_t first, std::size_t last,
                               std::vector<RunSize>& out) const {
  out.clear();
  field::visit_type(plan_.threshold().type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    measure_typed<T>(first, last, out);
  });
}

void SparseComponents::add(std::span<const RunSize> sizes) {
  for (const RunSize& size : sizes) sums_[size.run] += size.size;
}

std::vector<double> SparseComponents::sizes() const {
  std::vector<double> out;
  for (const std::uint64_t sum : sums_) out.push_back(unit_.size_of(sum));
  if (unbounded_ != kNone) out[unbounded_] = std::numeric_limits<double>::infinity();
  return out;
}

SparseSelection SparseComponents::selection(std::span<const std::uint8_t> kept) const {
  const auto is_dropped = [&](std::uint32_t number) { return kept[parent_[number]] == 0; };
  const auto dropped_of = [&](const SolidCells& cells) {
    std::vector<SparseSelection::Dropped> out;
    for (std::size_t n = 0; n < cells.at.size(); ++n) {
      Mask512 mask{};
      for (std::size_t z = 0; z < 8; ++z) {
        for_each_bit(cells.solid[n][z], [&](int bit) {
          const BitIndex place{z, static_cast<unsigned>(bit)};
          if (is_dropped(cells.run_at(n, place))) set(mask, place);
        });
      }
      if (n_ones(mask) != 0) out.push_back({cells.at[n], mask});
    }
    return out;
  };
  std::vector<SparseSelection::Dropped> nodes = dropped_of(nodes_);
  std::vector<SparseSelection::DroppedTile> tiles;
  for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
    const bool solid = tiles_[t].above == solid_above_;
    if (solid && parent_[first_tile_ + t] != kNone && is_dropped(first_tile_ + t)) {
      tiles.push_back({tiles_[t].origin, tiles_[t].size});
    }
  }
  for (std::uint32_t n = first_background_; background_ && n < outside_; ++n) {
    if (parent_[n] == kNone || !is_dropped(n)) continue;
    tiles.push_back({background_node(n), 1});
  }
  return {dropped_of(blocks_), std::move(nodes), std::move(tiles)};
}

std::uint64_t SparseComponents::bytes() const {
  const auto of_cells = [](const SolidCells& cells) {
    return cells.at.size() * (sizeof(Index3) + sizeof(Mask512) + sizeof(std::uint32_t));
  };
  // Roots are numbered beside their parents; every cell may lose places.
  return plan_.bytes() + 2 * of_cells(blocks_) + 2 * of_cells(nodes_) +
         parent_.size() * 2 * sizeof(std::uint32_t) +
         sums_.size() * (3 * sizeof(std::uint64_t) + 1);
}

}  // namespace mc::extraction
