// SPDX-License-Identifier: MIT
#include "sink/gltf/gltf_sink.hpp"

#if MC_WITH_GLTF

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "sink/attribute_columns.hpp"
#include "sink/gltf/gltf_bins.hpp"
#include "sink/gltf/gltf_json.hpp"
#include "sink/gltf/palette.hpp"
#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/part.hpp"
#include "sink/records.hpp"

// glTF 2.0 (Khronos; ISO/IEC 12113): per object one interleaved view of positions, normals and
// attributes, then its indices. A GLB has its JSON before the buffer, so room for the JSON of one
// object is kept, filled with spaces, and patched at the end; more objects than that move the
// buffer up once. The bytes are the same for a file and a stream, with counts known or not, and for
// any cut into chunks.

namespace mc::sink {

namespace {

constexpr std::uint64_t kMostGlbBytes = 0xFFFFFFFF;
constexpr std::uint64_t kMostBinBytes = 0xFFFFFFFC;  // readers count them in 32 bits
constexpr std::uint64_t kMostVertices = 0xFFFFFFFF;  // index 0xFFFFFFFF is reserved
constexpr std::uint64_t kMostVertexBytes = 252;      // of a buffer view's byteStride
constexpr std::size_t kFileHeader = 12, kChunkHeader = 8;

std::uint64_t aligned(std::uint64_t n_bytes) { return (n_bytes + 3) / 4 * 4; }

/// 32 bits, little endian.
std::string word(std::uint64_t value) {
  const auto low = static_cast<std::uint32_t>(value);
  std::string bytes(sizeof low, '\0');
  std::memcpy(bytes.data(), &low, sizeof low);
  return bytes;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span<const char>(text));
}

std::array<float, 3> filled(float x) { return {x, x, x}; }

class GltfSink final : public MeshSink {
 public:
  enum class Form : bool { gltf, glb };
  /// Files of at most `most_bytes`; the JSON of glTF does not count.
  GltfSink(const std::string& path, const SinkOptions& options, Form form,
           std::uint64_t most_bytes);

  void set_slots(std::size_t n_slots) override { slots_.resize(n_slots); }
  void begin_object(const MeshObject& object) override;
  void format(const MeshChunk& chunk, std::size_t slot) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  void reserve_json(const GltfObject& first);
  void check_limits(const ObjectCounts& counts) const;
  void check_vertex_bytes(const GltfObject& object) const;
  void note_rounded(const MeshObject& object) const;
  void warn_of_not_finite() const;
  std::uint64_t put_attributes(const MeshChunk& chunk, const VertexRange& vertices,
                               std::byte* to) const;
  [[nodiscard]] auto vertex_encoder(const MeshChunk& chunk, std::uint64_t& n_not_finite) const;
  template <class Call>
  void with_index_type(Call call) const;
  [[nodiscard]] bool has_plain_positions() const;
  void take_spooled_indices();
  void shorten_spooled_indices();
  void finish_glb();
  void finish_gltf();
  void pad_body();
  /// The file that the buffer goes into.
  [[nodiscard]] FileWriter& body_file();
  [[nodiscard]] std::uint64_t body_size();

  struct Slot {
    Piece vertices, indices;
    std::array<float, 3> lo{}, hi{};  // of the chunk's positions
    std::uint64_t n_not_finite = 0;   // numbers of attributes, of all chunks of this object
  };

