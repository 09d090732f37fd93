// SPDX-License-Identifier: MIT
#include "sink/gltf/gltf_sink.hpp"

#if MC_WITH_GLTF

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "sink/gltf/gltf_json.hpp"
#include "sink/object_counts.hpp"
#include "sink/output_file.hpp"
#include "sink/records.hpp"

// glTF 2.0 (Khronos; ISO/IEC 12113): per object one interleaved view of positions and normals, then
// its indices. A GLB has its JSON before the buffer, so room for the JSON of one object is kept,
// filled with spaces, and patched at the end; more objects than that move the buffer up once. The
// bytes are the same for a file and a stream, with counts known or not, and for any cut into
// chunks.

namespace mc::sink {

namespace {

constexpr std::uint64_t kMostGlbBytes = 0xFFFFFFFF;
constexpr std::uint64_t kMostVertices = 0xFFFFFFFF;  // index 0xFFFFFFFF is reserved
constexpr std::size_t kFileHeader = 12, kChunkHeader = 8;

std::uint64_t aligned(std::uint64_t n_bytes) { return (n_bytes + 3) / 4 * 4; }

std::string percent_encoded(std::string_view name) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri;
  for (const char c : name) {
    if (kPlain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      uri.append({'%', kHex[byte >> 4], kHex[byte & 15]});
    }
  }
  return uri;
}

/// "a/b.gltf" -> "a/b.bin"; another extension stays and ".bin" is added.
std::string bin_path(const std::string& path) {
  constexpr std::string_view kExtension = ".gltf";
  return (path.ends_with(kExtension) ? path.substr(0, path.size() - kExtension.size()) : path) +
         ".bin";
}

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

class GltfSink final : public MeshSink {
 public:
  GltfSink(const std::string& path, const SinkOptions& options, bool is_glb);

  void begin_object(const MeshObject& object) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  void reserve_json(const GltfObject& first);
  void check_limits(const ObjectCounts& counts) const;
  void write_vertices(const MeshChunk& chunk);
  void write_indices(const MeshChunk& chunk);
  void put_indices(std::span<const std::byte> ids);
  void take_spooled_indices();
  void finish_glb();
  void finish_gltf();
  void put_body(std::span<const std::byte> bytes);
  void pad_body();
  [[nodiscard]] std::uint64_t body_size() const;

  SinkOptions options_;
  bool is_glb_;
  OutputFile main_;                // the GLB, or the JSON
  std::optional<OutputFile> bin_;  // glTF only
  std::optional<SpoolFile> body_;  // the buffer, for a GLB to a stream
  std::uint64_t body_at_ = 0;      // where the buffer starts in its file
  std::uint64_t json_room_ = 0;
  std::vector<GltfObject> objects_;
  MeshObject object_;
  ObjectCounts counts_;
  std::optional<SpoolFile> indices_;  // u32; unless their place and type are known
  std::uint64_t indices_at_ = 0;      // where the next goes, unless spooled
  Buffer<std::byte> block_;
};

GltfSink::GltfSink(const std::string& path, const SinkOptions& options, bool is_glb)
    : options_(options), is_glb_(is_glb), main_(path, {.force = options.force, .binary = is_glb}) {
  if (!is_glb) {
    if (!main_.seekable()) {
      throw Error(ErrorKind::usage, main_.place(),
                  "glTF is two files and cannot be written to a stream", "use --to glb");
    }
    bin_.emplace(bin_path(path), OutputFile::Options{.force = options.force});
  } else if (!main_.seekable()) {
    body_.emplace(main_);
  }
}

std::uint64_t GltfSink::body_size() const {
  return body_ ? body_->size() : bin_ ? bin_->size() : main_.size() - body_at_;
}

void GltfSink::put_body(std::span<const std::byte> bytes) {
  if (body_) {
    body_->append(bytes);
  } else {
    (bin_ ? *bin_ : main_).append(bytes);
  }
}

void GltfSink::pad_body() {
  constexpr std::array<std::byte, 4> kZeros{};
  put_body(std::span(kZeros).first(static_cast<std::size_t>(aligned(body_size()) - body_size())));
}

/// Keeps room for JSON with one object like `first` and the longest numbers there are.
void GltfSink::reserve_json(const GltfObject& first) {
  GltfObject widest = first;
  widest.n_vertices = widest.n_indices = widest.vertices_at = widest.indices_at = kMostGlbBytes;
  widest.lo.fill(std::numeric_limits<float>::lowest());
  widest.hi.fill(std::numeric_limits<float>::lowest());
  json_room_ =
      aligned(gltf_json({&widest, 1}, {.n_bytes = kMostGlbBytes}, options_.provenance).size());
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
    if (n_bytes > kMostGlbBytes || counts.n_triangles > (kMostGlbBytes - n_bytes) / indices) {
      throw Error(ErrorKind::limit, place,
                  std::to_string(counts.n_vertices) + " vertices and " +
                      std::to_string(counts.n_triangles) +
                      " triangles, but a GLB holds at most 4294967295 bytes",
                  "write .gltf or .ply");
    }
  }
}

