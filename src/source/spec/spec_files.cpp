// SPDX-License-Identifier: MIT
#include "source/spec/spec_files.hpp"

#include <filesystem>
#include <limits>
#include <utility>

#include "field/visit_type.hpp"
#include "mc/base.hpp"
#include "source/image/open_image.hpp"
#include "source/mapped_file.hpp"

// Pictures become float32 when they are loaded: a sample then costs no conversion.

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

/// Opened without waiting: a FIFO or a device may never answer.
MappedFile open_regular(const std::string& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    throw Error(ErrorKind::input, path, "is no regular file");
  }
  return MappedFile(path);
}

}  // namespace

SpecFiles::SpecFiles(const std::string& document)
    : folder_(fs::path(document).parent_path().string()) {}

std::string SpecFiles::resolved(const std::string& path) const {
  return (fs::path(folder_) / path).string();
}

void SpecFiles::take(std::uint64_t n_samples, const std::string& place) {
  if (n_samples > left_) {
    throw Error(
        ErrorKind::limit, place,
        "brings the samples that this document reads above " + std::to_string(kMostSamples));
  }
  left_ -= n_samples;
}

std::shared_ptr<const Raster> SpecFiles::picture(const std::string& path,
                                                 const std::optional<std::string>& channel) {
  const Key key{resolved(path), channel};
  if (const auto known = pictures_.find(key); known != pictures_.end()) return known->second;
  const MappedFile file = open_regular(key.first);
  const std::optional<Format> format = format_of_content(file.text());
  if (!format || !is_image(*format)) {
    throw Error(ErrorKind::input, key.first, "is neither a PNG nor an OpenEXR picture");
  }
  const std::unique_ptr<ImageFile> image = open_image(*format, file);
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

}  // namespace mc::source
