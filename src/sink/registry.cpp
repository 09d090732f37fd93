// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <string>

#include "mc/sink.hpp"
#include "sink/gltf/gltf_sink.hpp"
#include "sink/obj/obj_sink.hpp"
#include "sink/ply/ply_sink.hpp"
#include "sink/stl/stl_sink.hpp"

// What can be written, by name and extension; a new mesh format is one line of the table.

namespace mc {

namespace {

#if MC_WITH_GLTF
constexpr auto open_glb = sink::open_glb;
constexpr auto open_gltf = sink::open_gltf;
#else
std::unique_ptr<MeshSink> open_glb(const std::string& path, const SinkOptions& /*options*/) {
  throw Error(ErrorKind::usage, path, "this build cannot write glTF",
              "install libtinygltf-dev and build again, or write .ply");
}
constexpr auto open_gltf = open_glb;
#endif

using OpenMesh = std::unique_ptr<MeshSink> (*)(const std::string&, const SinkOptions&);

struct Format {
  std::string_view name;  // also the extension
  OpenMesh open;          // none: a volume format
  bool has_text_form = false;
  bool holds_several = false;
  bool holds_materials = false;
};

constexpr std::array kFormats{
    Format{"ply", sink::open_ply, true, false, true},
    Format{"obj", sink::open_obj, true, true},
    Format{"stl", sink::open_stl, true, false},
    Format{"glb", open_glb, false, true, true},
    Format{"gltf", open_gltf, false, true, true},
    Format{"vdb", nullptr},
    Format{"nrrd", nullptr},
    Format{"raw", nullptr},
    Format{"exr", nullptr},
    Format{"png", nullptr},
};
constexpr std::string_view kFormatList = "ply, obj, stl, glb, gltf, vdb, nrrd, raw, exr or png";

const Format* format_named(std::string_view name) {
  const auto* found = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& f) { return f.name == name; });
  return found == kFormats.end() ? nullptr : found;
}

[[noreturn]] void unknown(std::string_view place, const std::string& what,
                          std::string_view remedy = {}) {
  throw Error(ErrorKind::usage, place, what + ": expected " + std::string(kFormatList), remedy);
}

/// The extension in lower case, without its dot; empty where there is none.
std::string extension_of(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  std::string extension(dot == std::string_view::npos ? "" : name.substr(dot + 1));
  for (char& c : extension) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return extension;
}

}  // namespace

std::string output_format(std::string_view path, const SinkOptions& options) {
  if (!options.to.empty()) {
    if (format_named(options.to) == nullptr) {
      unknown("--to", "unknown format \"" + options.to + "\"");
    }
    return options.to;
  }
  if (path == "-") {
    unknown("<stdout>", "no format given", "add --to FORMAT");
  }
  std::string extension = extension_of(path);
  if (extension.empty()) {
    unknown(path, "no extension that names a format", "add one, or --to FORMAT");
  }
  if (format_named(extension) == nullptr) {
    unknown(path, "unknown output format \"" + extension + "\"", "change it, or add --to FORMAT");
  }
  return extension;
}

bool is_mesh_format(std::string_view format) {
  const Format* found = format_named(format);
  return found != nullptr && found->open != nullptr;
}

MeshNeeds mesh_needs(std::string_view format, const SinkOptions& options, bool f32_moves) {
  const Precision exact = f32_moves ? Precision::f64 : Precision::f32;
  if (format == "ply") {
    const Precision precision = options.precision.value_or(exact);
    return {.precision = precision, .formatted = sink::ply_formatted(precision, options.ascii)};
  }
  if (format == "obj") {
    return {.precision = exact, .formatted = sink::obj_formatted(exact)};
  }
  if (format == "stl") {
    return {.formatted = sink::kStlFormatted};
  }
  return {.relative_origin = f32_moves, .formatted = sink::kGltfFormatted};
}

bool holds_materials(std::string_view format) {
  const Format* found = format_named(format);
  return found != nullptr && found->holds_materials;
}

bool holds_several_objects(std::string_view format) {
  const Format* found = format_named(format);
  return found != nullptr && found->holds_several;
}

std::unique_ptr<MeshSink> open_mesh_sink(const std::string& path, const SinkOptions& options) {
  const std::string name = output_format(path, options);
  const Format& format = *format_named(name);
  if (format.open == nullptr) {
    throw Error(ErrorKind::usage, path, name + " holds volumes, but this is a mesh",
                "write ply, obj, stl, glb or gltf");
  }
  if (options.ascii && !format.has_text_form) {
    throw Error(ErrorKind::usage, "--ascii", name + " has no text form", "write ply, stl or obj");
  }
  if (options.precision && name != "ply") {
    throw Error(ErrorKind::usage, "--precision", name + " has one precision only",
                "leave it out, or write ply");
  }
  if (options.memory != nullptr && name != "glb") {
    throw Error(ErrorKind::usage, path, name + " cannot be written to memory", "write glb");
  }
  return format.open(path, options);
}

}  // namespace mc
