// SPDX-License-Identifier: MIT
#include "source/image/slices.hpp"

#include <fmt/format.h>

#include <cassert>
#include <limits>
#include <utility>

#include "base/checked.hpp"
#include "source/image/image_formats.hpp"
#include "source/image/open_image.hpp"
#include "source/image/series.hpp"
#include "source/placement.hpp"

// Series of pictures, and files with several pictures, as dense volumes.

namespace mc::source {

namespace {

struct OpenFile {
  MappedFile file;
  std::unique_ptr<ImageFile> image;  // looks at the file's mapping, which moving does not move
};

/// One plane: a channel of a part of a file.
struct Plane {
  const OpenFile* from;
  std::size_t part;
  std::size_t channel;

  [[nodiscard]] const ImagePart& picture() const { return from->image->parts()[part]; }
  [[nodiscard]] SampleType type() const { return picture().channels[channel].type; }
  /// "a.exr", or "a.exr part left" where there are several.
  [[nodiscard]] std::string place() const {
    if (from->image->parts().size() == 1) return from->file.place();
    return fmt::format("{} part {}", from->file.place(), picture().name);
  }
};

class SliceReader final : public SlabReader {
 public:
  SliceReader(Volume volume, std::vector<std::unique_ptr<OpenFile>> files,
              std::vector<Plane> planes)
      : volume_(std::move(volume)), files_(std::move(files)), planes_(std::move(planes)) {}

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] bool rereads_cheaply() const override { return false; }

  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    assert(0 <= k0 && k0 <= k1 && k1 <= volume_.lattice.dims()[2]);
    out.allocate(planes_of(volume_.lattice.box, k0, k1), sample_size(volume_.type));
    const std::size_t plane_bytes =
        out.row_stride_bytes * static_cast<std::size_t>(volume_.lattice.box.extent(1));
    std::byte* bottom = out.storage.data();
    for (std::int32_t k = k0; k < k1; ++k, bottom += plane_bytes) {
      const Plane& plane = planes_[static_cast<std::size_t>(k)];
      plane.from->image->read(plane.part, plane.channel,
                              bottom + (plane_bytes - out.row_stride_bytes),
                              -static_cast<std::ptrdiff_t>(out.row_stride_bytes));
    }
  }

 private:
  Volume volume_;
  std::vector<std::unique_ptr<OpenFile>> files_;  // planes point to them
  std::vector<Plane> planes_;
};

std::vector<std::unique_ptr<OpenFile>> open_all(std::vector<MappedFile> files, ImageKind kind) {
  std::vector<std::unique_ptr<OpenFile>> out;
  for (MappedFile& file : files) {
    if (image_kind(file.text()) != kind) {
      throw Error(ErrorKind::input, file.place(),
                  fmt::format("is no {} file", format_of(kind).display));
    }
    auto open = std::make_unique<OpenFile>(OpenFile{std::move(file), nullptr});
    open->image = open_image(kind, open->file);
    out.push_back(std::move(open));
  }
  return out;
}

/// The channel to read; what else there is goes into a note.
std::string choose_channel(const OpenFile& first, const std::optional<std::string>& wanted,
                           Progress& progress) {
  if (wanted) return *wanted;
  const ImagePart& part = first.image->parts().front();
  std::string name = part.channels[*channel_named(part, std::nullopt)].name;
  if (part.channels.size() > 1) {
    progress.note(fmt::format("{}: channel {} of {}; choose by --channel", first.file.place(), name,
                              channel_list(part)));
  }
  return name;
}

std::vector<Plane> planes_with(const std::vector<std::unique_ptr<OpenFile>>& files,
                               const std::string& channel) {
  std::vector<Plane> planes;
  for (const auto& file : files) {
    const auto& parts = file->image->parts();
    const std::size_t before = planes.size();
    for (std::size_t part = 0; part < parts.size(); ++part) {
      if (const auto found = channel_named(parts[part], channel)) {
        planes.push_back({file.get(), part, *found});
      }
    }
    if (planes.size() == before) {
      std::string list;
      for (const ImagePart& part : parts) list += (list.empty() ? "" : "; ") + channel_list(part);
      throw Error(ErrorKind::input, file->file.place(),
                  fmt::format("has no channel {}: expected one of {}", channel, list));
    }
  }
  return planes;
}

