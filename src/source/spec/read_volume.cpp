// SPDX-License-Identifier: MIT
#include "source/spec/read_volume.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"

// Volumes that nodes read, as dense float32.

namespace mc::source {

namespace {

/// Planes that are read at a time: a layer of a sparse volume's leaves.
constexpr std::size_t kPlanes = 8;

template <class T, bool Swap>
void convert_row(const std::byte* from, std::span<float> to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    const T sample = field::load_sample<T, Swap>(from + i * sizeof(T));
    to[i] = static_cast<float>(field::number(sample));
  }
}

/// The rows of a slab, one after the other.
void convert_slab(const Slab& slab, const Volume& volume, float* to) {
  const Index3 dims = volume.lattice.dims();
  const auto n_row = static_cast<std::size_t>(dims[0]);
  const bool swap = volume.endian != std::endian::native;
  field::visit_type(volume.type, [&]<class T>(field::TypeTag<T>) {
    for (const std::byte* plane : slab.planes) {
      for (std::int32_t j = 0; j < dims[1]; ++j, to += n_row) {
        const std::byte* row = plane + static_cast<std::size_t>(j) * slab.row_stride_bytes;
        swap ? convert_row<T, true>(row, {to, n_row}) : convert_row<T, false>(row, {to, n_row});
      }
    }
  });
}

Affine inverted(const Affine& to_world, const std::string& place) {
  constexpr double kMost = 1e100;  // what SampledVolume takes
  const auto inverse = to_world.inverse();
  const auto small = [](double v) { return std::abs(v) <= kMost; };
  if (!inverse || !std::all_of(inverse->m.begin(), inverse->m.end(), small)) {
    throw Error(ErrorKind::input, place, "its map from samples to the world cannot be inverted");
  }
  return *inverse;
}

SampledVolume read_dense(const SlabReader& reader, const std::string& place) {
  const Volume& about = reader.volume();
  SampledVolume volume;
  volume.dims = about.lattice.dims();
  volume.to_index = inverted(about.lattice.to_world, place);
  const auto n_planes = static_cast<std::size_t>(volume.dims[2]);
  const auto n_plane =
      static_cast<std::size_t>(volume.dims[0]) * static_cast<std::size_t>(volume.dims[1]);
  volume.samples.resize(n_plane * n_planes);
  const auto read_part = [&](std::size_t first, std::size_t last) {
    Slab slab;
    for (std::size_t part = first; part < last; ++part) {
      const std::size_t k0 = part * kPlanes;
      const std::size_t k1 = std::min(k0 + kPlanes, n_planes);
      reader.read(static_cast<std::int32_t>(k0), static_cast<std::int32_t>(k1), slab);
      convert_slab(slab, about, &volume.samples[k0 * n_plane]);
    }
  };
  base::for_ranges((n_planes + kPlanes - 1) / kPlanes, 1, read_part);
  return volume;
}

}  // namespace

SampledVolume read_volume(const VolumeReader& reader, const std::string& place) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    return read_dense(**dense, place);
  }
  const LeafReader& sparse = *std::get<std::unique_ptr<LeafReader>>(reader);
  const Volume& about = sparse.volume();
  SampledVolume volume = read_dense(*dense_view(sparse, about.lattice.box), place);
  volume.background = static_cast<float>(to_double(sparse.background(), about.type));
  return volume;
}

}  // namespace mc::source
