// SPDX-License-Identifier: MIT
#include "sink/ply/ply_sink.hpp"

#include <array>
#include <cassert>
#include <cstring>
#include <optional>

#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// PLY 1.0 (G. Turk, 1994): header, all vertices, all faces. The header has one width whatever the
// counts are, so that it can be written first and patched; the bytes are the same for a file and a
// stream, with counts known beforehand or not, and for any cut into chunks.

namespace mc::sink {

namespace {

constexpr std::uint64_t kMostVertices = std::uint64_t{1} << 32;     // of a `uint` index
constexpr std::uint64_t kMostIntVertices = std::uint64_t{1} << 31;  // of an `int` index
constexpr std::size_t kFaceBytes = 13;                              // uchar 3, three indices

class PlySink final : public MeshSink {
 public:
  PlySink(const std::string& path, const SinkOptions& options)
      : options_(options), out_(path, {.force = options.force, .binary = !options.ascii}) {}

  void begin_object(const MeshObject& object) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  [[nodiscard]] std::string header(const ObjectCounts& counts) const;
  [[nodiscard]] std::string unpadded_header(const ObjectCounts& counts) const;
  [[nodiscard]] std::size_t vertex_bytes() const;
  void check_vertices(std::uint64_t n) const;
  void write_vertices(const MeshChunk& chunk);
  void write_faces(const MeshChunk& chunk);
  void put_vertices(std::span<const std::byte> bytes);
  void put_faces(std::span<const std::byte> bytes);

