// SPDX-License-Identifier: MIT
#include "convert/surface_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/volume_names.hpp"
#include "mc/source.hpp"

namespace mc::conversion {

namespace {

bool has_float_samples(SampleType type) {
  return type == SampleType::f16 || type == SampleType::f32;
}

/// The engine compares in the data's own precision: the value used is the value printed.
double as_compared(double value, SampleType type) {
  return has_float_samples(type) ? double{static_cast<float>(value)} : value;
}

/// A volume that says itself where its surface is.
std::optional<Iso> own_iso(const Volume& volume, SourceFormats further) {
  if (volume.iso) {
    const SourceFormat* format = find_source_format(volume.format, further);
    return Iso{as_compared(*volume.iso, volume.type),
               std::string(format != nullptr ? format->own_iso : SourceFormat{}.own_iso)};
  }
  switch (volume.cls) {
    case VolumeClass::level_set:
      return Iso{0, "level set"};
    case VolumeClass::mask:
      return Iso{0.5, "mask"};
    case VolumeClass::fog:
      return Iso{0.5, "fog volume"};
    case VolumeClass::density_spec:
    case VolumeClass::sdf_spec:
      return Iso{0, "spec"};
    case VolumeClass::unknown:
      break;
  }
  return std::nullopt;
}

Iso default_iso(const Volume& volume, const FieldStatistics* statistics, SourceFormats further) {
  if (const auto own = own_iso(volume, further)) return *own;
  const double otsu =
      statistics != nullptr ? statistics->otsu : std::numeric_limits<double>::quiet_NaN();
  return {as_compared(otsu, volume.type), "otsu"};
}

}  // namespace

bool iso_needs_data(std::span<const IsoChoice> asked, const Volume& volume) {
  if (asked.empty()) return !own_iso(volume, {});
  return std::any_of(asked.begin(), asked.end(),
                     [](const IsoChoice& iso) { return iso.kind != IsoChoice::Kind::number; });
}

std::vector<Iso> choose_isos(std::span<const IsoChoice> asked, const Volume& volume,
                             std::string_view place, const Measure& measure,
                             SourceFormats further) {
  FieldStatistics statistics;
  if (iso_needs_data(asked, volume)) {
    std::vector<double> percentiles;
    for (const IsoChoice& iso : asked) {
      if (iso.kind == IsoChoice::Kind::percentile) percentiles.push_back(iso.value);
    }
    statistics = measure(percentiles);
    if (statistics.n_nan + statistics.n_infinite == statistics.n_samples) {
      throw Error(ErrorKind::empty, place,
                  fmt::format("no surface: none of the {} samples is a finite number",
                              statistics.n_samples));
    }
  }
  if (asked.empty()) return {default_iso(volume, &statistics, further)};
  std::vector<Iso> isos;
  std::size_t next_percentile = 0;
  for (const IsoChoice& iso : asked) {
    switch (iso.kind) {
      case IsoChoice::Kind::number:
        isos.push_back({as_compared(iso.value, volume.type), ""});
        break;
      case IsoChoice::Kind::otsu:
        isos.push_back({as_compared(statistics.otsu, volume.type), "otsu"});
        break;
      case IsoChoice::Kind::percentile:
        isos.push_back({as_compared(statistics.percentiles.at(next_percentile++), volume.type),
                        fmt::format("p{}", iso.value)});
        break;
    }
  }
  for (const Iso& iso : isos) {
    if (!std::isfinite(iso.value)) {
      throw Error(ErrorKind::usage, "--iso",
                  fmt::format("{} is not finite in {} data", iso.value, sample_name(volume.type)));
    }
  }
  return isos;
}

Inside choose_inside(const SurfaceChoice& choice, const Volume& volume) {
  const bool distance = volume.cls == VolumeClass::level_set || volume.cls == VolumeClass::sdf_spec;
  const Inside side = choice.inside.value_or(distance ? Inside::below : Inside::above);
  if (!choice.invert) return side;
  return side == Inside::above ? Inside::below : Inside::above;
}

Border choose_border(const SurfaceChoice& choice, const Volume& volume) {
  return choice.border.value_or(volume.border.value_or(Border::open));
}

}  // namespace mc::conversion

namespace mc {

Surface default_surface(const Volume& volume, const FieldStatistics* statistics) {
  return {{conversion::default_iso(volume, statistics, {})},
          conversion::choose_inside({}, volume),
          conversion::choose_border({}, volume)};
}

std::string value_text(double value, SampleType type) {
  return conversion::has_float_samples(type) ? fmt::format("{}", static_cast<float>(value))
                                             : fmt::format("{}", value);
}

const char* name_of(Inside inside) { return inside == Inside::above ? "above" : "below"; }

const char* name_of(Border border) { return field::border_name(border); }

}  // namespace mc
