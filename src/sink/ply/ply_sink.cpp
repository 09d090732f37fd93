// SPDX-License-Identifier: MIT
#include "sink/ply/ply_sink.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <vector>

#include "field/attributes.hpp"
#include "sink/attribute_columns.hpp"
#include "sink/formats.hpp"
#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/part.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// PLY 1.0 (G. Turk, 1994): header, all vertices, all faces. The header has one width whatever the
// counts are, so that it can be written first and patched; the bytes are the same for a file and a
// stream, with counts known beforehand or not, and for any cut into chunks.

namespace mc::sink {

namespace {

constexpr std::size_t kFaceBytes = 13;  // uchar 3, three indices

constexpr std::size_t kNormalBytes = 12;

/// Of the text form, with normals.
constexpr LineBytes vertex_line(Precision precision) {
  return {2 * kMostTriple + 2,
          (precision == Precision::f64 ? kMostTriple : kFloatTriple) + kFloatTriple + 2};
}
/// Characters that a number of an attribute takes with a space before it: at most, but of
/// floating-point numbers what is usual.
constexpr std::size_t usual_digits(SampleType type) {
  switch (type) {
    case SampleType::u8:
    case SampleType::i8:
      return 5;
    case SampleType::u16:
    case SampleType::i16:
      return 7;
    case SampleType::u32:
    case SampleType::i32:
      return 12;
    case SampleType::f16:
    case SampleType::f32:
      return 16;
    case SampleType::i64:
    case SampleType::f64:
      return 25;
  }
  return 25;
}
LineBytes vertex_line(const MeshObject& object) {
  LineBytes line = vertex_line(object.precision);
  for (const AttributeInfo& attribute : object.attributes) {
    line.most += attribute.n_components * (kMostDigits + 1);
    line.usual += attribute.n_components * usual_digits(attribute.type);
  }
  return line;
}
constexpr LineBytes kFaceLine{kMostTriple + 3, kIdTriple + 3};

/// The type of an attribute's properties. PLY has no halves, which floats hold exactly.
SampleType stored_type(const AttributeInfo& attribute) {
  return attribute.type == SampleType::f16 ? SampleType::f32 : attribute.type;
}

std::size_t stored_bytes(const AttributeInfo& attribute) {
  return attribute.n_components * sample_size(stored_type(attribute));
}

const char* property_type(SampleType type) {
  switch (type) {
    case SampleType::u8:
      return "uchar";
    case SampleType::i8:
      return "char";
    case SampleType::u16:
      return "ushort";
    case SampleType::i16:
      return "short";
    case SampleType::u32:
      return "uint";
    case SampleType::i32:
      return "int";
    case SampleType::f64:
      return "double";
    default:
      return "float";
  }
}

/// "property float heat\n".
std::string properties_of(const AttributeInfo& attribute) {
  std::string text;
  for (std::size_t c = 0; c < attribute.n_components; ++c) {
    text += std::string("property ") + property_type(stored_type(attribute)) + " " +
            field::component_name(attribute, c) + "\n";
  }
  return text;
}

constexpr std::size_t position_bytes(Precision precision) {
  return precision == Precision::f64 ? 24 : 12;
}

/// What is made of a chunk's vertices and triangles.
Formatted formatted(Precision precision, bool ascii) {
  if (ascii) {
    return {static_cast<std::uint32_t>(vertex_line(precision).usual),
            static_cast<std::uint32_t>(kFaceLine.usual)};
  }
  return {static_cast<std::uint32_t>(position_bytes(precision) + kNormalBytes), kFaceBytes};
}

/// Makes faces. Ids fit 32 bits: more than 2^32 vertices are refused.
auto face_encoder(const MeshChunk& chunk) {
  return [&chunk](std::size_t first, std::size_t last, std::byte* at) {
    const auto base = static_cast<std::uint32_t>(chunk.index_base);
    const std::uint32_t* index = chunk.indices.data() + 3 * first;
    // Two whole words, of which the next face overwrites three bytes. Built in registers: a copy on
    // the stack would be stored in three parts and loaded in two, which waits for the stores.
    for (std::size_t t = first; t < last; ++t, index += 3, at += kFaceBytes) {
      const std::uint64_t id[3] = {base + index[0], base + index[1], base + index[2]};
      const std::uint64_t low = 3 | id[0] << 8 | id[1] << 40;
      const std::uint64_t high = id[1] >> 24 | id[2] << 8;
      std::memcpy(at, &low, sizeof low);
      std::memcpy(at + sizeof low, &high, sizeof high);
    }
  };
}

class PlySink final : public MeshSink {
 public:
  PlySink(const std::string& path, const SinkOptions& options, const PlyLimits& limits)
      : options_(options), limits_(limits), out_(path, output_options(options, !options.ascii)) {}