std::string shape_text(const Plane& plane) {
  const ImagePart& p = plane.picture();
  return fmt::format("{}x{} {} at {},{}", p.width, p.height, sample_name(plane.type()), p.offset[0],
                     p.offset[1]);
}

void check_alike(const std::vector<Plane>& planes) {
  const Plane& first = planes.front();
  for (const Plane& plane : planes) {
    const ImagePart& a = plane.picture();
    const ImagePart& b = first.picture();
    if (a.width != b.width || a.height != b.height || a.offset != b.offset ||
        plane.type() != first.type()) {
      throw Error(
          ErrorKind::input, plane.place(),
          fmt::format("{}, but {} is {}", shape_text(plane), first.place(), shape_text(first)),
          "the slices of one volume must be alike");
    }
  }
}

[[noreturn]] void refuse_gap(const std::string& place, const std::string& what) {
  throw Error(ErrorKind::input, place, what + " is missing",
              "give the series whole; choose a part of it by --region");
}

/// By what mc wrote into each slice.
void check_notes(const std::vector<Plane>& planes) {
  std::int32_t expected = 0;
  for (const Plane& plane : planes) {
    const auto& note = plane.picture().note;
    if (!note || note->index != expected || note->count != planes.front().picture().note->count) {
      refuse_gap(plane.place(),
                 fmt::format("slice {} of the series, before this one,", expected + 1));
    }
    ++expected;
  }
  if (expected != planes.front().picture().note->count) {
    refuse_gap(planes.back().place(),
               fmt::format("slice {} of the series, after this one,", expected + 1));
  }
}

void check_complete(const std::vector<std::unique_ptr<OpenFile>>& files,
                    const std::vector<Plane>& planes) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const auto& file : files) names.push_back(file->file.place());
  if (const auto missing = missing_name(names)) refuse_gap(*missing, "this slice");
  if (planes.front().picture().note) check_notes(planes);
  if (planes.size() < 2) {
    throw Error(ErrorKind::input, planes.front().place(),
                fmt::format("one slice, with channels {}: at least two make a volume",
                            channel_list(planes.front().picture())),
                "give a folder, a quoted glob or several files");
  }
}

Volume volume_of_planes(const std::vector<Plane>& planes, ImageKind kind,
                        const SourceOptions& options) {
  const Plane& first = planes.front();
  const ImagePart& picture = first.picture();
  Volume volume;
  if (picture.note) {
    volume = picture.note->volume;
  } else {
    volume.name = picture.channels[first.channel].name;
    volume.lattice.to_world = Affine::scale_translate(
        {1, 1, 1}, {double(picture.offset[0]), double(picture.offset[1]), 0});
  }
  volume.format = format_of(kind).name;
  volume.type = first.type();
  volume.lattice.box = {
      {0, 0, 0},
      {picture.width - 1, picture.height - 1, static_cast<std::int32_t>(planes.size() - 1)}};
  volume.lattice.to_world = placed(volume.lattice.to_world, options);
  check_map(volume.lattice.to_world, first.place());
  return volume;
}

}  // namespace

std::unique_ptr<SlabReader> open_slices(std::vector<MappedFile> files, ImageKind kind,
                                        const SourceOptions& options, Progress& progress) {
  auto open = open_all(std::move(files), kind);
  const std::string channel = choose_channel(*open.front(), options.channel, progress);
  std::vector<Plane> planes = planes_with(open, channel);
  check_alike(planes);
  check_complete(open, planes);
  const ImagePart& picture = planes.front().picture();
  if (picture.width < 2 || picture.height < 2) {
    throw Error(ErrorKind::input, planes.front().place(),
                fmt::format("{}x{} pixels: expected at least two along each axis", picture.width,
                            picture.height));
  }
  Volume volume = volume_of_planes(planes, kind, options);
  return std::make_unique<SliceReader>(std::move(volume), std::move(open), std::move(planes));
}

}  // namespace mc::source