  SinkOptions options_;
  bool is_glb_;
  std::uint64_t most_bytes_;
  OutputFile main_;                // the GLB, or the JSON
  std::optional<BinFiles> bins_;   // of a glTF
  std::optional<SpoolFile> body_;  // the buffer, for a GLB to a stream
  std::uint64_t body_at_ = 0;      // where the buffer starts in its file
  std::uint64_t json_room_ = 0;
  std::vector<GltfObject> objects_;
  MeshObject object_;
  ObjectCounts counts_;
  std::uint64_t n_not_finite_ = 0;
  std::optional<SpoolFile> index_spool_;  // u32; unless their place and type are known
  std::optional<Part> vertices_, indices_;
  std::vector<Slot> slots_{1};
};

GltfSink::GltfSink(const std::string& path, const SinkOptions& options, Form form,
                   std::uint64_t most_bytes)
    : options_(options),
      is_glb_(form == Form::glb),
      most_bytes_(most_bytes),
      main_(path, output_options(options, is_glb_)) {
  if (!is_glb_) {
    if (!main_.seekable()) {
      throw Error(ErrorKind::usage, main_.place(),
                  "glTF is two files and cannot be written to a stream", "use --to glb");
    }
    bins_.emplace(main_.place(), options_, most_bytes_);
  } else if (!main_.seekable()) {
    body_.emplace(main_);
  }
}

FileWriter& GltfSink::body_file() {
  if (bins_) return bins_->writer();
  return body_ ? body_->writer() : main_.writer();
}

std::uint64_t GltfSink::body_size() { return body_file().size() - body_at_; }

void GltfSink::pad_body() {
  constexpr std::array<std::byte, 4> kZeros{};
  const std::uint64_t n_bytes = aligned(body_size()) - body_size();
  body_file().append(std::span(kZeros).first(static_cast<std::size_t>(n_bytes)));
}

/// Keeps room for JSON with one object like `first` and the longest numbers there are.
void GltfSink::reserve_json(const GltfObject& first) {
  GltfObject widest = first;
  widest.n_vertices = widest.n_indices = widest.vertices_at = widest.indices_at = kMostGlbBytes;
  widest.lo.fill(std::numeric_limits<float>::lowest());
  widest.hi.fill(std::numeric_limits<float>::lowest());
  json_room_ =
      aligned(gltf_json({&widest, 1}, {{{.n_bytes = kMostGlbBytes}}}, options_.provenance).size());
  if (!body_) {
    body_at_ = kFileHeader + kChunkHeader + json_room_ + kChunkHeader;
    main_.skip(body_at_);
  }
}

void GltfSink::check_limits(const ObjectCounts& counts) const {
  const std::string& place = main_.place();
  check_limit(place, counts.n_vertices, "vertices", "a glTF primitive", kMostVertices,
              "write .ply, or one --region at a time");
  if (is_glb_) {
    GltfObject object = objects_.back();
    object.n_vertices = counts.n_vertices;
    const std::uint64_t n_bytes = kFileHeader + 2 * kChunkHeader + json_room_ + object.vertices_at +
                                  counts.n_vertices * object.vertex_bytes();
    // Compared by division, since an announced count may be anything.
    const std::uint64_t indices = 3 * object.index_bytes();
    if (n_bytes > most_bytes_ || counts.n_triangles > (most_bytes_ - n_bytes) / indices) {
      throw Error(ErrorKind::limit, place,
                  std::to_string(counts.n_vertices) + " vertices and " +
                      std::to_string(counts.n_triangles) + " triangles, but a GLB holds at most " +
                      std::to_string(most_bytes_) + " bytes",
                  "write .gltf or .ply");
    }
  }
}

void GltfSink::check_vertex_bytes(const GltfObject& object) const {
  check_limit(main_.place(), object.vertex_bytes(), "bytes a vertex", "glTF", kMostVertexBytes,
              "write .ply, or fewer attributes");
}

/// Says which attributes a float may not hold exactly.
void GltfSink::note_rounded(const MeshObject& object) const {
  if (options_.progress == nullptr) return;
  for (const AttributeInfo& attribute : object.attributes) {
    if (!becomes_float(attribute.type) || attribute.type == SampleType::f16) continue;
    options_.progress->warn(main_.place() + ": glTF has no " + sample_name(attribute.type) +
                            " for vertices, so " + attribute.name + " is rounded to f32");
  }
}

void GltfSink::warn_of_not_finite() const {
  if (n_not_finite_ == 0 || options_.progress == nullptr) return;
  options_.progress->warn(main_.place() + ": " + std::to_string(n_not_finite_) +
                          " numbers of attributes are not finite, which glTF forbids: 0 instead");
}

void GltfSink::begin_object(const MeshObject& object) {
  assert(object.precision == Precision::f32);
  object_ = object;
  counts_ = {};
  GltfObject made;
  made.name = object.name;
  made.origin = object.origin;
  made.has_normals = object.has_normals;
  made.attributes = object.attributes;
  check_vertex_bytes(made);
  note_rounded(object);
  made.lo = filled(std::numeric_limits<float>::infinity());
  made.hi = filled(-std::numeric_limits<float>::infinity());
  if (is_glb_ && objects_.empty()) {
    reserve_json(made);
  }
  pad_body();
  made.vertices_at = body_size();
  made.buffer = bins_ ? bins_->last() : 0;
  objects_.push_back(made);
  check_limits({object.n_vertices.value_or(0), object.n_triangles.value_or(0)});
  vertices_.emplace(body_file(), body_file().size());
  if (body_ || !counts_known(object)) {
    indices_.emplace(index_spool_.emplace(main_).writer(), 0);
  } else {
    objects_.back().n_vertices = *object.n_vertices;
    indices_.emplace(body_file(), body_file().size() + *object.n_vertices * made.vertex_bytes());
  }
}

/// Calls with the type that indices get, where that is known, else with u32.
template <class Call>
void GltfSink::with_index_type(Call call) const {
  if (!index_spool_ && objects_.back().has_short_indices()) {
    call(std::uint16_t{});
  } else {
    call(std::uint32_t{});
  }
}

/// Returns how many numbers are not finite, which the format forbids.
std::uint64_t GltfSink::put_attributes(const MeshChunk& chunk, const VertexRange& vertices,
                                       std::byte* to) const {
  const GltfObject& object = objects_.back();
  const auto stride = static_cast<std::size_t>(object.vertex_bytes());
  const std::size_t n = vertices.last - vertices.first;
  to += object.attributes_at();
  std::uint64_t n_not_finite = 0;
  for (const VertexAttribute& attribute : chunk.attributes) {
    const SampleType type = attribute.info.type;
    put_attribute(attribute, vertices, becomes_float(type), to, stride);
    if (becomes_float(type) || type == SampleType::f32) {
      n_not_finite += zero_not_finite(n, attribute.info.n_components, to, stride);
    }
    if (attribute.info == material_attribute()) {
      std::byte* colour_at = to + kColourAt;
      for (const std::uint16_t index :
           attribute.values_as<std::uint16_t>().subspan(vertices.first, n)) {
        const std::array<std::uint8_t, 4> colour = colour_of(index);
        std::memcpy(colour_at, colour.data(), sizeof colour);
        colour_at += stride;
      }
    }
    to += attribute_bytes(attribute.info);
  }
  return n_not_finite;
}

/// Whether a vertex is no more than its position, as chunks hold it.
bool GltfSink::has_plain_positions() const {
  return !object_.has_normals && object_.attributes.empty();
}

/// Makes vertices, and counts the numbers that are not finite.
auto GltfSink::vertex_encoder(const MeshChunk& chunk, std::uint64_t& n_not_finite) const {
  return [this, &chunk, &n_not_finite](std::size_t first, std::size_t last, std::byte* to) {
    const GltfObject& object = objects_.back();
    put_vertices(chunk, first, last, object.vertex_bytes() - object.attributes_at(), to);
    n_not_finite += put_attributes(chunk, {first, last}, to);
  };
}

void GltfSink::format(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  auto lo = filled(std::numeric_limits<float>::infinity());  // local: they stay in registers
  auto hi = filled(-std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < chunk.positions.size(); i += 3) {
    for (std::size_t a = 0; a < 3; ++a) {
      const float x = chunk.positions[i + a] + 0.0F;  // no negative zero
      lo[a] = std::min(lo[a], x);
      hi[a] = std::max(hi[a], x);
    }
  }
  s.lo = lo;
  s.hi = hi;
  if (has_plain_positions()) {
    s.vertices.take(chunk.positions);
  } else {
    vertices_->format_records(chunk.n_vertices(), objects_.back().vertex_bytes(), s.vertices,
                              vertex_encoder(chunk, s.n_not_finite));
  }
  with_index_type([&]<class Index>(Index /*tag*/) {
    indices_->format_records(chunk.indices.size(), sizeof(Index), s.indices,
                             id_encoder<Index>(chunk));
  });
}

void GltfSink::place(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  counts_.add(object_, chunk);
  check_limits(counts_);
  GltfObject& object = objects_.back();
  for (std::size_t a = 0; a < 3; ++a) {
    object.lo[a] = std::min(object.lo[a], s.lo[a]);
    object.hi[a] = std::max(object.hi[a], s.hi[a]);
  }
  vertices_->place(s.vertices);
  indices_->place(s.indices);
}

void GltfSink::write(const MeshChunk& chunk, std::size_t slot) {
  Slot& s = slots_[slot];
  if (has_plain_positions()) {
    vertices_->write(s.vertices);
  } else {
    vertices_->write_records(chunk.n_vertices(), objects_.back().vertex_bytes(), s.vertices,
                             vertex_encoder(chunk, s.n_not_finite));
  }
  with_index_type([&]<class Index>(Index /*tag*/) {
    indices_->write_records(chunk.indices.size(), sizeof(Index), s.indices,
                            id_encoder<Index>(chunk));
  });
}

/// Appends the spooled indices to the buffer, in the type that turned out to fit.
void GltfSink::take_spooled_indices() {
  if (objects_.back().has_short_indices()) {
    shorten_spooled_indices();
  } else {
    body_file().append_file(index_spool_->writer());
  }
  index_spool_.reset();
}

/// There are few: they name less than 2^16 vertices.
void GltfSink::shorten_spooled_indices() {
  constexpr std::size_t kAtOnce = std::size_t{1} << 16;
  const std::uint64_t n_ids = 3 * counts_.n_triangles;
  Buffer<std::uint32_t> ids(static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, n_ids)));
  Buffer<std::uint16_t> small(ids.size());
  for (std::uint64_t first = 0; first < n_ids; first += ids.size()) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(ids.size(), n_ids - first));
    index_spool_->read(first * sizeof ids[0], std::as_writable_bytes(std::span(ids).first(n)));
    std::transform(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(n), small.begin(),
                   [](std::uint32_t id) { return static_cast<std::uint16_t>(id); });
    body_file().append(std::as_bytes(std::span(small).first(n)));
  }
}

void GltfSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(main_.place(), object_, counts_);
  GltfObject& object = objects_.back();
  object.n_vertices = counts_.n_vertices;
  object.n_indices = 3 * counts_.n_triangles;
  object.indices_at = object.vertices_at + object.n_vertices * object.vertex_bytes();
  vertices_->end();
  indices_->end();
  for (Slot& slot : slots_) n_not_finite_ += std::exchange(slot.n_not_finite, 0);
  if (index_spool_) {
    take_spooled_indices();
  }
  if (bins_ && body_size() > most_bytes_) {
    const std::vector<GltfObject> parts = bins_->spread(object);
    objects_.pop_back();
    objects_.insert(objects_.end(), parts.begin(), parts.end());
  }
}

void GltfSink::finish_glb() {
  const std::uint64_t n_bytes = body_size();
  std::string json = gltf_json(objects_, {{{.n_bytes = n_bytes}}}, options_.provenance);
  const std::uint64_t room = std::max(json_room_, aligned(json.size()));
  json.resize(static_cast<std::size_t>(room), ' ');
  const std::uint64_t bin_bytes = n_bytes == 0 ? 0 : kChunkHeader + aligned(n_bytes);
  const std::uint64_t total = kFileHeader + kChunkHeader + room + bin_bytes;
  check_limit(main_.place(), total, "bytes", "a GLB", most_bytes_, "write .gltf or .ply");
  std::string head = "glTF" + word(2) + word(total) + word(room) + "JSON" + json;
  if (n_bytes != 0) {
    head += word(aligned(n_bytes)) + std::string("BIN\0", 4);
  }
  if (body_ || objects_.empty()) {
    main_.append(head);
    if (body_) {
      pad_body();
      body_->copy_to(main_);
    }
  } else {
    if (n_bytes != 0) {
      pad_body();
      if (room > json_room_) {
        main_.shift(body_at_, room - json_room_);
      }
    }
    main_.write_at(0, bytes_of(head));
  }
  main_.commit();
}

