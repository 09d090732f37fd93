// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "source/mesh/mesh_input.hpp"
#include "source/mesh/text_cursor.hpp"

// Wavefront OBJ: v, vn and f. Names, groups, materials, texture coordinates, points and lines have
// no part in a triangle mesh and are passed over; a statement that nobody knows is a fault, for a
// file of other text would otherwise read as an empty mesh.

namespace mc::source {

namespace {

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

bool is_passed_over(std::string_view statement) {
  constexpr std::array kStatements = {"vt",         "vp",       "o",        "g",        "s",
                                      "mg",         "l",        "p",        "mtllib",   "usemtl",
                                      "usemap",     "bevel",    "c_interp", "d_interp", "lod",
                                      "shadow_obj", "trace_obj"};
  return std::ranges::find(kStatements, statement) != kStatements.end();
}

class ObjReader {
 public:
  explicit ObjReader(const MeshInput& input)
      : input_(input), cursor_(input, TextCursor::Words::within_line) {}

  Mesh read() {
    while (!cursor_.at_file_end()) {
      if (!cursor_.at_end()) {
        read_statement();
      }
      cursor_.skip_line();
    }
    attach_normals();
    return std::move(mesh_);
  }

 private:
  void read_statement() {
    const std::string_view word = cursor_.word();
    if (word == "v") {
      Vec3 p{};
      for (double& x : p) {
        x = cursor_.number<double>("three coordinates");
      }
      mesh_.positions_f64.push_back(p);  // a weight or a colour may follow
    } else if (word == "f") {
      read_face();
    } else if (word == "vn") {
      std::array<float, 3> n{};
      for (float& x : n) {
        x = cursor_.number<float>("three numbers of a normal");
      }
      normals_.push_back(n);
    } else if (!is_passed_over(word)) {
      cursor_.fail("expected a statement of an obj file, such as v, vn or f");
    }
  }

  void read_face() {
    Fan fan(mesh_);
    while (!cursor_.at_end()) {
      const std::uint64_t vertex = resolve(cursor_.leading_integer<std::int64_t>("vertex numbers"),
                                           mesh_.positions_f64.size());
      std::uint64_t normal = kNone;
      if (cursor_.take('/')) {
        if (!cursor_.word_ended() && !cursor_.take('/')) {
          cursor_.leading_integer<std::int64_t>("a texture coordinate's number");
          normal = cursor_.take('/') ? read_normal() : kNone;
        } else {
          normal = read_normal();
        }
      }
      if (!cursor_.word_ended()) {
        cursor_.fail("expected v, v/t, v//n or v/t/n");
      }
      note_normal(vertex, normal);
      fan.add(vertex);
    }
    if (fan.n_corners() < 3) {
      cursor_.fail("expected a face of three vertices or more");
    }
  }

  std::uint64_t read_normal() {
    const std::uint64_t normal =
        resolve(cursor_.leading_integer<std::int64_t>("a normal's number"), normals_.size());
    if (n_normals_named_ <= normal) {
      n_normals_named_ = normal == kNone ? normal : normal + 1;
      names_last_normal_ = cursor_.offset();
    }
    return normal;
  }

  /// Numbers count from 1, or from -1 backwards. What names nothing comes out as a number past all
  /// vertices.
  static std::uint64_t resolve(std::int64_t number, std::size_t n_so_far) {
    const auto bits = static_cast<std::uint64_t>(number);
    if (number >= 0) {
      return bits - 1;
    }
    return -bits <= n_so_far ? n_so_far + bits : kNone;
  }

  /// Keeps which normal each vertex goes with, for as long as that is one for each.
  void note_normal(std::uint64_t vertex, std::uint64_t normal) {
    if (!one_normal_each_ || vertex >= mesh_.positions_f64.size()) {
      one_normal_each_ = false;
      return;
    }
    normal_of_.resize(mesh_.positions_f64.size(), kNone);
    std::uint64_t& known = normal_of_[vertex];
    one_normal_each_ = normal != kNone && (known == kNone || known == normal);
    known = normal;
  }

  void attach_normals() {
    if (n_normals_named_ > normals_.size()) {
      fault_at_line(input_, names_last_normal_,
                    "a face names a normal that is none of the " + std::to_string(normals_.size()) +
                        " in the file");
    }
    if (!one_normal_each_ || normal_of_.size() < mesh_.positions_f64.size() ||
        std::ranges::find(normal_of_, kNone) != normal_of_.end()) {
      return;
    }
    mesh_.normals.reserve(normal_of_.size());
    for (const std::uint64_t normal : normal_of_) {
      mesh_.normals.push_back(normals_[normal]);
    }
  }

  const MeshInput& input_;
  TextCursor cursor_;
  Mesh mesh_;
  std::vector<std::array<float, 3>> normals_;
  std::vector<std::uint64_t> normal_of_;  // of each vertex; short of those not yet named
  bool one_normal_each_ = true;
  std::uint64_t n_normals_named_ = 0;  // one more than the greatest index of a normal
  std::size_t names_last_normal_ = 0;  // where that stands
};

}  // namespace

Mesh read_obj(const MeshInput& input) { return ObjReader(input).read(); }

}  // namespace mc::source
