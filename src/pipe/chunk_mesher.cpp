// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "extract/sparse/sparse_plan.hpp"
#include "field/block.hpp"
#include "mc/method.hpp"
#include "mc/pipe.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/chunk_grid.hpp"
#include "pipe/tasks.hpp"
#include "pipe/totals_sum.hpp"
#include "pipe/vertex_attributes.hpp"

// A chunk is a part of the volume to the dense engine, whose samples are copied together from
// wherever the store has them. What is kept from chunk to chunk is scratch, and which chunks have a
// surface.

namespace mc {

namespace {

/// Of a sparse volume: where more chunks than this may have changed, those near a leaf or a tile's
/// face are found first.
constexpr std::uint64_t kManyChunks = 4096;

const ChunkOptions& checked(const ChunkOptions& options) {
  const std::int32_t n = options.n_cells;
  if (n < 8 || n > 256 || !std::has_single_bit(static_cast<std::uint32_t>(n))) {
    throw Error(ErrorKind::usage, "chunk",
                std::to_string(n) + " cells are not a power of two from 8 to 256");
  }
  if (!std::isfinite(options.extract.iso)) {
    throw Error(ErrorKind::usage, "iso", "is not finite");
  }
  if (options.extract.part) {
    throw Error(ErrorKind::usage, "part", "chunks are made of all layers");
  }
  if (const Method& method = pipe::method_of(options.extract); method.box == nullptr) {
    throw Error(ErrorKind::usage, "method", std::string(method.name) + " cannot make chunks");
  }
  return options;
}

}  // namespace

struct ChunkMesher::State {
  struct Slot {
    std::unique_ptr<SlabEngine> engine;
    Slab slab;
    SurfaceChunk chunk;
    pipe::TaskTotals totals;
    VertexAttribute unpainted;  ///< the memory of a material that a chunk does without
  };
  struct Counts {
    std::uint64_t n_vertices, n_triangles;
  };

  State(const EditStore& edited, const ChunkOptions& chosen);

  void list_all();
  void list_surface();
  void list_reached(std::span<const IndexBox> dirty);
  void remake(const Take& take);
  void make(const Index3& id, Slot& slot) const;
  void gather(Slot& slot) const;
  void give_attributes(Slot& slot) const;
  void hand_out(const SurfaceChunk& chunk, const Take& take);

