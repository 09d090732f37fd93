// SPDX-License-Identifier: MIT
#include "pipe/cube_plan.hpp"

#include <algorithm>
#include <iterator>

#include "base/parallel.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/cube_part.hpp"
#include "process/cube_stage_list.hpp"
#include "process/stage_list.hpp"

namespace mc::pipe {

namespace {

std::uint64_t vertex_bytes(const RunOptions& options) {
  const process::StageList stages(options.stages);
  const process::CubeStageList cube_stages(options.cube_stages);
  const bool extracted = options.extract.normals != Normals::none;
  return mesh::vertex_bytes(options.extract.precision,
                            cube_stages.with_normals(stages.with_normals(extracted)));
}

}  // namespace

Formatted stored_bytes(const RunOptions& options) {
  return {static_cast<std::uint32_t>(vertex_bytes(options) + kStoredVertexBytes),
          static_cast<std::uint32_t>(2 * mesh::kTriangleBytes + sizeof(PassCubes))};
}

namespace {

/// A buffer that grows is up to half as large again as what it holds.
constexpr std::uint64_t with_growth(std::uint64_t bytes) { return bytes + bytes / 2; }

/// Nodes of the maps of cubes: in the plan, and in a store with an empty buffer.
constexpr std::uint64_t kCubeBytes = 320;

}  // namespace

std::uint64_t worker_bytes(std::uint64_t n_vertices, std::uint64_t n_triangles,
                           const RunOptions& options) {
  const process::CubeStageList stages(options.cube_stages);
  std::uint64_t vertex = vertex_bytes(options) + kPartVertexBytes + stages.vertex_bytes() +
                         options.formatted.vertex_bytes;
  for (const AttributeReader* reader : options.attributes) vertex += reader->info().bytes();
  const std::uint64_t triangle =
      mesh::kTriangleBytes + stages.triangle_bytes() + options.formatted.triangle_bytes;
  return n_vertices * vertex + n_triangles * triangle;
}

CubeGrid cube_grid(const Volume& volume, bool is_dense, const RunOptions& options) {
  const IndexBox samples = is_dense ? options.extract.region.value_or(volume.lattice.box)
                                    : options.extract.region.value_or(IndexBox{});
  return {samples, options.to_world.value_or(volume.lattice.to_world), options.extract.origin,
          process::CubeStageList(options.cube_stages).n_cells(), is_dense};
}

std::span<const PassCubes> CubeSequence::next(std::span<const CubeStore::Triangle> triangles,
                                              const CubeStore& store) {
  constexpr std::size_t kGrain = 4096;
  cubes_.resize(triangles.size());
  base::for_ranges(triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3 in_cubes = grid_.in_cubes(store.centroid(triangles[t]));
      cubes_[t] = {grid_.cube_at(in_cubes, false), grid_.cube_at(in_cubes, true)};
    }
  });
  for (PassCubes& cubes : cubes_) {
    if (z_) cubes.first[2] = std::max(cubes.first[2], *z_);
    z_ = cubes.first[2];
    cubes.second[2] = std::clamp(cubes.second[2], *z_, *z_ + 1);
  }
  return cubes_;
}

void CubeCounter::count(const CubeStore::Triangle& triangle, const PassCubes& cubes) {
  const auto& [first, second] = cubes;
  if (n_first_ == nullptr || first != latest_first_) {
    n_first_ = &first_[{first[2], first[1], first[0]}];
    latest_first_ = first;
  }
  if (n_second_ == nullptr || second != latest_second_) {
    n_second_ = &second_[{second[2], second[1], second[0]}];
    latest_second_ = second;
  }
  ++*n_first_;
  ++*n_second_;
  LayerCounts& layer = layers_[first[2]];
  ++layer.n_triangles;
  layer.n_upper += second[2] != first[2] ? 1 : 0;
  for (const std::uint32_t vertex : triangle) {
    layer.first_id = std::min(layer.first_id, n_dropped_ + vertex);
    layer.last_id = std::max(layer.last_id, n_dropped_ + vertex);
  }
}

void CubeCounter::place(const MeshChunk& chunk, std::size_t slot) {
  const auto triangles = feed_.add(chunk, slot < n_forward_slots_, store_);
  const std::span<const PassCubes> cubes = cubes_.next(triangles, store_);
  for (std::size_t t = 0; t < triangles.size(); ++t) count(triangles[t], cubes[t]);
  const auto n =
      static_cast<std::size_t>(std::min<std::uint64_t>(feed_.least_named(), store_.n_vertices()));
  store_.drop_first(n);
  feed_.dropped(n);
  n_dropped_ += n;
  max_chunk_vertices_ = std::max<std::uint64_t>(max_chunk_vertices_, chunk.n_vertices());
}

/// Triangles of the largest cube of either pass.
std::uint64_t CubeCounter::largest() const {
  std::uint64_t most = 0;
  for (const CubeCounts* counts : {&first_, &second_}) {
    for (const auto& [at, n] : *counts) most = std::max(most, n);
  }
  return most;
}

/// While a layer is closed, a store holds it, what has come of the next one, and at most one chunk
/// more, which the tasks count. What is left of the mesh is at most what was there: in the lower
/// half of the next shifted layer, and the whole layer that is being added.
CubePlan CubeCounter::plan(const RunOptions& options) {
  const std::uint64_t vertex = vertex_bytes(options) + kStoredVertexBytes;
  CubePlan out;
  std::uint64_t raw = 0;
  std::uint64_t left = 0;
  const LayerCounts* below = nullptr;
  for (auto at = layers_.begin(); at != layers_.end(); ++at) {
    const LayerCounts& layer = at->second;
    const auto above = std::next(at);
    const std::uint64_t last_id = above == layers_.end() ? layer.last_id : above->second.last_id;
    const std::uint64_t n_above = above == layers_.end() ? 0 : above->second.n_triangles;
    const std::uint64_t n_vertices = std::max(last_id, layer.last_id) - layer.first_id + 1;
    out.max_vertices = std::max(out.max_vertices, n_vertices);
    raw = std::max(raw, n_vertices * vertex + (layer.n_triangles + n_above) * mesh::kTriangleBytes);
    const std::uint64_t upper = below == nullptr ? 0 : below->n_upper;
    const double part =
        below == nullptr ? 0 : static_cast<double>(upper) / static_cast<double>(below->n_triangles);
    const std::uint64_t n_left_vertices =
        layer.n_vertices() +
        (below == nullptr
             ? 0
             : static_cast<std::uint64_t>(part * static_cast<double>(below->n_vertices())));
    left = std::max(left, with_growth(n_left_vertices * vertex +
                                      (upper + layer.n_triangles) * mesh::kTriangleBytes));
    below = &layer;
  }
  out.max_vertices += max_chunk_vertices_;
  const std::uint64_t n_largest = largest();
  out.bytes.stores = raw + left + kCubeBytes * (first_.size() + second_.size());
  out.bytes.worker = worker_bytes(n_largest, n_largest, options);
  out.n_triangles = n_triangles_;
  out.cubes = std::move(first_);
  return out;
}

}  // namespace mc::pipe
