// SPDX-License-Identifier: MIT
#include "mc/convert.hpp"

#include <fmt/format.h>

namespace mc {

namespace {

std::string box_text(const IndexBox& box) {
  return fmt::format("{},{},{}:{},{},{}", box.lo[0], box.lo[1], box.lo[2], box.hi[0], box.hi[1],
                     box.hi[2]);
}

bool overlap(const IndexBox& a, const IndexBox& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.hi[axis] < b.lo[axis] || b.hi[axis] < a.lo[axis]) return false;
  }
  return true;
}

}  // namespace

void check_region(const VolumeReader& reader, const std::optional<IndexBox>& region) {
  if (!region) return;
  const IndexBox& whole = volume_of(reader).lattice.box;
  if (is_dense(reader) ? whole.contains(*region) : overlap(whole, *region)) return;
  throw Error(ErrorKind::usage, "--region",
              fmt::format("{} lies outside the volume: expected a box within {}", box_text(*region),
                          box_text(whole)));
}

}  // namespace mc
