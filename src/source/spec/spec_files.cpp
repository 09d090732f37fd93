// SPDX-License-Identifier: MIT
#include "source/spec/spec_files.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/checked.hpp"
#include "field/visit_type.hpp"
#include "mc/base.hpp"
#include "source/image/image_formats.hpp"
#include "source/image/open_image.hpp"
#include "source/input_files.hpp"
#include "source/mapped_file.hpp"
#include "source/open_named.hpp"
#include "source/spec/read_volume.hpp"
#include "source/text.hpp"

// Samples become float32 when they are loaded: reading one then costs no conversion.

namespace mc::source {

namespace {

namespace fs = std::filesystem;

/// Integers become fractions of the type's greatest number.
template <class T>
float brightness(T sample) {
  if constexpr (std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t>) {
    return static_cast<float>(sample) / static_cast<float>(std::numeric_limits<T>::max());
  } else {
    return static_cast<float>(field::number(sample));
  }
}

std::vector<float> brightnesses(const Buffer<std::byte>& bytes, SampleType type) {
  std::vector<float> out(bytes.size() / sample_size(type));
  field::visit_type(type, [&]<class T>(field::TypeTag<T>) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = brightness(field::load_sample<T, false>(bytes.data() + i * sizeof(T)));
    }
  });
  return out;
}

/// , "a", "b"
std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += ", " + quoted_text(name);
  return list;
}

/// One name for all ways to write a path.
std::string whole_path(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(path, error);
  return error ? path : whole.string();
}

/// Every sample of a volume's box, which a sparse one has where it is active.
std::uint64_t count_samples(const Lattice& lattice, const std::string& place) {
  std::optional<std::uint64_t> count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t n = lattice.box.extent(axis);
    if (n < 1) {
      throw Error(ErrorKind::input, place, "has no active samples");
    }
    count = count ? base::checked_mul(*count, static_cast<std::uint64_t>(n)) : count;
  }
  return count.value_or(std::numeric_limits<std::uint64_t>::max());
}

/// What is solid in a volume that says so.
NamedVolume described(const Volume& volume) {
  NamedVolume named;
  named.above = volume.cls != VolumeClass::level_set && volume.cls != VolumeClass::sdf_spec;
  named.iso = volume.iso;
  if (volume.cls == VolumeClass::level_set) named.iso = volume.iso.value_or(0);
  if (volume.cls == VolumeClass::fog || volume.cls == VolumeClass::mask) {
    named.iso = volume.iso.value_or(0.5);
  }
  return named;
}

}  // namespace

SpecFiles::SpecFiles(const std::string& document, const SpecNesting& within)
    : folder_(fs::path(document).parent_path().string()), inside_(within), most_(within.left) {
  const std::string path = whole_path(document);
  if (std::ranges::find(inside_.open, path) != inside_.open.end()) {
    throw Error(ErrorKind::usage, document, "closes a ring of documents",
                "name volumes that do not need this one");
  }
  if (inside_.open.size() >= SpecNesting::kMostDocuments) {
    throw Error(ErrorKind::limit, document,
                "is one more than the " + std::to_string(SpecNesting::kMostDocuments) +
                    " documents that may stand in each other",
                "sample one of them to a file");
  }
  inside_.open.push_back(path);
}

std::string SpecFiles::resolved(const std::string& path) const {
  return (fs::path(folder_) / path).string();
}

void SpecFiles::take(std::uint64_t n_samples, const std::string& place) {
  if (n_samples > inside_.left) {
    throw Error(
        ErrorKind::limit, place,
        "brings the samples that this document reads above " + std::to_string(most_),
        most_ < SpecNesting::kMostSamples ? "raise --memory, of which they may take half" : "");
  }
  inside_.left -= n_samples;
}

std::shared_ptr<const Raster> SpecFiles::picture(const std::string& path,
                                                 const std::optional<std::string>& channel) {
  const Key key{resolved(path), channel};
  if (const auto known = pictures_.find(key); known != pictures_.end()) return known->second;
  check_within(inside_.root, key.first);
  check_regular(key.first);
  const MappedFile file(key.first);
  const std::optional<ImageKind> kind = image_kind(file.text());
  if (!kind) {
    throw Error(ErrorKind::input, key.first, "is neither a PNG nor an OpenEXR picture");
  }
  const std::unique_ptr<ImageFile> image = open_image(*kind, file);
  const ImagePart& part = image->parts().front();
  const std::optional<std::size_t> chosen = channel_named(part, channel);
  if (!chosen) {
    throw Error(ErrorKind::input, key.first,
                "has no channel " + *channel + ": expected one of " + channel_list(part));
  }
  const auto width = static_cast<std::uint64_t>(part.width);
  const auto height = static_cast<std::uint64_t>(part.height);
  take(width * height, key.first);
  const SampleType type = part.channels[*chosen].type;
  Buffer<std::byte> bytes(width * height * sample_size(type));
  image->read(0, *chosen, bytes.data(), static_cast<std::ptrdiff_t>(width * sample_size(type)));
  auto raster = std::make_shared<Raster>();
  raster->width = part.width;
  raster->height = part.height;
  raster->samples = brightnesses(bytes, type);
  return pictures_.emplace(key, std::move(raster)).first->second;
}

const NamedVolume& SpecFiles::named_volume(const std::string& path,
                                           const std::optional<std::string>& grid) {
  if (path == "-") {
    throw Error(ErrorKind::usage, "", "stdin cannot be a volume of a document", "name a file");
  }
  const std::string place = resolved(path);
  const Key key{whole_path(place), grid};
  if (const auto known = volumes_.find(key); known != volumes_.end()) return known->second;
  const Source source = open_named(place, grid, inside_);
  if (!grid && !source.other_grids.empty()) {
    throw Error(ErrorKind::input, place,
                "holds several grids: " + quoted_text(volume_of(source.reader).name) +
                    list_of(source.other_grids),
                "name one as \"grid\"");
  }
  take(count_samples(volume_of(source.reader).lattice, place), place);
  NamedVolume named = described(volume_of(source.reader));
  named.samples = std::make_shared<const SampledVolume>(read_volume(source.reader, place));
  return volumes_.emplace(key, std::move(named)).first->second;
}

}  // namespace mc::source