  SinkOptions options_;
  OutputFile out_;
  MeshObject object_;
  bool begun_ = false;
  ObjectCounts counts_;
  std::optional<SpoolFile> vertices_;  // only to a stream whose counts come last
  std::optional<SpoolFile> faces_;     // unless their place is known
  std::uint64_t faces_at_ = 0;         // where the next face goes, unless spooled
  Buffer<std::byte> block_;
  std::string lines_;
};

std::size_t PlySink::vertex_bytes() const {
  const std::size_t coordinate = object_.precision == Precision::f64 ? 8 : 4;
  return 3 * coordinate + (object_.has_normals ? 12 : 0);
}

void PlySink::check_vertices(std::uint64_t n) const {
  check_limit(out_.place(), n, "vertices", "PLY", kMostVertices,
              "write .obj, or one --region at a time");
}

std::string PlySink::unpadded_header(const ObjectCounts& counts) const {
  std::string text = "ply\nformat ";
  text += options_.ascii ? "ascii 1.0\n" : "binary_little_endian 1.0\n";
  for (const auto& [key, value] : options_.provenance) {
    text += "comment " + on_one_line(key) + ": " + on_one_line(value) + "\n";
  }
  text += "element vertex " + std::to_string(counts.n_vertices) + "\n";
  const std::string type = object_.precision == Precision::f64 ? "double" : "float";
  for (const char* name : {"x", "y", "z"}) {
    text += "property " + type + " " + name + "\n";
  }
  if (object_.has_normals) {
    text += "property float nx\nproperty float ny\nproperty float nz\n";
  }
  text += "element face " + std::to_string(counts.n_triangles) + "\nproperty list uchar ";
  text += counts.n_vertices > kMostIntVertices ? "uint" : "int";
  return text + " vertex_indices\n";
}

/// The header, filled up to the width of the longest counts by a comment of spaces (readers agree
/// on comments, but not on spaces or zeros around a count).
std::string PlySink::header(const ObjectCounts& counts) const {
  constexpr std::string_view kComment = "comment ";
  constexpr std::string_view kEnd = "\nend_header\n";
  const std::size_t widest =
      unpadded_header({kMostVertices, ~std::uint64_t{0}}).size() + kComment.size() + kEnd.size();
  const std::size_t width = (widest + 7) / 8 * 8;  // doubles that follow are aligned
  std::string text = unpadded_header(counts).append(kComment);
  text.append(width - text.size() - kEnd.size(), ' ').append(kEnd);
  return text;
}

void PlySink::begin_object(const MeshObject& object) {
  if (begun_) {
    throw Error(ErrorKind::usage, out_.place(), "PLY holds one mesh, but there are several",
                "write .glb, .gltf or .obj, or one iso a file");
  }
  object_ = object;
  begun_ = true;
  check_vertices(object.n_vertices.value_or(0));
  const bool known = counts_known(object);
  if (out_.seekable() || known) {
    out_.append(header({object.n_vertices.value_or(0), object.n_triangles.value_or(0)}));
  } else {
    vertices_.emplace(out_);
  }
  if (out_.seekable() && known && !options_.ascii) {
    faces_at_ = out_.size() + *object.n_vertices * vertex_bytes();
  } else {
    faces_.emplace(out_);
  }
}

void PlySink::put_vertices(std::span<const std::byte> bytes) {
  if (vertices_) {
    vertices_->append(bytes);
  } else {
    out_.append(bytes);
  }
}

void PlySink::put_faces(std::span<const std::byte> bytes) {
  if (faces_) {
    faces_->append(bytes);
  } else {
    out_.write_at(faces_at_, bytes);
    faces_at_ += bytes.size();
  }
}

void PlySink::write_vertices(const MeshChunk& chunk) {
  const auto put = [this](std::span<const std::byte> bytes) { put_vertices(bytes); };
  if (!options_.ascii) {
    put_records(
        chunk.n_vertices(), vertex_bytes(), block_,
        [&](std::size_t i, std::byte* at) { encode_vertex(chunk, object_.has_normals, i, at); },
        put);
    return;
  }
  put_lines(
      chunk.n_vertices(), lines_,
      [&](std::size_t i, std::string& text) {
        const std::size_t line = text.size();
        if (object_.precision == Precision::f64) {
          append_triple(text, &chunk.positions_f64[3 * i]);
        } else {
          append_triple(text, &chunk.positions[3 * i]);
        }
        if (object_.has_normals) {
          append_triple(text, &chunk.normals[3 * i]);
        }
        text.erase(line, 1) += '\n';
      },
      put);
}

void PlySink::write_faces(const MeshChunk& chunk) {
  const auto put = [this](std::span<const std::byte> bytes) { put_faces(bytes); };
  const auto ids = [&](std::size_t i) {
    std::array<std::uint32_t, 3> three{};  // fits: more than 2^32 vertices were refused
    for (std::size_t c = 0; c < 3; ++c) {
      three[c] = static_cast<std::uint32_t>(chunk.index_base + chunk.indices[3 * i + c]);
    }
    return three;
  };
  if (!options_.ascii) {
    put_records(
        chunk.n_triangles(), kFaceBytes, block_,
        [&](std::size_t i, std::byte* at) {
          const auto three = ids(i);
          *at = std::byte{3};
          std::memcpy(at + 1, three.data(), sizeof three);
        },
        put);
    return;
  }
  put_lines(
      chunk.n_triangles(), lines_,
      [&](std::size_t i, std::string& text) {
        text += '3';
        append_triple(text, ids(i).data());
        text += '\n';
      },
      put);
}

void PlySink::place(const MeshChunk& chunk, std::size_t /*slot*/) {
  assert(begun_);
  counts_.add(object_, chunk);
  check_vertices(counts_.n_vertices);
  write_vertices(chunk);
  write_faces(chunk);
}

void PlySink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
}

void PlySink::finish() {
  if (!begun_) {
    begin_object({});
  }
  if (vertices_) {
    out_.append(header(counts_));
    vertices_->copy_to(out_);
  }
  if (faces_) {
    faces_->copy_to(out_);
  }
  if (out_.seekable()) {
    const std::string text = header(counts_);
    out_.write_at(0, std::as_bytes(std::span(text)));
  }
  out_.commit();
}

}  // namespace

std::unique_ptr<MeshSink> open_ply(const std::string& path, const SinkOptions& options) {
  return std::make_unique<PlySink>(path, options);
}

}  // namespace mc::sink