void GltfSink::finish_gltf() {
  main_.append(gltf_json(objects_, bins_->buffers(), options_.provenance));
  std::vector<OutputFile*> files = bins_->files();
  files.push_back(&main_);
  OutputFile::commit_all(files);
  bins_->note_parts();
}

void GltfSink::finish() {
  warn_of_not_finite();
  if (is_glb_) {
    finish_glb();
  } else {
    finish_gltf();
  }
}

}  // namespace

std::unique_ptr<MeshSink> open_glb(const std::string& path, const SinkOptions& options) {
  return open_glb_of(path, options, kMostGlbBytes);
}

std::unique_ptr<MeshSink> open_glb_of(const std::string& path, const SinkOptions& options,
                                      std::uint64_t most_bytes) {
  return std::make_unique<GltfSink>(path, options, GltfSink::Form::glb, most_bytes);
}

std::unique_ptr<MeshSink> open_gltf(const std::string& path, const SinkOptions& options) {
  return open_gltf_of(path, options, kMostBinBytes);
}

std::unique_ptr<MeshSink> open_gltf_of(const std::string& path, const SinkOptions& options,
                                       std::uint64_t most_bytes) {
  return std::make_unique<GltfSink>(path, options, GltfSink::Form::gltf, most_bytes);
}

}  // namespace mc::sink

#endif
