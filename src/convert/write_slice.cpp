// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "convert/planes_per_read.hpp"
#include "convert/provenance.hpp"
#include "field/visit_type.hpp"
#include "mc/convert.hpp"
#include "mc/host.hpp"

// One plane of samples, gathered from the planes that a reader hands out.

namespace mc {

namespace {

/// A plane of samples: its lattice axis and the index along it.
struct Plane {
  std::size_t axis;
  std::int32_t index;
};

/// The lattice axis that runs along world axis `axis` alone.
std::size_t lattice_axis(const Affine& map, std::size_t axis) {
  const auto only = [&](std::size_t column) {
    for (std::size_t other = 0; other < 3; ++other) {
      if ((other != column && map.m[4 * axis + other] != 0) ||
          (other != axis && map.m[4 * other + column] != 0)) {
        return false;
      }
    }
    return true;
  };
  for (std::size_t column = 0; column < 3; ++column) {
    if (only(column)) return column;
  }
  throw Error(ErrorKind::usage, "--slice",
              fmt::format("the samples do not lie in planes of constant {}", "xyz"[axis]),
              "choose a plane of samples by i, j or k=INDEX");
}

Plane chosen_plane(const Lattice& lattice, const SliceChoice& slice, Progress& progress) {
  const auto named = static_cast<std::size_t>(slice.axis);
  Plane plane{slice.world ? lattice_axis(lattice.to_world, named) : named, 0};
  const double lo = lattice.box.lo[plane.axis];
  const double hi = lattice.box.hi[plane.axis];
  const double first = slice.world ? lattice.to_world.m[4 * named + 3] : 0;
  const double step = slice.world ? lattice.to_world.m[4 * named + plane.axis] : 1;
  const double index = std::round((slice.at - first) / step);
  const char name = (slice.world ? "xyz" : "ijk")[named];
  if (!(index >= lo && index <= hi)) {
    const double a = first + lo * step;
    const double b = first + hi * step;
    throw Error(ErrorKind::usage, "--slice",
                fmt::format("{}={} lies outside the volume: expected {} to {}", name, slice.at,
                            std::min(a, b), std::max(a, b)));
  }
  plane.index = static_cast<std::int32_t>(index);
  if (const double place = first + index * step; place != slice.at) {
    progress.note(fmt::format("{}={}: the nearest samples lie at {}", name, slice.at, place));
  }
  return plane;
}

/// Copies rows of planes to where they stand in the picture.
class Gatherer {
 public:
  Gatherer(const Volume& volume, std::size_t axis)
      : axis_(axis),
        dims_(volume.lattice.dims()),
        swapped_(volume.endian != std::endian::native),
        picture_{
            axis == 0 ? dims_[2] : dims_[0], axis == 1 ? dims_[2] : dims_[1], volume.type, {}} {
    picture_.samples.resize(static_cast<std::size_t>(picture_.width) *
                            static_cast<std::size_t>(picture_.height) * sample_size(volume.type));
  }

  void take(const Slab& slab) {
    field::visit_type(picture_.type, [&]<class T>(field::TypeTag<T>) {
      for (std::size_t n = 0; n < slab.planes.size(); ++n) {
        const std::int32_t k = slab.k0 + static_cast<std::int32_t>(n);
        for (std::int32_t j = 0; j < dims_[1]; ++j) {
          take_row<T>(slab.planes[n] + static_cast<std::size_t>(j) * slab.row_stride_bytes, j, k);
        }
      }
    });
  }

  [[nodiscard]] Picture&& picture() { return std::move(picture_); }

 private:
  template <class T>
  void take_row(const std::byte* from, std::int32_t j, std::int32_t k) {
    const std::int64_t row = axis_ == 1 ? k : dims_[1] - 1 - j;
    const std::int64_t column = axis_ == 0 ? k : 0;
    std::byte* to = picture_.samples.data() +
                    static_cast<std::size_t>(row * picture_.width + column) * sizeof(T);
    for (std::size_t i = 0; i < static_cast<std::size_t>(dims_[0]); ++i) {
      const T sample = swapped_ ? field::load_sample<T, true>(from + i * sizeof(T))
                                : field::load_sample<T, false>(from + i * sizeof(T));
      std::memcpy(to + i * sizeof(T), &sample, sizeof(T));
    }
  }

