// SPDX-License-Identifier: MIT
#include "pipe/cube_sink.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "pipe/tasks.hpp"
#include "process/vertex_buffers.hpp"

namespace mc::pipe {

namespace {

std::vector<CubeStore::Cube*> cubes_of(CubeStore::Layer& layer) {
  std::vector<CubeStore::Cube*> out;
  for (auto& [at, cube] : layer.cubes) out.push_back(&cube);
  return out;
}

Vec3 position(const MeshChunk& mesh, std::size_t vertex) {
  const auto at = [vertex](const auto& p) {
    return Vec3{p[3 * vertex], p[3 * vertex + 1], p[3 * vertex + 2]};
  };
  return mesh.positions_f64.empty() ? at(mesh.positions) : at(mesh.positions_f64);
}

double area(const MeshChunk& mesh, std::size_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const Vec3 a = position(mesh, corner[0]);
  return 0.5 *
         length(cross(minus(position(mesh, corner[1]), a), minus(position(mesh, corner[2]), a)));
}

/// The triangles of the first pass that each square unit of a cube stands for.
double density(const MeshChunk& mesh, double n_extracted) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.n_triangles(); ++t) sum += area(mesh, t);
  return sum > 0 && std::isfinite(sum) ? n_extracted / sum : 0;
}

/// Gives memory that nothing uses back to the system.
void return_free_memory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

}  // namespace

MeshDistances DistanceSum::distances() const {
  return {n_ == 0 ? 0 : std::sqrt(squares_.value() / static_cast<double>(n_)), max_};
}

CubeSink::CubeSink(const CubeGrid& grid, const Options& options, MeshSink& out,
                   const std::stop_token& stop)
    : grid_(grid),
      options_(options),
      stages_(options.run.cube_stages),
      out_(out),
      stop_(stop),
      sequence_(grid) {
  const RunOptions& run = options.run;
  if (!run.attributes.empty()) {
    attributes_.emplace(run.attributes, run.to_world.value(), run.extract.origin);
  }
  raw_.expect(options.plan.cubes);
}

void CubeSink::look_at_stop() const {
  if (stop_.stop_requested()) throw Cancelled();
}

void CubeSink::begin_object(const MeshObject& object) {
  raw_.reserve(static_cast<std::size_t>(options_.plan.max_vertices), object.precision,
               object.has_normals);
  object_ = object;
  object_.n_vertices.reset();
  object_.n_triangles.reset();
  if (counts_) {
    object_.n_vertices = counts_->n_vertices;
    object_.n_triangles = counts_->n_triangles;
  }
  for (const AttributeReader* reader : options_.run.attributes) {
    object_.attributes.push_back(reader->info());
  }
  stages_.describe(object_);
  slots_.resize(options_.n_workers);
  out_.set_slots(options_.n_workers);
  out_.begin_object(object_);
}

void CubeSink::place(const MeshChunk& chunk, std::size_t slot) {
  const auto triangles = feed_.add(chunk, slot < options_.n_forward_slots, raw_);
  const std::span<const PassCubes> cubes = sequence_.next(triangles, raw_);
  for (std::size_t t = 0; t < triangles.size(); ++t) raw_.add(cubes[t].first, triangles[t], 1);
  take_complete_layers(false);
}

/// Takes out layers that no further triangle belongs to, and whose vertices none names.
void CubeSink::take_complete_layers(bool all) {
  const auto is_complete = [&](const std::pair<const std::int32_t, Layer>& lowest) {
    return all || (lowest.first < sequence_.z() && lowest.second.last_vertex < feed_.least_named());
  };
  bool taken = false;
  while (!raw_.layers().empty() && is_complete(*raw_.layers().begin())) {
    finish_layer(raw_.layers().begin()->first);
    taken = true;
  }
  if (!taken) return;
  std::uint64_t n = std::min<std::uint64_t>(feed_.least_named(), raw_.n_vertices());
  for (const auto& [z, layer] : raw_.layers()) n = std::min<std::uint64_t>(n, layer.first_vertex);
  raw_.drop_first(static_cast<std::size_t>(n));
  feed_.dropped(static_cast<std::size_t>(n));
}

void CubeSink::finish_layer(std::int32_t z) {
  Layer layer = raw_.take_lowest();
  raw_.mark_used(open_raw_);
  first_pass(z, layer);
  while (!left_.layers().empty() && (left_.layers().begin()->first <= z || raw_.layers().empty())) {
    Layer shifted = left_.take_lowest();
    const std::vector<std::uint8_t> open = open_in_left();
    second_pass(shifted, open);
    compact_left(open);
  }
}

