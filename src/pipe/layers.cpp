// SPDX-License-Identifier: MIT
#include <string>

#include "mc/method.hpp"
#include "pipe/tasks.hpp"

// Which method a run uses, and which of its layers it makes.

namespace mc {

namespace pipe {

const Method& method_of(const ExtractOptions& options) {
  return options.method != nullptr ? *options.method : cubes_method();
}

LayerRange chosen_layers(const ExtractOptions& options, const LayerRange& all) {
  if (!options.part) return all;
  const auto [first, last] = *options.part;
  if (first < all.first || first > last || last > all.last) {
    throw Error(ErrorKind::usage, "part",
                "layers " + std::to_string(first) + " to " + std::to_string(last) +
                    " are not within " + std::to_string(all.first) + " to " +
                    std::to_string(all.last));
  }
  return *options.part;
}

Vec3 cone_apex(const Volume& volume, const RunOptions& options) {
  const IndexBox box = options.extract.region.value_or(volume.lattice.box);
  const auto middle = [&](std::size_t a) { return 0.5 * (double(box.lo[a]) + double(box.hi[a])); };
  Vec3 apex = options.to_world.value_or(volume.lattice.to_world)({middle(0), middle(1), middle(2)});
  for (std::size_t a = 0; a < 3; ++a) apex[a] -= options.extract.origin[a];
  return apex;
}

}  // namespace pipe

LayerRange part_layers(const VolumeReader& reader, const RunOptions& options) {
  if (is_dense(reader)) return pipe::dense_layers(volume_of(reader), options);
  return pipe::sparse_layers(*std::get<std::unique_ptr<LeafReader>>(reader), options);
}

}  // namespace mc
