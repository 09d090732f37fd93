// SPDX-License-Identifier: MIT
#include "convert/chunk_writer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/hash.hpp"
#include "convert/output_frame.hpp"
#include "convert/provenance.hpp"
#include "sink/file_writer.hpp"

// A chunk leaves as soon as it is made, so that only one is in memory. A viewer waits for the
// record's report, which comes last, before it shows the chunks as one state of the surface.

namespace mc::conversion {

namespace {

namespace fs = std::filesystem;

std::string name_of_chunk(const Index3& id) {
  return fmt::format("chunk_{}_{}_{}.{}", id[0], id[1], id[2], chunk_format().name);
}

/// "chunk_0_-1_12.glb".
bool is_chunk_name(std::string_view name) {
  constexpr std::string_view kFirst = "chunk";
  const std::string last = fmt::format(".{}", chunk_format().name);
  if (!name.starts_with(kFirst) || !name.ends_with(last)) return false;
  name.remove_prefix(kFirst.size());
  name.remove_suffix(std::min(last.size(), name.size()));
  int n_numbers = 0;
  while (name.starts_with('_')) {
    name.remove_prefix(name.starts_with("_-") ? 2 : 1);
    const std::size_t n_digits = std::min(name.find_first_not_of("0123456789"), name.size());
    if (n_digits == 0) return false;
    name.remove_prefix(n_digits);
    ++n_numbers;
  }
  return name.empty() && n_numbers == 3;
}

std::uint64_t hash_of(const MeshChunk& mesh) {
  std::uint64_t h = 0;
  const auto add = [&h](const auto& buffer) {
    h = base::hash_on(base::hash_on(h, buffer.size()), std::as_bytes(std::span(buffer)));
  };
  add(mesh.positions);
  add(mesh.normals);
  for (const VertexAttribute& attribute : mesh.attributes) add(attribute.values);
  add(mesh.indices);
  return h;
}

SinkOptions glb_options(const ConvertOptions& base, const Source& source, const Surface& surface) {
  const Volume& volume = volume_of(source.reader);
  SinkOptions options;
  options.to = chunk_format().name;
  options.force = true;  // a chunk replaces the one before it
  options.to = chunk_format().name;
  options.force = true;  // a chunk replaces the one before it
  options.sync = base.sink.sync;
  Surface shown = surface;
  shown.isos.resize(1);
  options.provenance = provenance_of(
      volume, shown, output_frame(volume, base.frame, chunk_format()), chunk_format());
  return options;
}

}  // namespace

const SinkFormat& chunk_format() {
  return **std::ranges::find_if(sink_formats(), [](const SinkFormat* f) { return f->to_memory; });
}

ChunkOptions chunk_options(const ConvertOptions& base, std::int32_t n_cells, const Source& source,
                           const Surface& surface) {
  const Volume& volume = volume_of(source.reader);
  const IndexBox box = base.extract.region.value_or(volume.lattice.box);
  const OutputFrame frame = output_frame(volume, base.frame, chunk_format());
  ChunkOptions options{.extract = base.extract, .to_world = frame.to_world};
  options.n_cells = n_cells;
  options.extract.iso = surface.isos.front().value;
  options.extract.inside = surface.inside;
  options.extract.border = surface.border;
  options.extract.normals = base.normals.value_or(Normals::gradient);
  options.extract.measure = false;
  const bool moves = rounding_loss(box, frame.to_world, Precision::f32).matters;
  const MeshNeeds needs = chunk_format().needs(base.sink, moves);
  check_told_apart(source.place, box, frame.to_world, needs,
                   base.source.spacing || base.source.origin);
  if (needs.relative_origin) options.extract.origin = double_origin(box, frame.to_world);
  return options;
}

ChunkWriter::ChunkWriter(const ChunkOutput& output, const ConvertOptions& base,
                         const Source& source, const Surface& surface, const EditStore& store,
                         ScriptObserver& observer)
    : output_(output),
      observer_(observer),
      options_(chunk_options(base, output.n_cells, source, surface)),
      sink_(glb_options(base, source, surface)),
      mesher_(store, options_) {
  if (output.folder) look_at_folder(base.sink.force);
}

std::string ChunkWriter::path_of(const std::string& name) const {
  return (fs::path(*output_.folder) / name).string();
}

void ChunkWriter::look_at_folder(bool force) {
  const std::string& folder = *output_.folder;
  std::error_code fault;
  for (fs::directory_iterator at(folder, fault), end; !fault && at != end; at.increment(fault)) {
    const std::string name = at->path().filename().string();
    if (is_chunk_name(name)) found_.insert(name);
  }
  if (fault) {
    throw Error(ErrorKind::output, folder, "cannot read the folder: " + fault.message(),
                fault == std::errc::no_such_file_or_directory ? "create it first" : "");
  }
  if (!found_.empty() && !force) {
    throw Error(ErrorKind::output, path_of(*found_.begin()), "exists",
                "name an empty folder, or add --force to replace its chunks");
  }
}

void ChunkWriter::put(const SurfaceChunk& chunk, const std::string& path,
                      const SinkOptions& to) const {
  MeshObject object;
  object.name = fmt::format("chunk {} {} {}", chunk.id[0], chunk.id[1], chunk.id[2]);
  object.iso = options_.extract.iso;
  object.has_normals = options_.extract.normals != Normals::none;
  for (const VertexAttribute& attribute : chunk.mesh.attributes) {
    object.attributes.push_back(attribute.info);
  }
  object.origin = options_.extract.origin;
  object.n_vertices = chunk.mesh.n_vertices();
  object.n_triangles = chunk.mesh.n_triangles();
  const std::unique_ptr<MeshSink> sink = open_mesh_sink(path, to);
  sink->begin_object(object);
  sink->put(chunk.mesh);
  sink->end_object(chunk.totals);
  sink->finish();
}

/// How many bytes it has.
std::uint64_t ChunkWriter::write_file(const SurfaceChunk& chunk, const std::string& name) {
  const std::string path = path_of(name);
  put(chunk, path, sink_);
  found_.erase(name);
  return fs::file_size(path);
}

std::uint64_t ChunkWriter::hand_out(const SurfaceChunk& chunk, std::uint64_t record) {
  SinkOptions to = sink_;
  to.memory = &glb_;
  put(chunk, "<stdout>", to);
  observer_.chunk(record, chunk.id, glb_);
  return glb_.size();
}

void ChunkWriter::remove(const std::string& name) const {
  const std::string path = path_of(name);
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) sink::cannot("remove", path);
}