/// As many cubes at once as their memory allows.
std::size_t CubeSink::workers_for(const std::vector<Cube*>& cubes) const {
  std::uint64_t most = 1;
  for (const Cube* cube : cubes) {
    most = std::max(most, worker_bytes(cube->n_uses, cube->n_triangles(), options_.run));
  }
  return static_cast<std::size_t>(
      std::clamp<std::uint64_t>(options_.worker_bytes / most, 1, options_.n_workers));
}

void CubeSink::apply(const CubeStore& store, Cube& cube, std::span<const std::uint8_t> open,
                     bool is_last, CubePart& part) const {
  look_at_stop();
  part.gather(store, cube, open);
  cube.triangles = {};
  MeshCube window{part.mesh,    object_.origin,   part.seam.size(),
                  grid_.cell(), cube.n_extracted, options_.plan.n_triangles,
                  is_last};
  stages_.apply(window);
  part.distances = window.distances;
  // The allocator keeps what a thread has freed, for each thread that has worked on a cube.
  if (options_.n_workers < base::pipeline_slots()) return_free_memory();
}

void CubeSink::first_pass(std::int32_t z, Layer& layer) {
  const std::vector<Cube*> cubes = cubes_of(layer);
  const std::array<base::Step, 2> steps{
      {{false, [&](std::size_t n,
                   std::size_t slot) { apply(raw_, *cubes[n], {}, false, slots_[slot].part); }},
       {true, [&](std::size_t n, std::size_t slot) {
          first_distances_.add(slots_[slot].part.distances);
          take(z, cubes[n]->n_extracted, slots_[slot].part);
        }}}};
  base::pipeline(cubes.size(), workers_for(cubes), steps);
}

/// Moves what the first pass left of a cube to the second store.
void CubeSink::take(std::int32_t z, double n_extracted, const CubePart& part) {
  const MeshChunk& mesh = part.mesh;
  numbers_.resize(mesh.n_vertices());
  for (std::size_t v = 0; v < numbers_.size(); ++v) {
    if (v >= part.seam.size()) {
      numbers_[v] = left_.append(mesh, v);
      continue;
    }
    std::uint64_t& next = raw_.next_id(part.seam[v]);
    if (next == CubeStore::kNoId) next = left_.append(mesh, v);
    numbers_[v] = static_cast<std::uint32_t>(next);
  }
  const double per_area = density(mesh, n_extracted);
  for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
    const CubeStore::Triangle triangle{numbers_[mesh.indices[3 * t]],
                                       numbers_[mesh.indices[3 * t + 1]],
                                       numbers_[mesh.indices[3 * t + 2]]};
    Index3 cube = grid_.cube_of(left_.centroid(triangle), true);
    cube[2] = std::clamp(cube[2], z, z + 1);
    left_.add(cube, triangle, per_area * area(mesh, t));
  }
}

/// The vertices of the second store that triangles still name which have not come there.
std::vector<std::uint8_t> CubeSink::open_in_left() {
  std::vector<std::uint8_t> open(left_.n_vertices());
  for (std::size_t v = 0; v < open_raw_.size(); ++v) {
    const std::uint64_t next = raw_.next_id(static_cast<std::uint32_t>(v));
    if (open_raw_[v] != 0 && next != CubeStore::kNoId) open[static_cast<std::size_t>(next)] = 1;
  }
  return open;
}

void CubeSink::compact_left(std::span<const std::uint8_t> open) {
  std::vector<std::uint8_t> kept;
  left_.mark_used(kept);
  for (std::size_t v = 0; v < kept.size(); ++v) kept[v] |= open[v];
  const std::vector<std::uint32_t> numbers = left_.keep(kept);
  for (std::size_t v = 0; v < open_raw_.size(); ++v) {
    std::uint64_t& next = raw_.next_id(static_cast<std::uint32_t>(v));
    if (next == CubeStore::kNoId) continue;
    next = open_raw_[v] != 0 ? numbers[static_cast<std::size_t>(next)] : CubeStore::kNoId;
  }
}