  std::size_t axis_;
  Index3 dims_;  // 1 along axis_
  bool swapped_;
  Picture picture_;
};

Picture read_plane(const SlabReader& thin, const Volume& whole, std::size_t axis,
                   const std::string& output, std::uint64_t memory_bytes, Progress& progress,
                   const std::stop_token& stop) {
  const std::int32_t step =
      conversion::planes_per_read(whole, memory_beside(thin.held_bytes(), memory_bytes), output);
  const std::int32_t n_planes = thin.volume().lattice.dims()[2];
  Gatherer gatherer(thin.volume(), axis);
  progress.begin("slice", static_cast<std::uint64_t>(n_planes), "planes");
  Slab slab;
  for (std::int32_t k = 0; k < n_planes; k += step) {
    if (stop.stop_requested()) throw Cancelled();
    thin.read(k, std::min(n_planes, k + step), slab);
    gatherer.take(slab);
    progress.advance(slab.planes.size());
  }
  progress.end_stage();
  return gatherer.picture();
}

std::vector<double> values_of(const Picture& picture) {
  std::vector<double> values(picture.samples.size() / sample_size(picture.type));
  field::visit_type(picture.type, [&]<class T>(field::TypeTag<T>) {
    for (std::size_t n = 0; n < values.size(); ++n) {
      values[n] = static_cast<double>(
          field::number(field::load_sample<T, false>(picture.samples.data() + n * sizeof(T))));
    }
  });
  return values;
}

/// Black and white: as asked for, or the finite range.
std::array<double, 2> grey_range(const std::vector<double>& values, const SliceChoice& slice) {
  if (slice.range) return *slice.range;
  std::array<double, 2> range{std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    range = {std::min(range[0], v), std::max(range[1], v)};
  }
  return range[0] <= range[1] ? range : std::array<double, 2>{0, 0};
}

/// floor(t * white + 1/2) with t = (v - lo) / (hi - lo) clamped to [0, 1]; NaN is black.
template <class T>
Picture to_grey(const Picture& picture, const std::vector<double>& values,
                const std::array<double, 2>& range) {
  constexpr double kWhite = std::numeric_limits<T>::max();
  Picture out{picture.width, picture.height, field::type_of<T>(), {}};
  out.samples.resize(values.size() * sizeof(T));
  const double extent = range[1] - range[0];
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double t = extent == 0 ? 0 : (values[n] - range[0]) / extent;
    const double clamped = t > 0 ? std::min(t, 1.0) : 0.0;
    const T grey = static_cast<T>(std::floor(clamped * kWhite + 0.5));
    std::memcpy(out.samples.data() + n * sizeof(T), &grey, sizeof(T));
  }
  return out;
}

void write_grey(const Picture& picture, const SliceChoice& slice, const std::string& output,
                PictureSink& sink, Progress& progress) {
  const std::vector<double> values = values_of(picture);
  const std::array<double, 2> range = grey_range(values, slice);
  progress.note(fmt::format("{}: black is {}, white is {}", output, range[0], range[1]));
  const auto n_nan = std::ranges::count_if(values, [](double v) { return std::isnan(v); });
  if (n_nan > 0) progress.warn(fmt::format("{}: {} samples are NaN: black", output, n_nan));
  const auto [lo, hi] = std::minmax(range[0], range[1]);
  const auto n_beyond =
      std::ranges::count_if(values, [lo = lo, hi = hi](double v) { return v < lo || v > hi; });
  if (n_beyond > 0) {
    progress.note(fmt::format("{}: {} samples lie beyond that range", output, n_beyond));
  }
  sink.write(slice.bits == 8 ? to_grey<std::uint8_t>(picture, values, range)
                             : to_grey<std::uint16_t>(picture, values, range),
             {{"black", fmt::format("{}", range[0])}, {"white", fmt::format("{}", range[1])}});
}

}  // namespace

void write_slice(const VolumeReader& from, const std::string& output, const SliceChoice& slice,
                 const VolumeOptions& options, Progress& progress, const std::stop_token& stop) {
  check_region(from, options.region);
  const Volume& volume = volume_of(from);
  Lattice lattice = volume.lattice;
  if (options.region) lattice.box = *options.region;
  const Plane plane = chosen_plane(lattice, slice, progress);
  IndexBox box = lattice.box;
  box.lo[plane.axis] = plane.index;
  box.hi[plane.axis] = plane.index;
  const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&from);
  const std::unique_ptr<SlabReader> thin =
      dense != nullptr ? crop_view(**dense, box)
                       : dense_view(*std::get<std::unique_ptr<LeafReader>>(from), box);
  SinkOptions into = options.sink;
  into.provenance.push_back(conversion::generator());
  const std::unique_ptr<PictureSink> sink = open_picture_sink(output, into);
  const Picture picture =
      read_plane(*thin, volume, plane.axis, output, options.memory_bytes, progress, stop);
  refuse_changed_inputs();
  if (output_format(output, into).greys) {
    write_grey(picture, slice, output, *sink, progress);
  } else {
    sink->write(picture, {});
  }
}

}  // namespace mc
