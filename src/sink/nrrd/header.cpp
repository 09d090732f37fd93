// SPDX-License-Identifier: MIT
#include "sink/nrrd/header.hpp"

#include <fmt/format.h>

#include <bit>

#include "field/volume_names.hpp"

// NRRD headers. Numbers are printed as the shortest text that reads back the same, without locale.

namespace mc::sink {

namespace {

const char* nrrd_type(SampleType type) {
  switch (type) {
    case SampleType::u8:
      return "uint8";
    case SampleType::i8:
      return "int8";
    case SampleType::u16:
      return "uint16";
    case SampleType::i16:
      return "int16";
    case SampleType::u32:
      return "uint32";
    case SampleType::i32:
      return "int32";
    case SampleType::i64:
      return "int64";
    case SampleType::f16:
    case SampleType::f32:
      return "float";
    case SampleType::f64:
      return "double";
  }
  __builtin_unreachable();
}

std::string vector_text(double x, double y, double z) { return fmt::format("({},{},{})", x, y, z); }

/// Anatomical frames are in millimetres unless the volume says otherwise.
const char* unit_name(const Volume& volume) {
  if (volume.units == Units::m) return "m";
  return volume.units == Units::mm || volume.frame != Frame::none ? "mm" : "";
}

void add_space(std::string& out, const Volume& volume) {
  if (volume.frame == Frame::none) {
    out += "space dimension: 3\n";
  } else {
    out += volume.frame == Frame::lps ? "space: left-posterior-superior\n"
                                      : "space: right-anterior-superior\n";
  }
}

void add_placement(std::string& out, const Volume& volume) {
  const std::array<double, 12>& m = volume.lattice.to_world.m;
  const Index3& lo = volume.lattice.box.lo;
  const Vec3 first = volume.lattice.to_world(
      {static_cast<double>(lo[0]), static_cast<double>(lo[1]), static_cast<double>(lo[2])});
  out += fmt::format("space directions: {} {} {}\n", vector_text(m[0], m[4], m[8]),
                     vector_text(m[1], m[5], m[9]), vector_text(m[2], m[6], m[10]));
  out += "kinds: domain domain domain\n";
  if (sample_size(volume.type) > 1) {
    out += volume.endian == std::endian::little ? "endian: little\n" : "endian: big\n";
  }
  out += "encoding: raw\n";
  if (const std::string unit = unit_name(volume); !unit.empty()) {
    out += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", unit);
  }
  out += fmt::format("space origin: {}\n", vector_text(first[0], first[1], first[2]));
}

/// A line break would end the field; key/value pairs have escapes for it.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\\') {
      out += "\\\\";
    } else {
      out += c == '\r' ? ' ' : c;
    }
  }
  return out;
}

void add_pair(std::string& out, std::string_view key, std::string_view value) {
  if (!value.empty()) out += fmt::format("mc {}:={}\n", key, escaped(value));
}

}  // namespace

std::string nrrd_header(const Volume& volume, const SinkOptions& options,
                        std::string_view data_file) {
  const IndexBox& box = volume.lattice.box;
  std::string out = "NRRD0005\n";
  for (const auto& [key, value] : options.provenance) {
    out += fmt::format("# {}: {}\n", escaped(key), escaped(value));
  }
  out += fmt::format("type: {}\ndimension: 3\n", nrrd_type(volume.type));
  add_space(out, volume);
  out += fmt::format("sizes: {} {} {}\n", box.extent(0), box.extent(1), box.extent(2));
  add_placement(out, volume);
  add_pair(out, "name", volume.name);
  add_pair(out, "class", field::class_name(volume.cls));
  add_pair(out, "iso", volume.iso ? fmt::format("{}", *volume.iso) : "");
  add_pair(out, "border", volume.border ? field::border_name(*volume.border) : "");
  if (!data_file.empty()) out += fmt::format("data file: {}\n", data_file);
  return out + "\n";
}

}  // namespace mc::sink