void CubeSink::second_pass(Layer& layer, std::span<const std::uint8_t> open) {
  const std::vector<Cube*> cubes = cubes_of(layer);
  const auto has_chunk = [this](std::size_t slot) {
    const MeshChunk& mesh = slots_[slot].part.mesh;
    return mesh.n_vertices() != 0 || mesh.n_triangles() != 0;
  };
  const std::array<base::Step, 5> steps{{
      {false,
       [&](std::size_t n, std::size_t slot) {
         apply(left_, *cubes[n], open, true, slots_[slot].part);
         measure(slots_[slot]);
       }},
      {true, [&](std::size_t /*n*/, std::size_t slot) { number(slots_[slot]); }},
      {false,
       [&](std::size_t /*n*/, std::size_t slot) {
         make_chunk(slots_[slot]);
         if (has_chunk(slot)) out_.format(slots_[slot].part.mesh, slot);
       }},
      {true,
       [&](std::size_t /*n*/, std::size_t slot) {
         add_each(n_clamped_, slots_[slot].n_clamped);
         if (has_chunk(slot)) out_.place(slots_[slot].part.mesh, slot);
       }},
      {false,
       [&](std::size_t /*n*/, std::size_t slot) {
         if (has_chunk(slot)) out_.write(slots_[slot].part.mesh, slot);
       }},
  }};
  base::pipeline(cubes.size(), workers_for(cubes), steps);
}

void CubeSink::measure(Slot& slot) const {
  MeshChunk& mesh = slot.part.mesh;
  slot.bounds = process::bounds_of(mesh);
  if (!options_.run.extract.measure) return;
  slot.sums = process::own_sums(
      {mesh, object_.origin, {0, mesh.n_vertices()}, {0, mesh.n_triangles()}}, options_.apex);
}

/// Gives ids to the vertices that no earlier cube has, first to those of the seam.
void CubeSink::number(Slot& slot) {
  slot.first_id = n_vertices_;
  slot.seam_ids.clear();
  for (const std::uint32_t vertex : slot.part.seam) {
    std::uint64_t& id = left_.next_id(vertex);
    if (id == CubeStore::kNoId) id = n_vertices_++;
    slot.seam_ids.push_back(id);
  }
  slot.n_own = static_cast<std::size_t>(n_vertices_ - slot.first_id);
  n_vertices_ += slot.part.mesh.n_vertices() - slot.part.seam.size();
  n_triangles_ += slot.part.mesh.n_triangles();
  bounds_.include(slot.bounds);
  sums_.add(slot.sums);
  last_distances_.add(slot.part.distances);
}

/// Leaves only the vertices that are first used here, and makes indices count from the lowest id.
void CubeSink::make_chunk(Slot& slot) const {
  MeshChunk& mesh = slot.part.mesh;
  const std::size_t n_seam = slot.seam_ids.size();
  std::uint64_t base = slot.first_id;
  for (const std::uint64_t id : slot.seam_ids) base = std::min(base, id);
  const std::uint64_t n_before = n_seam - slot.n_own;  // vertices of earlier cubes
  if (slot.first_id + mesh.n_vertices() - base > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::limit, {}, "a triangle spans more than 2^32 vertex ids",
                Remedy::smaller_region);
  }
  for (std::uint32_t& index : mesh.indices) {
    const std::uint64_t id =
        index < n_seam ? slot.seam_ids[index] : slot.first_id + index - n_before;
    index = static_cast<std::uint32_t>(id - base);
  }
  mesh.index_base = base;
  process::for_vertex_buffers(mesh, [&](auto& buffer, std::size_t each) {
    if (buffer.empty()) return;
    std::size_t n = 0;
    for (std::size_t v = 0; v < buffer.size() / each; ++v) {
      if (v < n_seam && slot.seam_ids[v] < slot.first_id) continue;
      std::copy_n(&buffer[each * v], each, &buffer[each * n++]);
    }
    buffer.resize(each * n);
  });
  if (attributes_) attributes_->give(mesh, slot.n_clamped);
}

void CubeSink::end_object(const MeshTotals& totals) {
  take_complete_layers(true);
  totals_ = totals;
  totals_.n_vertices = n_vertices_;
  totals_.n_triangles = n_triangles_;
  totals_.n_clamped = n_clamped_;
  totals_.n_extracted = totals.n_triangles;
  totals_.bounds = {};
  if (!bounds_.empty()) {
    totals_.bounds = bounds_;
    for (std::size_t a = 0; a < 3; ++a) {
      totals_.bounds.lo[a] += object_.origin[a];
      totals_.bounds.hi[a] += object_.origin[a];
    }
  }
  if (options_.run.extract.measure) {
    totals_.area = sums_.area.value();
    if (totals.n_boundary_edges == 0) totals_.volume = sums_.volume.value();
  }
  if (stages_.measure()) {
    const MeshDistances first = first_distances_.distances();
    const MeshDistances last = last_distances_.distances();
    totals_.distances = MeshDistances{first.rms + last.rms, first.max + last.max};
  }
  out_.end_object(totals_);
}

}  // namespace mc::pipe
