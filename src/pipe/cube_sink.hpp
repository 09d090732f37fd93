// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <stop_token>
#include <vector>

#include "mc/mesh.hpp"
#include "mc/pipe.hpp"
#include "pipe/cube_grid.hpp"
#include "pipe/cube_part.hpp"
#include "pipe/cube_plan.hpp"
#include "pipe/cube_store.hpp"
#include "pipe/triangle_feed.hpp"
#include "pipe/vertex_attributes.hpp"
#include "process/cube_stage_list.hpp"
#include "process/figures.hpp"

namespace mc::pipe {

/// Vertex distances of one pass.
class DistanceSum {
 public:
  void add(const VertexDistances& cube) {
    n_ += cube.n;
    squares_.add(cube.sum_squares);
    max_ = std::max(max_, cube.max);
  }
  [[nodiscard]] MeshDistances distances() const;

 private:
  std::uint64_t n_ = 0;
  process::ExactSum squares_;
  double max_ = 0;
};

/// Takes the mesh of an extraction, applies cube stages, and hands what they make to a sink.
///
/// Two stores hold the mesh: the first as it comes, by cubes of the first pass; the second what the
/// first pass leaves, by cubes of the second pass. When the mesh has come so far that no triangle
/// can be added to a layer of cubes, nor use its vertices, the first pass works on the layer's
/// cubes on all threads, and what it leaves goes to the second store. Then the second pass works on
/// the layer of shifted cubes that is complete by that, numbers the vertices, and hands out its
/// cubes.
class CubeSink final : public MeshSink {
 public:
  struct Options {
    const RunOptions& run;
    const CubePlan& plan;
    std::size_t n_forward_slots;  ///< whose chunks name no vertex before their own first one
    std::size_t n_workers;        ///< cubes at once
    std::uint64_t worker_bytes;   ///< for all of them
    Vec3 apex;                    ///< from which volumes are measured, relative to the origin
  };
  /// Keeps references to all of them. run.to_world is set.
  CubeSink(const CubeGrid& grid, const Options& options, MeshSink& out,
           const std::stop_token& stop);

  /// `counts` are those of the mesh that it will hand out, if they are known.
  void announce(const MeshTotals& counts) { counts_ = counts; }
  void begin_object(const MeshObject& object) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override {}
  /// Figures of what it has handed out, after end_object().
  [[nodiscard]] const MeshTotals& totals() const { return totals_; }

 private:
  using Layer = CubeStore::Layer;
  using Cube = CubeStore::Cube;
  struct Slot {
    CubePart part;
    std::uint64_t first_id = 0;  ///< of the vertices that are first used here
    std::vector<std::uint64_t> seam_ids;
    std::size_t n_own = 0;  ///< of the seam, used here first
    std::vector<std::uint64_t> n_clamped;
    process::SurfaceSums sums;
    Bounds bounds;
  };

  void take_complete_layers(bool all);
  void finish_layer(std::int32_t z);
  [[nodiscard]] std::size_t workers_for(const std::vector<Cube*>& cubes) const;
  void apply(const CubeStore& store, Cube& cube, std::span<const std::uint8_t> open, bool is_last,
             CubePart& part) const;
  void first_pass(std::int32_t z, Layer& layer);
  void take(std::int32_t z, double n_extracted, const CubePart& part);
  void second_pass(Layer& layer, std::span<const std::uint8_t> open);
  void measure(Slot& slot) const;
  void number(Slot& slot);
  void make_chunk(Slot& slot) const;
  void compact_left(std::span<const std::uint8_t> open);
  [[nodiscard]] std::vector<std::uint8_t> open_in_left();
  void look_at_stop() const;

  const CubeGrid& grid_;
  const Options options_;
  process::CubeStageList stages_;
  MeshSink& out_;
  const std::stop_token& stop_;
  MeshObject object_;
  std::optional<MeshTotals> counts_;
  std::optional<VertexAttributes> attributes_;
  CubeSequence sequence_;
  TriangleFeed feed_;
  CubeStore raw_, left_;
  std::vector<std::uint8_t> open_raw_;  ///< vertices with triangles in layers that are not closed
  std::vector<std::uint32_t> numbers_;  ///< scratch: of a part's vertices in left_
  std::vector<Slot> slots_;
  std::uint64_t n_vertices_ = 0, n_triangles_ = 0;
  std::vector<std::uint64_t> n_clamped_;
  process::SurfaceSums sums_;
  Bounds bounds_;
  DistanceSum first_distances_, last_distances_;
  MeshTotals totals_;
};

}  // namespace mc::pipe
