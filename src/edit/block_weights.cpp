// SPDX-License-Identifier: MIT
#include "edit/block_weights.hpp"

#include <cassert>
#include <limits>

#include "edit/place_samples.hpp"

// The weights of a brush over one block: rows are measured position by position, the nearest of a
// group counts, and a mask takes its part.

namespace mc::edit {

namespace {

std::size_t offset(std::int32_t v) { return static_cast<std::size_t>(v & (kBlockSize - 1)); }

/// Samples of a row outside [lo, hi] are out of reach.
void leave_out(std::size_t lo, std::size_t hi, Distances& row) {
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    if (i < lo || i > hi) row.sd[i] = std::numeric_limits<double>::infinity();
  }
}

void keep_nearer(const Distances& other, Distances& row) {
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const bool nearer = other.sd[i] < row.sd[i];
    row.sd[i] = nearer ? other.sd[i] : row.sd[i];
    row.r[i] = nearer ? other.r[i] : row.r[i];
    row.radius[i] = nearer ? other.radius[i] : row.radius[i];
  }
}

}  // namespace

struct BlockWeigher::Rows {
  std::uint64_t measured = 0;  // bit j + 8 k
  std::array<Distances, kBlockSize * kBlockSize> at;
};

void sample_block(const GraphField& field, const Affine& to_place, const IndexBox& part,
                  std::span<float, kBlockSamples> out) {
  const Index3 first{part.lo[0] & ~(kBlockSize - 1), part.lo[1], part.lo[2]};
  View3<float> view(out.data(), {kBlockSize, kBlockSize, kBlockSize});
  view.data += (offset(first[2]) * kBlockSize + offset(first[1])) * kBlockSize;
  view.dims = {kBlockSize, static_cast<std::int32_t>(part.extent(1)),
               static_cast<std::int32_t>(part.extent(2))};
  sample_places(field, to_place, first, view);
}

void BlockWeigher::measure(const Index3& block, const Position& at, Rows& rows) const {
  const IndexBox part = common_part(samples_of(block), at.box);
  if (is_empty(part)) return;
  std::array<float, kBlockSamples> values;
  if (stroke_.brush.node != nullptr) {
    sample_block(*stroke_.brush.node, at.to_local, part, values);
  }
  Places places;
  Distances scratch;
  for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k) {
    for (std::int32_t j = part.lo[1]; j <= part.hi[1]; ++j) {
      const std::size_t n = offset(k) * kBlockSize + offset(j);
      const bool first = (rows.measured >> n & 1U) == 0;
      Distances& row = first ? rows.at[n] : scratch;
      place_row(at.to_local, block[0] * kBlockSize, j, k, places);
      measure_row(stroke_.brush, at, places, values.data() + n * kBlockSize, row);
      leave_out(offset(part.lo[0]), offset(part.hi[0]), row);
      if (!first) keep_nearer(scratch, rows.at[n]);
      rows.measured |= std::uint64_t{1} << n;
    }
  }
}

void BlockWeigher::apply_mask(const Index3& block, BlockWeights& out) const {
  std::array<float, kBlockSamples> values;
  sample_block(*edit_.mask, rules_.to_world, box_of(block, out.reached), values);
  Mask512 reached{};
  for_rows_of(out.reached, [&](std::size_t row) {
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const auto value = static_cast<double>(values[row * kBlockSize + i]);
      const double part = value > 0 ? (value < 1 ? value : 1) : 0;  // NaN: 0
      double& w = out.weight[row * kBlockSize + i];
      w *= part;
      reached[row / kBlockSize] |= std::uint64_t{w > 0} << (row % kBlockSize * kBlockSize + i);
    }
  });
  out.reached = reached;
}

bool BlockWeigher::weigh(const Index3& block, std::span<const std::uint32_t> group,
                         BlockWeights& out) const {
  Rows rows;
  for (const std::uint32_t n : group) measure(block, stroke_.positions[n], rows);
  out.reached = {};
  bool any = false;
  for (std::uint64_t left = rows.measured; left != 0; left &= left - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(left));
    Row w;
    weigh_row(stroke_.brush, rows.at[n], w);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      out.weight[n * kBlockSize + i] = w[i];
      out.distance[n * kBlockSize + i] = rows.at[n].sd[i];
      bits |= std::uint64_t{w[i] > 0} << i;
    }
    out.reached[n / kBlockSize] |= bits << (n % kBlockSize * kBlockSize);
    any = any || bits != 0;
  }
  if (!any || !edit_.mask) return any;
  apply_mask(block, out);
  return n_ones(out.reached) != 0;
}

}  // namespace mc::edit
