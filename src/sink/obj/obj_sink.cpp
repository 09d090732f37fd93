// SPDX-License-Identifier: MIT
#include "sink/obj/obj_sink.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/part.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// Wavefront OBJ: of every object all `v`, then all `vn`, then all `f`; indices start at 1 and run
// on through the file. No count comes first, so `v` lines go out as they come, to a stream as well;
// the other two are spooled. Numbers are the shortest that read back the same.

namespace mc::sink {

namespace {

constexpr LineBytes vertex_line(Precision precision) {
  return {kMostTriple + 3, (precision == Precision::f64 ? kMostTriple : kFloatTriple) + 3};
}
constexpr LineBytes kNormalLine{kMostTriple + 4, kFloatTriple + 4};
constexpr LineBytes kFaceLine{2 + 3 * (1 + kMostDigits + 2 + kMostDigits),
                              2 + 3 * (1 + kLargeIdDigits + 2 + kLargeIdDigits)};

class ObjSink final : public MeshSink {
 public:
  ObjSink(const std::string& path, const SinkOptions& options)
      : out_(path, output_options(options, false)) {
    for (const auto& [key, value] : options.provenance) {
      out_.append("# " + on_one_line(key) + ": " + on_one_line(value) + "\n");
    }
  }

  void set_slots(std::size_t n_slots) override { slots_.resize(n_slots); }
  void begin_object(const MeshObject& object) override;
  void format(const MeshChunk& chunk, std::size_t slot) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override { out_.commit(); }

 private:
  void print_vertices(const MeshChunk& chunk, Piece& piece) const;
  void print_normals(const MeshChunk& chunk, Piece& piece) const;
  void print_faces(const MeshChunk& chunk, Piece& piece) const;

  struct Slot {
    Piece vertices, normals, faces;
  };

  OutputFile out_;
  MeshObject object_;
  ObjectCounts counts_;
  std::uint64_t first_vertex_ = 1;  // of this object, as `f` lines name it
  std::uint64_t first_normal_ = 1;  // less than first_vertex_ after an object without normals
  std::optional<SpoolFile> normal_spool_, face_spool_;
  std::optional<Part> vertices_, normals_, faces_;
  std::vector<Slot> slots_{1};
};

void ObjSink::begin_object(const MeshObject& object) {
  object_ = object;
  counts_ = {};
  normals_.emplace(normal_spool_.emplace(out_).writer(), 0);
  faces_.emplace(face_spool_.emplace(out_).writer(), 0);
  if (!object.name.empty()) {
    std::string name = on_one_line(object.name);  // many readers end a name at the first space
    std::replace(name.begin(), name.end(), ' ', '_');
    out_.append("o " + name + "\n");
  }
  vertices_.emplace(out_.writer(), out_.size());
}

void ObjSink::print_vertices(const MeshChunk& chunk, Piece& piece) const {
  make_lines(
      chunk.n_vertices(), vertex_line(object_.precision), piece.made, [&](std::size_t i, char* at) {
        at = print_text(at, "v ");
        at = object_.precision == Precision::f64 ? print_triple(at, &chunk.positions_f64[3 * i])
                                                 : print_triple(at, &chunk.positions[3 * i]);
        *at++ = '\n';
        return at;
      });
  piece.take_made();
}

void ObjSink::print_normals(const MeshChunk& chunk, Piece& piece) const {
  make_lines(chunk.normals.size() / 3, kNormalLine, piece.made, [&](std::size_t i, char* at) {
    at = print_triple(print_text(at, "vn "), &chunk.normals[3 * i]);
    *at++ = '\n';
    return at;
  });
  piece.take_made();
}

void ObjSink::print_faces(const MeshChunk& chunk, Piece& piece) const {
  const bool one_id = object_.has_normals && first_normal_ == first_vertex_;
  make_lines(chunk.n_triangles(), kFaceLine, piece.made, [&](std::size_t i, char* at) {
    *at++ = 'f';
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint64_t id = chunk.index_base + chunk.indices[3 * i + c];
      *at++ = ' ';
      const char* const vertex = at;
      at = print_number(at, first_vertex_ + id);
      if (one_id) {
        const auto n = static_cast<std::size_t>(at - vertex);
        std::array<char, kMostDigits> digits;  // a fixed length is no call
        std::memcpy(digits.data(), vertex, digits.size());
        std::memcpy(print_text(at, "//"), digits.data(), digits.size());
        at += 2 + n;
      } else if (object_.has_normals) {
        at = print_number(print_text(at, "//"), first_normal_ + id);
      }
    }
    *at++ = '\n';
    return at;
  });
  piece.take_made();
}

void ObjSink::format(const MeshChunk& chunk, std::size_t slot) {
  print_vertices(chunk, slots_[slot].vertices);
  print_normals(chunk, slots_[slot].normals);
  print_faces(chunk, slots_[slot].faces);
}

void ObjSink::place(const MeshChunk& chunk, std::size_t slot) {
  counts_.add(object_, chunk);
  vertices_->place(slots_[slot].vertices);
  normals_->place(slots_[slot].normals);
  faces_->place(slots_[slot].faces);
}

void ObjSink::write(const MeshChunk& /*chunk*/, std::size_t slot) {
  vertices_->write(slots_[slot].vertices);
  normals_->write(slots_[slot].normals);
  faces_->write(slots_[slot].faces);
}

void ObjSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
  vertices_->end();
  normals_->end();
  faces_->end();
  normal_spool_->copy_to(out_);
  face_spool_->copy_to(out_);
  normal_spool_.reset();
  face_spool_.reset();
  first_vertex_ += counts_.n_vertices;
  first_normal_ += object_.has_normals ? counts_.n_vertices : 0;
}

}  // namespace

MeshNeeds obj_needs(const SinkOptions& /*options*/, bool f32_moves) {
  const Precision precision = f32_moves ? Precision::f64 : Precision::f32;
  return {
      .precision = precision,
      .formatted = {static_cast<std::uint32_t>(vertex_line(precision).usual + kNormalLine.usual),
                    static_cast<std::uint32_t>(kFaceLine.usual)}};
}

std::unique_ptr<MeshSink> open_obj(const std::string& path, const SinkOptions& options) {
  return std::make_unique<ObjSink>(path, options);
}

}  // namespace mc::sink