void GltfSink::begin_object(const MeshObject& object) {
  assert(object.precision == Precision::f32);
  object_ = object;
  counts_ = {};
  GltfObject made;
  made.name = object.name;
  made.origin = object.origin;
  made.has_normals = object.has_normals;
  made.lo.fill(std::numeric_limits<float>::infinity());
  made.hi.fill(-std::numeric_limits<float>::infinity());
  if (is_glb_ && objects_.empty()) {
    reserve_json(made);
  }
  pad_body();
  made.vertices_at = body_size();
  objects_.push_back(made);
  check_limits({object.n_vertices.value_or(0), object.n_triangles.value_or(0)});
  indices_.reset();
  if (body_ || !counts_known(object)) {
    indices_.emplace(main_);
  } else {
    objects_.back().n_vertices = *object.n_vertices;
    indices_at_ = made.vertices_at + *object.n_vertices * made.vertex_bytes();
  }
}

void GltfSink::write_vertices(const MeshChunk& chunk) {
  GltfObject& object = objects_.back();
  auto lo = object.lo, hi = object.hi;  // local, so that they stay in registers
  for (std::size_t i = 0; i < chunk.n_vertices(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const float x = chunk.positions[3 * i + a] + 0.0F;  // no negative zero
      lo[a] = std::min(lo[a], x);
      hi[a] = std::max(hi[a], x);
    }
  }
  object.lo = lo;
  object.hi = hi;
  put_records(
      chunk.n_vertices(), static_cast<std::size_t>(object.vertex_bytes()), block_,
      [&](std::size_t i, std::byte* at) { encode_vertex(chunk, object.has_normals, i, at); },
      [this](std::span<const std::byte> bytes) { put_body(bytes); });
}

/// Puts u32 indices where they belong, in the type they get.
void GltfSink::put_indices(std::span<const std::byte> ids) {
  OutputFile& out = bin_ ? *bin_ : main_;
  out.write_at(body_at_ + indices_at_, ids);
  indices_at_ += ids.size();
}

void GltfSink::write_indices(const MeshChunk& chunk) {
  const auto id = [&](std::size_t i) {
    return static_cast<std::uint32_t>(chunk.index_base + chunk.indices[i]);
  };
  if (!indices_ && objects_.back().has_short_indices()) {
    put_records(
        chunk.indices.size(), sizeof(std::uint16_t), block_,
        [&](std::size_t i, std::byte* at) {
          const auto small = static_cast<std::uint16_t>(id(i));
          std::memcpy(at, &small, sizeof small);
        },
        [this](std::span<const std::byte> bytes) { put_indices(bytes); });
    return;
  }
  put_records(
      chunk.indices.size(), sizeof(std::uint32_t), block_,
      [&](std::size_t i, std::byte* at) {
        const std::uint32_t large = id(i);
        std::memcpy(at, &large, sizeof large);
      },
      [this](std::span<const std::byte> bytes) {
        if (indices_) {
          indices_->append(bytes);
        } else {
          put_indices(bytes);
        }
      });
}

