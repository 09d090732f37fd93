// SPDX-License-Identifier: MIT
#include <array>
#include <cctype>
#include <span>
#include <string>

#include "mesh/position_index.hpp"
#include "source/mesh/mesh_input.hpp"
#include "source/mesh/text_cursor.hpp"

// STL, binary and text. Facets name no vertices, so corners are welded where their positions are
// exactly equal. The facets' normals say nothing that the winding does not and are left alone.

namespace mc::source {

namespace {

constexpr std::size_t kHeader = 84;  // 80 free bytes and the count
constexpr std::size_t kFacet = 50;   // normal, three corners, two bytes of attributes

/// Joins corners into vertices.
class Welder {
 public:
  explicit Welder(Mesh& mesh) : mesh_(mesh) {}

  std::uint64_t vertex(const std::array<float, 3>& p) {
    const std::uint64_t id = mesh_.positions.size();
    mesh_.positions.push_back(p);
    const std::uint64_t first =
        index_.first(std::span<const std::array<float, 3>>(mesh_.positions), id);
    if (first != id) {
      mesh_.positions.pop_back();
    }
    return first;
  }

 private:
  Mesh& mesh_;
  mesh::PositionIndex index_;
};

bool equal_without_case(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) {
    return false;
  }
  for (std::size_t n = 0; n < word.size(); ++n) {
    if (std::tolower(static_cast<unsigned char>(word[n])) != lower[n]) {
      return false;
    }
  }
  return true;
}

void expect(TextCursor& cursor, std::string_view keyword) {
  if (!equal_without_case(cursor.word(), keyword)) {
    cursor.fail("expected '" + std::string(keyword) + "'");
  }
}

std::array<float, 3> read_vector(TextCursor& cursor, std::string_view what) {
  std::array<float, 3> v{};
  for (float& x : v) {
    x = cursor.number<float>(what);
  }
  return v;
}

/// What follows the word "facet".
void read_facet(TextCursor& cursor, Welder& welder, Mesh& mesh) {
  expect(cursor, "normal");
  read_vector(cursor, "three numbers of a normal");
  expect(cursor, "outer");
  expect(cursor, "loop");
  std::array<std::uint64_t, 3> corners{};
  for (std::uint64_t& corner : corners) {
    expect(cursor, "vertex");
    corner = welder.vertex(read_vector(cursor, "three coordinates"));
  }
  expect(cursor, "endloop");
  expect(cursor, "endfacet");
  mesh.add_triangle(corners);
}

std::string stl_sizes(std::size_t n_bytes, std::uint64_t n_facets) {
  return std::to_string(n_bytes) + " bytes, but a binary stl of " + std::to_string(n_facets) +
         " triangles has " + std::to_string(kHeader + kFacet * n_facets);
}

}  // namespace

bool has_stl_size(std::span<const std::byte> bytes) {
  return bytes.size() >= kHeader &&
         bytes.size() == kHeader + kFacet * std::uint64_t{load<std::uint32_t>(&bytes[80])};
}

Mesh read_stl_binary(const MeshInput& input) {
  if (input.bytes.size() < kHeader) {
    throw Error(ErrorKind::input, input.place,
                std::to_string(input.bytes.size()) +
                    " bytes: expected 'solid' or the 84 bytes with which a binary stl begins");
  }
  const std::uint64_t n_facets = load<std::uint32_t>(&input.bytes[80]);
  if (!has_stl_size(input.bytes)) {
    throw Error(ErrorKind::input, input.place, stl_sizes(input.bytes.size(), n_facets),
                "the file is truncated or damaged");
  }
  Mesh mesh;
  mesh.triangles.reserve(n_facets);
  mesh.positions.reserve(n_facets / 2 + 3);  // a closed mesh has about half as many vertices
  Welder welder(mesh);
  for (std::uint64_t f = 0; f < n_facets; ++f) {
    const std::byte* at = &input.bytes[kHeader + kFacet * f + 12];
    std::array<std::uint64_t, 3> corners{};
    for (std::uint64_t& corner : corners) {
      corner = welder.vertex({load<float>(at), load<float>(at + 4), load<float>(at + 8)});
      at += 12;
    }
    mesh.add_triangle(corners);
  }
  return mesh;
}

Mesh read_stl_ascii(const MeshInput& input) {
  Mesh mesh;
  Welder welder(mesh);
  TextCursor cursor(input, TextCursor::Words::across_lines);
  while (!cursor.at_end()) {
    expect(cursor, "solid");
    cursor.skip_line();  // its name
    for (;;) {
      const std::string_view word = cursor.word();
      if (equal_without_case(word, "endsolid")) {
        break;
      }
      if (!equal_without_case(word, "facet")) {
        cursor.fail("expected 'facet' or 'endsolid'");
      }
      read_facet(cursor, welder, mesh);
    }
    cursor.skip_line();
  }
  return mesh;
}

}  // namespace mc::source
