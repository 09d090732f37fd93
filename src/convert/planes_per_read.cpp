// SPDX-License-Identifier: MIT
#include "convert/planes_per_read.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/machine_memory.hpp"
#include "mc/base.hpp"

namespace mc::conversion {

std::int32_t planes_per_read(const Volume& volume, std::uint64_t memory_bytes,
                             std::string_view place) {
  const IndexBox& box = volume.lattice.box;
  const std::uint64_t plane_bytes = static_cast<std::uint64_t>(box.extent(0)) *
                                    static_cast<std::uint64_t>(box.extent(1)) *
                                    sample_size(volume.type);
  const std::uint64_t n_planes = memory_bytes / 2 / std::max<std::uint64_t>(plane_bytes, 1);
  if (n_planes == 0) {
    throw Error(ErrorKind::limit, place,
                fmt::format("two planes of samples need {}, but --memory allows {}",
                            base::size_text(2 * plane_bytes), base::size_text(memory_bytes)),
                "raise --memory, or choose a --region");
  }
  return static_cast<std::int32_t>(std::min<std::uint64_t>(n_planes, 32));
}

}  // namespace mc::conversion