void GltfSink::place(const MeshChunk& chunk, std::size_t /*slot*/) {
  assert(!objects_.empty());
  counts_.add(object_, chunk);
  check_limits(counts_);
  write_vertices(chunk);
  write_indices(chunk);
}

/// Appends the spooled indices to the buffer, in the type that turned out to fit.
void GltfSink::take_spooled_indices() {
  const bool is_short = objects_.back().has_short_indices();
  const std::uint64_t n_ids = 3 * counts_.n_triangles;
  Buffer<std::uint32_t> ids(static_cast<std::size_t>(
      std::min<std::uint64_t>(kBlockBytes / sizeof(std::uint32_t), n_ids)));
  for (std::uint64_t first = 0; first < n_ids; first += ids.size()) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(ids.size(), n_ids - first));
    const std::span<std::uint32_t> part = std::span(ids).first(n);
    indices_->read(first * sizeof ids[0], std::as_writable_bytes(part));
    if (!is_short) {
      put_body(std::as_bytes(part));
      continue;
    }
    put_records(
        n, sizeof(std::uint16_t), block_,
        [&](std::size_t i, std::byte* at) {
          const auto small = static_cast<std::uint16_t>(part[i]);
          std::memcpy(at, &small, sizeof small);
        },
        [this](std::span<const std::byte> bytes) { put_body(bytes); });
  }
}

void GltfSink::end_object(const MeshTotals& /*totals*/) {
  check_announced(main_.place(), object_, counts_);
  GltfObject& object = objects_.back();
  object.n_vertices = counts_.n_vertices;
  object.n_indices = 3 * counts_.n_triangles;
  object.indices_at = object.vertices_at + object.n_vertices * object.vertex_bytes();
  if (indices_) {
    take_spooled_indices();
    indices_.reset();
  } else {
    (bin_ ? *bin_ : main_).skip(object.n_indices * object.index_bytes());
  }
}

void GltfSink::finish_glb() {
  const std::uint64_t n_bytes = body_size();
  std::string json = gltf_json(objects_, {.n_bytes = n_bytes}, options_.provenance);
  const std::uint64_t room = std::max(json_room_, aligned(json.size()));
  json.resize(static_cast<std::size_t>(room), ' ');
  const std::uint64_t bin_bytes = n_bytes == 0 ? 0 : kChunkHeader + aligned(n_bytes);
  const std::uint64_t total = kFileHeader + kChunkHeader + room + bin_bytes;
  check_limit(main_.place(), total, "bytes", "a GLB", kMostGlbBytes, "write .gltf or .ply");
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
  const std::string bin = bin_path(main_.place());
  const std::string uri = percent_encoded(bin.substr(bin.rfind('/') + 1));
  const std::uint64_t n_bytes = bin_->size();
  main_.append(gltf_json(objects_, {.n_bytes = n_bytes, .uri = uri}, options_.provenance));
  if (n_bytes == 0) {
    bin_.reset();
    main_.commit();
  } else {
    OutputFile::commit_all({&*bin_, &main_});
  }
}

void GltfSink::finish() {
  if (is_glb_) {
    finish_glb();
  } else {
    finish_gltf();
  }
}

}  // namespace

std::unique_ptr<MeshSink> open_glb(const std::string& path, const SinkOptions& options) {
  return std::make_unique<GltfSink>(path, options, true);
}

std::unique_ptr<MeshSink> open_gltf(const std::string& path, const SinkOptions& options) {
  return std::make_unique<GltfSink>(path, options, false);
}

}  // namespace mc::sink

#endif
