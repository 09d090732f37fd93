// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <filesystem>

#include "mc/source.hpp"
#include "source/input_files.hpp"
#include "source/mapped_file.hpp"
#include "source/mesh/mesh_input.hpp"
#include "source/mesh/text_cursor.hpp"

// Decides which reader a mesh file goes to: by its first bytes, for binary STL by its size (many
// begin with "solid" like the text form), then by the extension.

namespace mc::source {

namespace {

constexpr std::string_view kKnownMeshes = "expected PLY, OBJ, STL, glTF or GLB";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The first word that is no "#" comment; empty where there is none.
std::string_view first_word(const MeshInput& input) {
  TextCursor cursor(input, TextCursor::Words::across_lines);
  return cursor.at_end() ? std::string_view{} : cursor.word();
}

bool is_obj_statement(std::string_view word) {
  constexpr std::array kStatements = {"v",  "vn", "vt", "vp",     "f",      "o",      "g",  "s",
                                      "mg", "l",  "p",  "mtllib", "usemtl", "usemap", "lod"};
  return std::ranges::find(kStatements, word) != kStatements.end();
}

/// Whether it starts without a zero byte, as no text has and few binary files lack.
bool starts_as_text(std::string_view text) {
  return text.substr(0, 4096).find('\0') == std::string_view::npos;
}

}  // namespace

Mesh parse_mesh(const MeshInput& input, std::string_view extension) {
  const std::string_view text = input.text();
  if (text.starts_with(kByteOrderMark)) {
    MeshInput rest = input;
    rest.bytes = input.bytes.subspan(kByteOrderMark.size());
    return parse_mesh(rest, extension);
  }
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) {
    return read_ply(input);
  }
  if (text.starts_with("glTF")) {
    return read_glb(input);
  }
  if (has_stl_size(input.bytes)) {
    return read_stl_binary(input);
  }
  const std::string_view word = first_word(input);
  const bool is_text = starts_as_text(text);
  if (is_text && word == "solid") {
    return read_stl_ascii(input);
  }
  if (word.starts_with('{') || extension == ".gltf") {
    return read_gltf(input);
  }
  const bool only_comments = word.empty() && text.find('#') != std::string_view::npos;
  if ((is_text && (is_obj_statement(word) || only_comments)) || extension == ".obj") {
    return read_obj(input);
  }
  if (extension == ".stl") {
    return read_stl_binary(input);
  }
  throw Error(ErrorKind::input, input.place,
              "is no mesh of a known format: " + std::string(kKnownMeshes));
}

}  // namespace mc::source

namespace mc {

Mesh read_mesh(const std::string& path) {
  const source::MappedFile file(path);
  source::MeshInput input{.bytes = file.bytes(), .place = file.place(), .folder = {}};
  std::string extension;
  if (path != "-") {
    const std::filesystem::path name(path);
    input.folder = name.parent_path();
    extension = "." + source::unpacked_extension_of(path);
  }
  return source::parse_mesh(input, extension);
}

}  // namespace mc