  const EditStore& store;
  ChunkOptions options;
  Volume volume;  ///< as the extractor sees it: of native samples, and as large as they can be
  bool is_sparse;
  pipe::ChunkGrid grid;
  std::vector<Slot> slots;
  std::vector<Index3> ids;                           ///< to be made
  std::optional<pipe::VertexAttributes> attributes;  ///< of the volume as it is, if it has any
  std::unordered_map<Index3, Counts, field::IndexHash> known;
  ChunkSums sums;
};

namespace {

/// The samples that there are: of a sparse volume, all that have an index.
IndexBox samples_of(const Volume& volume, bool is_sparse, const ExtractOptions& options) {
  return options.region.value_or(is_sparse ? extraction::kAllSamples : volume.lattice.box);
}

Volume seen_by_engine(const EditStore& store, bool is_sparse, const ExtractOptions& options) {
  Volume volume = store.volume();
  volume.lattice.box = samples_of(volume, is_sparse, options);
  volume.endian = std::endian::native;
  return volume;
}

bool stays_sparse(const EditStore& store) {
  return std::holds_alternative<std::unique_ptr<LeafReader>>(store.reader());
}

}  // namespace

ChunkMesher::State::State(const EditStore& edited, const ChunkOptions& chosen)
    : store(edited),
      options(checked(chosen)),
      volume(),
      is_sparse(stays_sparse(edited)),
      grid({}, false, chosen.n_cells, 0) {
  // Without a region a sparse volume has no border.
  if (is_sparse && !options.extract.region) options.extract.border = Border::open;
  volume = seen_by_engine(store, is_sparse, options.extract);
  grid = pipe::ChunkGrid(volume.lattice.box, options.extract.border != Border::open,
                         options.n_cells, options.extract.normals != Normals::none ? 1 : 0);
}

/// Lists the chunks that hold a cell of the surface, and those that did when they were made last.
void ChunkMesher::State::list_surface() {
  const VolumeReader reader = store.reader();
  const extraction::SparsePlan plan(*std::get<std::unique_ptr<LeafReader>>(reader),
                                    options.extract);
  ids.clear();
  for (const extraction::SurfaceBlock& block : plan.blocks()) {
    const Index3 id = grid.chunk_of(field::origin_of(block.at));
    if (ids.empty() || ids.back() != id) ids.push_back(id);
  }
  for (const auto& [id, counts] : known) ids.push_back(id);
  pipe::sort_unique(ids);
}

void ChunkMesher::State::list_all() {
  if (is_sparse) return list_surface();
  ids.clear();
  pipe::append_all(grid.chunks(), ids);
}

void ChunkMesher::State::list_reached(std::span<const IndexBox> dirty) {
  ids.clear();
  for (const IndexBox& samples : dirty) {
    const IndexBox reached = grid.reached(samples);
    if (is_sparse && pipe::count_of(reached) + ids.size() > kManyChunks) {
      list_surface();
      std::erase_if(ids, [&](const Index3& id) {
        return std::ranges::none_of(
            dirty, [&](const IndexBox& box) { return grid.reached(box).contains(id); });
      });
      return;
    }
    pipe::append_all(reached, ids);
  }
  if (dirty.size() > 1) pipe::sort_unique(ids);
}

/// Copies the samples that the slot's part is made of.
void ChunkMesher::State::gather(Slot& slot) const {
  const IndexBox box = slot.engine->samples();
  slot.slab.allocate(box, sample_size(volume.type));
  store.read_box(box, slot.slab.storage);
}

/// A chunk painted nowhere looks as if nothing were painted anywhere.
void ChunkMesher::State::give_attributes(Slot& slot) const {
  std::vector<VertexAttribute>& all = slot.chunk.mesh.attributes;
  if (!attributes) return all.clear();
  if (slot.unpainted.info == material_attribute()) {
    all.push_back(std::exchange(slot.unpainted, {}));
  }
  attributes->give(slot.chunk.mesh, slot.chunk.totals.n_clamped);
  const auto material = std::ranges::find(all, material_attribute(), &VertexAttribute::info);
  const auto is_none = [](std::uint16_t index) { return index == 0; };
  if (material == all.end() ||
      !std::ranges::all_of(material->values_as<std::uint16_t>(), is_none)) {
    return;
  }
  slot.unpainted = std::move(*material);
  all.erase(material);
}

void ChunkMesher::State::make(const Index3& id, Slot& slot) const {
  slot.engine->set_box(grid.part(id));
  gather(slot);
  SurfaceChunk& chunk = slot.chunk;
  slot.engine->extract(slot.slab, 0, slot.engine->n_layers(), mesh::ChunkRoom::kUnlimited,
                       chunk.mesh, slot.totals);
  pipe::TotalsSum sum(options.extract.measure);
  sum.add(slot.totals);
  chunk.id = id;
  chunk.totals = sum.totals(options.extract.origin);
  give_attributes(slot);
}

/// Enters a chunk that was made, and hands it out if it has a surface or had one.
void ChunkMesher::State::hand_out(const SurfaceChunk& chunk, const Take& take) {
  const Counts counts{chunk.totals.n_vertices, chunk.totals.n_triangles};
  const auto before = known.find(chunk.id);
  if (before != known.end()) {
    --sums.n_chunks;
    sums.n_vertices -= before->second.n_vertices;
    sums.n_triangles -= before->second.n_triangles;
  }
  if (counts.n_triangles == 0) {
    if (before == known.end()) return;
    known.erase(before);
  } else {
    ++sums.n_chunks;
    sums.n_vertices += counts.n_vertices;
    sums.n_triangles += counts.n_triangles;
    known.insert_or_assign(chunk.id, counts);
  }
  take(chunk);
}

void ChunkMesher::State::remake(const Take& take) {
  const std::size_t n_slots = std::min(base::pipeline_slots(), ids.size());
  const Affine& to_world = options.to_world ? *options.to_world : volume.lattice.to_world;
  attributes.reset();
  if (const AttributeReaders readers = store.attributes(); !readers.empty()) {
    attributes.emplace(readers, to_world, options.extract.origin);
  }
  const Method& method = pipe::method_of(options.extract);
  while (slots.size() < n_slots) {
    slots.push_back(
        {method.box(volume, to_world, options.extract, grid.part(ids[0])), {}, {}, {}, {}});
  }
  struct Run {
    State& state;
    const Take& take;
  } run{*this, take};
  const std::array<base::Step, 2> steps{{
      {false,
       [&run](std::size_t n, std::size_t slot) {
         run.state.make(run.state.ids[n], run.state.slots[slot]);
       }},
      {true,
       [&run](std::size_t /*n*/, std::size_t slot) {
         run.state.hand_out(run.state.slots[slot].chunk, run.take);
       }},
  }};
  base::pipeline(ids.size(), n_slots, steps);
}

ChunkMesher::ChunkMesher(const EditStore& store, const ChunkOptions& options)
    : state_(std::make_unique<State>(store, options)) {}
ChunkMesher::~ChunkMesher() = default;
ChunkMesher::ChunkMesher(ChunkMesher&& other) noexcept = default;
ChunkMesher& ChunkMesher::operator=(ChunkMesher&& other) noexcept = default;

void ChunkMesher::build(const Take& take) {
  state_->list_all();
  state_->remake(take);
}

void ChunkMesher::update(std::span<const IndexBox> dirty, const Take& take) {
  state_->list_reached(dirty);
  state_->remake(take);
}

std::uint64_t ChunkMesher::n_reached(const IndexBox& samples) const {
  return pipe::count_of(state_->grid.reached(samples));
}
bool ChunkMesher::has_surface(const Index3& id) const { return state_->known.contains(id); }
const ChunkSums& ChunkMesher::sums() const { return state_->sums; }

}  // namespace mc
