// SPDX-License-Identifier: MIT
#include "extract/cubes/dense_grid.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <string>

namespace mc::extraction {

DenseGrid::DenseGrid(const Volume& volume, const Affine& map, const ExtractOptions& how,
                     const IndexBox& part)
    : name(volume.name),
      to_world(map),
      options(how),
      placement(map, how),
      classifier(volume, how, part),
      apex(middle_of(how.region.value_or(volume.lattice.box))) {
  assert(volume.lattice.box.contains(how.region.value_or(volume.lattice.box)));
  set_part(part);
}

void DenseGrid::set_part(const IndexBox& part) {
  classifier.set_part(part);
  if (classifier.n_planes() > std::numeric_limits<std::int32_t>::max() || max_layers() < 1) {
    throw Error(ErrorKind::limit, name,
                "a plane of " + std::to_string(classifier.row_samples()) + "x" +
                    std::to_string(classifier.n_rows()) +
                    " samples could hold more vertices than 32-bit ids can name",
                Remedy::smaller_region);
  }
  n_layers = static_cast<std::int32_t>(classifier.n_planes()) - 1;
}

std::int32_t DenseGrid::max_layers() const {
  // l layers name at most 3 l + 2 vertices a sample of a plane.
  const std::uint64_t per_plane = std::uint64_t{classifier.row_samples()} * classifier.n_rows();
  const std::uint64_t planes = std::numeric_limits<std::uint32_t>::max() / per_plane;
  return static_cast<std::int32_t>(
      std::min<std::uint64_t>(planes < 2 ? 0 : (planes - 2) / 3, 1U << 20U));
}

std::pair<std::int32_t, std::int32_t> DenseGrid::planes_for(std::int32_t l0,
                                                            std::int32_t l1) const {
  const IndexBox& box = classifier.box();
  const std::int32_t ring = options.normals != Normals::none ? 1 : 0;
  const std::int32_t first = classifier.first_of(l0)[2] - ring;
  const std::int32_t last = classifier.first_of(l1)[2] + ring;
  return {std::clamp(first, box.lo[2], box.hi[2]), std::clamp(last, box.lo[2], box.hi[2]) + 1};
}

}  // namespace mc::extraction
