// SPDX-License-Identifier: MIT
#include "sink/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text.hpp"
#include "sink/gltf/gltf_sink.hpp"
#include "sink/image/image_formats.hpp"
#include "sink/nrrd/nrrd_sink.hpp"
#include "sink/obj/obj_sink.hpp"
#include "sink/ply/ply_sink.hpp"
#include "sink/raw/raw_sink.hpp"
#include "sink/stl/stl_sink.hpp"
#include "sink/vdb/vdb_sink.hpp"

// The one list of formats that are written. Messages and help list them in this order.

namespace mc::sink {

namespace {

constexpr std::array<const SinkFormat*, 10> kFormats{
    &kPlyFormat, &kObjFormat,  &kStlFormat, &kGlbFormat, &kGltfFormat,
    &kVdbFormat, &kNrrdFormat, &kRawFormat, &kExrFormat, &kPngFormat};

}  // namespace

std::vector<std::string_view> picture_names(SinkFormats further) {
  const auto picture = [](bool volume) {
    return [volume](const SinkFormat& f) {
      return f.open_picture != nullptr && (f.open_volume != nullptr) == volume;
    };
  };
  return names_of(further, picture(false), picture(true));
}

std::string dotted(std::span<const std::string_view> names) {
  std::vector<std::string> extensions;
  for (const std::string_view name : names) extensions.push_back(fmt::format(".{}", name));
  return base::enumerate(std::vector<std::string_view>(extensions.begin(), extensions.end()));
}

std::vector<std::string_view> several_object_names() {
  const auto several = [](bool text) {
    return [text](const SinkFormat& f) {
      return f.several_objects && (f.text == TextForm::always) == text;
    };
  };
  return names_of({}, several(false), several(true));
}

void refuse_second_object(const SinkFormat& format, std::string_view place) {
  throw Error(ErrorKind::usage, place,
              fmt::format("{} holds one mesh, but there are several", format.display),
              fmt::format("write {}, or one iso a file", dotted(several_object_names())));
}

void refuse_absent(const SinkFormat& format, std::string_view place) {
  const bool mesh = format.open_mesh != nullptr;
  const auto instead = std::ranges::find_if(kFormats, [&](const SinkFormat* other) {
    return other->package.empty() &&
           (mesh ? other->open_mesh != nullptr : other->open_volume != nullptr);
  });
  throw Error(
      ErrorKind::usage, place, fmt::format("this build cannot write {}", format.display),
      fmt::format("install {} and build again, or write .{}", format.package, (*instead)->name));
}

}  // namespace mc::sink

namespace mc {

SinkFormats sink_formats() { return sink::kFormats; }

const SinkFormat* find_sink_format(std::string_view name, SinkFormats further) {
  for (const SinkFormats formats : {sink_formats(), further}) {
    const auto found = std::ranges::find(formats, name, &SinkFormat::name);
    if (found != formats.end()) return *found;
  }
  return nullptr;
}

const SinkFormat& usual_mesh_format() { return sink::kGlbFormat; }
const SinkFormat& usual_volume_format() { return sink::kNrrdFormat; }

}  // namespace mc
