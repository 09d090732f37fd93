// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/text.hpp"
#include "mc/sink.hpp"
#include "sink/formats.hpp"

// What an output becomes, by name and extension, and who writes it.

namespace mc {

namespace {

bool holds_meshes(const SinkFormat& format) { return format.open_mesh != nullptr; }
bool holds_volumes(const SinkFormat& format) { return format.open_volume != nullptr; }
bool holds_pictures(const SinkFormat& format) { return format.open_picture != nullptr; }

/// "a, b or c": sink::names_of() for messages.
template <class... Matches>
std::string list_of(const SinkOptions& options, Matches&&... matches) {
  return base::enumerate(sink::names_of(options.further_formats, matches...));
}

[[noreturn]] void unknown(std::string_view place, std::string_view what, const SinkOptions& options,
                          std::string_view remedy = {}) {
  const std::string list = list_of(options, [](const SinkFormat&) { return true; });
  throw Error(ErrorKind::usage, place, fmt::format("{}: expected {}", what, list), remedy);
}

const SinkFormat* format_of_extension(std::string_view extension, SinkFormats further) {
  for (const SinkFormats formats : {sink_formats(), further}) {
    const auto found = std::ranges::find_if(formats, [&](const SinkFormat* format) {
      return base::has_word(format->extensions, extension);
    });
    if (found != formats.end()) return *found;
  }
  return nullptr;
}

/// What the format holds.
std::string_view kind_of(const SinkFormat& format) {
  return holds_meshes(format) ? "meshes" : holds_volumes(format) ? "volumes" : "pictures";
}

void check_form(const std::string& path, const SinkFormat& format, const SinkOptions& options) {
  if (options.ascii && format.text == TextForm::none) {
    const auto with = [](TextForm form) {
      return [form](const SinkFormat& other) { return other.text == form; };
    };
    throw Error(ErrorKind::usage, "--ascii", fmt::format("{} has no text form", format.name),
                fmt::format("write {}",
                            list_of(options, with(TextForm::optional), with(TextForm::always))));
  }
  if (options.precision && !format.precision) {
    throw Error(ErrorKind::usage, "--precision",
                fmt::format("{} has one precision only", format.name),
                fmt::format("leave it out, or write {}",
                            list_of(options, [](const SinkFormat& f) { return f.precision; })));
  }
  if (options.memory != nullptr && !format.to_memory) {
    throw Error(
        ErrorKind::usage, path, fmt::format("{} cannot be written to memory", format.name),
        fmt::format("write {}", list_of(options, [](const SinkFormat& f) { return f.to_memory; })));
  }
}

}  // namespace

const SinkFormat& output_format(std::string_view path, const SinkOptions& options) {
  if (!options.to.empty()) {
    const SinkFormat* named = find_sink_format(options.to, options.further_formats);
    if (named == nullptr) {
      unknown("--to", fmt::format("unknown format \"{}\"", options.to), options);
    }
    return *named;
  }
  if (path == "-") {
    unknown("<stdout>", "no format given", options, "add --to FORMAT");
  }
  const std::string extension = base::extension_of(path);
  if (extension.empty()) {
    unknown(path, "no extension that names a format", options, "add one, or --to FORMAT");
  }
  const SinkFormat* format = format_of_extension(extension, options.further_formats);
  if (format == nullptr) {
    unknown(path, fmt::format("unknown output format \"{}\"", extension), options,
            "change it, or add --to FORMAT");
  }
  return *format;
}

std::unique_ptr<MeshSink> open_mesh_sink(const std::string& path, const SinkOptions& options) {
  const SinkFormat& format = output_format(path, options);
  if (!holds_meshes(format)) {
    throw Error(ErrorKind::usage, path,
                fmt::format("{} holds volumes, but this is a mesh", format.name),
                fmt::format("write {}", list_of(options, holds_meshes)));
  }
  check_form(path, format, options);
  return format.open_mesh(path, options);
}

std::unique_ptr<VolumeSink> open_volume_sink(const std::string& path, const SinkOptions& options) {
  const SinkFormat& format = output_format(path, options);
  if (!holds_volumes(format)) {
    throw Error(ErrorKind::usage, path,
                fmt::format("{} holds {}, but this is a volume", format.name, kind_of(format)),
                fmt::format("write {}", list_of(options, holds_volumes)));
  }
  return format.open_volume(path, options);
}

std::unique_ptr<PictureSink> open_picture_sink(const std::string& path,
                                               const SinkOptions& options) {
  const SinkFormat& format = output_format(path, options);
  if (!holds_pictures(format)) {
    throw Error(
        ErrorKind::usage, path, fmt::format("{} holds no pictures", format.name),
        fmt::format("write {}", base::enumerate(sink::picture_names(options.further_formats))));
  }
  return format.open_picture(path, options);
}

}  // namespace mc