  void set_slots(std::size_t n_slots) override { slots_.resize(n_slots); }
  void begin_object(const MeshObject& object) override;
  void format(const MeshChunk& chunk, std::size_t slot) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  [[nodiscard]] std::string header(const ObjectCounts& counts) const;
  [[nodiscard]] std::string unpadded_header(const ObjectCounts& counts) const;
  [[nodiscard]] std::size_t attribute_bytes() const;
  [[nodiscard]] std::size_t vertex_bytes() const;
  void check_vertices(std::uint64_t n) const;
  void print_vertices(const MeshChunk& chunk, Piece& piece) const;
  void print_faces(const MeshChunk& chunk, Piece& piece) const;
  [[nodiscard]] auto vertex_encoder(const MeshChunk& chunk) const;
  [[nodiscard]] bool has_plain_positions() const;

  struct Slot {
    Piece vertices, faces;
  };

  SinkOptions options_;
  PlyLimits limits_;
  OutputFile out_;
  MeshObject object_;
  bool begun_ = false;
  ObjectCounts counts_;
  std::optional<SpoolFile> vertex_spool_;  // only to a stream whose counts come last
  std::optional<SpoolFile> face_spool_;    // unless their place is known
  std::optional<Part> vertices_, faces_;
  std::vector<Slot> slots_{1};
};

std::size_t PlySink::attribute_bytes() const {
  std::size_t sum = 0;
  for (const AttributeInfo& attribute : object_.attributes) sum += stored_bytes(attribute);
  return sum;
}

std::size_t PlySink::vertex_bytes() const {
  return position_bytes(object_.precision) + (object_.has_normals ? kNormalBytes : 0) +
         attribute_bytes();
}

void PlySink::check_vertices(std::uint64_t n) const {
  check_limit(out_.place(), n, "vertices", "PLY", limits_.most_vertices,
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
  for (const AttributeInfo& attribute : object_.attributes) {
    text += properties_of(attribute);
  }
  text += "element face " + std::to_string(counts.n_triangles) + "\nproperty list uchar ";
  text += counts.n_vertices > limits_.most_int_vertices ? "uint" : "int";
  return text + " vertex_indices\n";
}

/// The header, filled up to the width of the longest counts by a comment of spaces (readers agree
/// on comments, but not on spaces or zeros around a count).
std::string PlySink::header(const ObjectCounts& counts) const {
  constexpr std::string_view kComment = "comment ";
  constexpr std::string_view kEnd = "\nend_header\n";
  const std::size_t widest =
      unpadded_header({PlyLimits{}.most_vertices, ~std::uint64_t{0}}).size() + kComment.size() +
      kEnd.size();
  const std::size_t width = (widest + 7) / 8 * 8;  // doubles that follow are aligned
  std::string text = unpadded_header(counts).append(kComment);
  text.append(width - text.size() - kEnd.size(), ' ').append(kEnd);
  return text;
}

void PlySink::begin_object(const MeshObject& object) {
  if (begun_) {
    refuse_second_object(kPlyFormat, out_.place());
  }
  for (const AttributeInfo& attribute : object.attributes) {
    if (ply_attribute_bytes(attribute, options_) != 0) continue;
    throw Error(ErrorKind::usage, out_.place(),
                "PLY has no " + std::string(sample_name(attribute.type)) + " for the attribute " +
                    attribute.name,
                "write .glb");
  }
  object_ = object;
  begun_ = true;
  check_vertices(object.n_vertices.value_or(0));
  const bool known = counts_known(object);
  if (out_.seekable() || known) {
    out_.append(header({object.n_vertices.value_or(0), object.n_triangles.value_or(0)}));
    vertices_.emplace(out_.writer(), out_.size());
  } else {
    vertices_.emplace(vertex_spool_.emplace(out_).writer(), 0);
  }
  if (out_.seekable() && known && !options_.ascii) {
    faces_.emplace(out_.writer(), out_.size() + *object.n_vertices * vertex_bytes());
  } else {
    faces_.emplace(face_spool_.emplace(out_).writer(), 0);
  }
}

void PlySink::print_vertices(const MeshChunk& chunk, Piece& piece) const {
  make_lines(chunk.n_vertices(), vertex_line(object_), piece.made, [&](std::size_t i, char* at) {
    at = object_.precision == Precision::f64 ? print_triple(at, &chunk.positions_f64[3 * i])
                                             : print_triple(at, &chunk.positions[3 * i]);
    if (object_.has_normals) {
      *at++ = ' ';
      at = print_triple(at, &chunk.normals[3 * i]);
    }
    for (const VertexAttribute& attribute : chunk.attributes) {
      at = print_attribute(at, attribute, i);
    }
    *at++ = '\n';
    return at;
  });
  piece.take_made();
}

void PlySink::print_faces(const MeshChunk& chunk, Piece& piece) const {
  make_lines(chunk.n_triangles(), kFaceLine, piece.made, [&](std::size_t i, char* at) {
    std::array<std::uint64_t, 3> ids{};
    for (std::size_t c = 0; c < 3; ++c) ids[c] = chunk.index_base + chunk.indices[3 * i + c];
    at = print_triple(print_text(at, "3 "), ids.data());
    *at++ = '\n';
    return at;
  });
  piece.take_made();
}

/// Whether a vertex is no more than its position, as chunks hold it.
bool PlySink::has_plain_positions() const {
  return !object_.has_normals && object_.attributes.empty();
}

auto PlySink::vertex_encoder(const MeshChunk& chunk) const {
  return [this, &chunk](std::size_t first, std::size_t last, std::byte* to) {
    put_vertices(chunk, first, last, attribute_bytes(), to);
    to += vertex_bytes() - attribute_bytes();
    for (const VertexAttribute& attribute : chunk.attributes) {
      put_attribute(attribute, {first, last}, attribute.info.type == SampleType::f16, to,
                    vertex_bytes());
      to += stored_bytes(attribute.info);
    }
  };
}

void PlySink::format(const MeshChunk& chunk, std::size_t slot) {
  auto& [vertices, faces] = slots_[slot];
  if (options_.ascii) {
    print_vertices(chunk, vertices);
    return print_faces(chunk, faces);
  }
  if (has_plain_positions()) {
    object_.precision == Precision::f64 ? vertices.take(chunk.positions_f64)
                                        : vertices.take(chunk.positions);
  } else {
    vertices_->format_records(chunk.n_vertices(), vertex_bytes(), vertices, vertex_encoder(chunk));
  }
  faces_->format_records(chunk.n_triangles(), kFaceBytes, faces, face_encoder(chunk));
}

void PlySink::place(const MeshChunk& chunk, std::size_t slot) {
  counts_.add(object_, chunk);
  check_vertices(counts_.n_vertices);
  vertices_->place(slots_[slot].vertices);
  faces_->place(slots_[slot].faces);
}

void PlySink::write(const MeshChunk& chunk, std::size_t slot) {
  auto& [vertices, faces] = slots_[slot];
  if (options_.ascii || has_plain_positions()) {
    vertices_->write(vertices);
  } else {
    vertices_->write_records(chunk.n_vertices(), vertex_bytes(), vertices, vertex_encoder(chunk));
  }
  if (options_.ascii) return faces_->write(faces);
  faces_->write_records(chunk.n_triangles(), kFaceBytes, faces, face_encoder(chunk));
}

void PlySink::end_object(const MeshTotals& /*totals*/) {
  check_announced(out_.place(), object_, counts_);
  vertices_->end();
  faces_->end();
}

void PlySink::finish() {
  if (!begun_) {
    begin_object({});
  }
  if (vertex_spool_) {
    out_.append(header(counts_));
    vertex_spool_->copy_to(out_);
  }
  if (face_spool_) {
    face_spool_->copy_to(out_);
  }
  if (out_.seekable()) {
    const std::string text = header(counts_);
    out_.write_at(0, std::as_bytes(std::span(text)));
  }
  out_.commit();
}

}  // namespace

MeshNeeds ply_needs(const SinkOptions& options, bool f32_moves) {
  const Precision precision =
      options.precision.value_or(f32_moves ? Precision::f64 : Precision::f32);
  return {.precision = precision, .formatted = formatted(precision, options.ascii)};
}

std::size_t ply_attribute_bytes(const AttributeInfo& attribute, const SinkOptions& options) {
  if (attribute.type == SampleType::i64) return 0;
  return options.ascii ? attribute.n_components * usual_digits(attribute.type)
                       : stored_bytes(attribute);
}

std::unique_ptr<MeshSink> open_ply(const std::string& path, const SinkOptions& options) {
  return open_ply_of(path, options, {});
}

std::unique_ptr<MeshSink> open_ply_of(const std::string& path, const SinkOptions& options,
                                      const PlyLimits& limits) {
  return std::make_unique<PlySink>(path, options, limits);
}

}  // namespace mc::sink