void ChunkWriter::take(const SurfaceChunk& chunk, std::uint64_t record, ChunkChanges& changes) {
  const std::string name = output_.folder ? name_of_chunk(chunk.id) : "";
  if (chunk.mesh.n_triangles() == 0) {
    hashes_.erase(chunk.id);
    changes.removed.push_back(chunk.id);
    if (output_.folder) remove(name);
    return;
  }
  const std::uint64_t hash = hash_of(chunk.mesh);
  const auto [held, is_new] = hashes_.try_emplace(chunk.id, hash);
  if (!is_new && std::exchange(held->second, hash) == hash) return;
  const std::vector<std::uint64_t>& n_clamped = chunk.totals.n_clamped;
  n_clamped_.resize(std::max(n_clamped_.size(), n_clamped.size()));
  for (std::size_t n = 0; n < n_clamped.size(); ++n) n_clamped_[n] += n_clamped[n];
  const std::uint64_t n_bytes = output_.folder ? write_file(chunk, name) : hand_out(chunk, record);
  changes.updated.push_back({chunk.id, name, n_bytes, chunk.mesh.n_vertices(),
                             chunk.mesh.n_triangles(), chunk.totals.bounds});
}

ChunkChanges ChunkWriter::write_all() {
  ChunkChanges changes;
  mesher_.build([&](const SurfaceChunk& chunk) { take(chunk, 0, changes); });
  for (const std::string& name : std::exchange(found_, {})) remove(name);
  changes.sums = mesher_.sums();
  return changes;
}

ChunkChanges ChunkWriter::write_changes(std::span<const IndexBox> dirty, std::uint64_t record) {
  ChunkChanges changes;
  mesher_.update(dirty, [&](const SurfaceChunk& chunk) { take(chunk, record, changes); });
  changes.sums = mesher_.sums();
  return changes;
}

}  // namespace mc::conversion
