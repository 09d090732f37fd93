// SPDX-License-Identifier: MIT
#include "sink/obj/obj_sink.hpp"

#include <algorithm>
#include <cassert>
#include <optional>

#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// Wavefront OBJ: of every object all `v`, then all `vn`, then all `f`; indices start at 1 and run
// on through the file. No count comes first, so `v` lines go out as they come, to a stream as well;
// the other two are spooled. Numbers are the shortest that read back the same.

namespace mc::sink {

namespace {

class ObjSink final : public MeshSink {
 public:
  ObjSink(const std::string& path, const SinkOptions& options)
      : out_(path, {.force = options.force, .binary = false}) {
    for (const auto& [key, value] : options.provenance) {
      out_.append("# " + on_one_line(key) + ": " + on_one_line(value) + "\n");
    }
  }

  void begin_object(const MeshObject& object) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override { out_.commit(); }

 private:
  void write_vertices(const MeshChunk& chunk);
  void write_faces(const MeshChunk& chunk);

  OutputFile out_;
  MeshObject object_;
  ObjectCounts counts_;
  std::uint64_t first_vertex_ = 1;  // of this object, as `f` lines name it
  std::uint64_t first_normal_ = 1;  // less than first_vertex_ after an object without normals
  std::optional<SpoolFile> normals_, faces_;
  std::string lines_;
};

void ObjSink::begin_object(const MeshObject& object) {
  object_ = object;
  counts_ = {};
  normals_.emplace(out_);
  faces_.emplace(out_);
  if (!object.name.empty()) {
    std::string name = on_one_line(object.name);  // many readers end a name at the first space
    std::replace(name.begin(), name.end(), ' ', '_');
    out_.append("o " + name + "\n");
  }
}

void ObjSink::write_vertices(const MeshChunk& chunk) {
  put_lines(
      chunk.n_vertices(), lines_,
      [&](std::size_t i, std::string& text) {
        text += 'v';
        if (object_.precision == Precision::f64) {
          append_triple(text, &chunk.positions_f64[3 * i]);
        } else {
          append_triple(text, &chunk.positions[3 * i]);
        }
        text += '\n';
      },
      [this](std::span<const std::byte> bytes) { out_.append(bytes); });
  if (object_.has_normals) {
    put_lines(
        chunk.n_vertices(), lines_,
        [&](std::size_t i, std::string& text) {
          text += "vn";
          append_triple(text, &chunk.normals[3 * i]);
          text += '\n';
        },
        [this](std::span<const std::byte> bytes) { normals_->append(bytes); });
  }
}

void ObjSink::write_faces(const MeshChunk& chunk) {
  put_lines(
      chunk.n_triangles(), lines_,
      [&](std::size_t i, std::string& text) {
        text += 'f';
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint64_t id = chunk.index_base + chunk.indices[3 * i + c];
          text += ' ';
          append_number(text, first_vertex_ + id);
          if (object_.has_normals) {
            text += "//";
            append_number(text, first_normal_ + id);
          }
        }
        text += '\n';
      },
      [this](std::span<const std::byte> bytes) { faces_->append(bytes); });
}

void ObjSink::place(const MeshChunk& chunk, std::size_t /*slot*/) {
  assert(faces_);
  counts_.add(object_, chunk);
  write_vertices(chunk);
  write_faces(chunk);
}

void ObjSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
  normals_->copy_to(out_);
  faces_->copy_to(out_);
  normals_.reset();
  faces_.reset();
  first_vertex_ += counts_.n_vertices;
  first_normal_ += object_.has_normals ? counts_.n_vertices : 0;
}

}  // namespace

std::unique_ptr<MeshSink> open_obj(const std::string& path, const SinkOptions& options) {
  return std::make_unique<ObjSink>(path, options);
}

}  // namespace mc::sink
