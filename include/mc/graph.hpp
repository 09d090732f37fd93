// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"

// Procedural fields: a graph of nodes, compiled once and then sampled plane by plane. mc-volume(5)
// gives every node's formula. Values are float32, made by IEEE-exact operations in a fixed order,
// so that the same graph gives the same bits on every machine.

namespace mc {

/// Which side of iso is solid, and so what union, intersection, difference, complement and the
/// solids mean: density, values above; sdf, values below.
enum class Convention : std::uint8_t { density, sdf };

/// The coordinates that a generator looks at, in this order.
enum class Dims : std::uint8_t { xyz, xy, xz, yz };

/// What a node does. In the comments: its inputs; then its numbers, by place in Node::numbers.
enum class NodeType : std::uint8_t {
  constant,        ///< -; value
  x,               ///< -; -
  y,               ///< -; -
  z,               ///< -; -
  add,             ///< one or more; -
  mul,             ///< one or more; -
  min,             ///< one or more; -
  max,             ///< one or more; -
  sub,             ///< a, b; -
  div,             ///< a, b; -
  pow,             ///< a, b; -
  mod,             ///< a, b; -
  abs,             ///< source; -
  neg,             ///< source; -
  sqrt,            ///< source; -
  floor,           ///< source; -
  fract,           ///< source; -
  sin,             ///< source; -
  clamp,           ///< source; lowest, highest
  remap,           ///< source; from, from, to, to
  smoothstep,      ///< source; lower edge, upper edge
  mix,             ///< a, b, t; -
  select,          ///< a, b, control; threshold, width of the blend
  curve,           ///< source; -. list: x, y of each point. Also curve_shape
  terrace,         ///< source; step, offset, ramp. list: instead of step and offset the levels
  floor_hard,      ///< source; height, weight
  white,           ///< -; frequency. Also seed, dims
  value,           ///< -; frequency. Also seed, dims
  value_cubic,     ///< -; frequency. Also seed, dims
  perlin,          ///< -; frequency. Also seed, dims
  simplex,         ///< -; frequency. Also seed, dims
  opensimplex2,    ///< -; frequency. Also seed, dims
  cellular,        ///< -; frequency, jitter. Also seed, dims, cell_return, cell_metric
  unity_perlin2d,  ///< - (then dims), or its two coordinates; frequency
  fbm,             ///< source; lacunarity, gain, weighted. Also octaves, dims
  ridged,          ///< as fbm
  billow,          ///< as fbm
  pingpong,        ///< source; lacunarity, gain, weighted, strength. Also octaves, dims
  warp,            ///< source, warp; amplitude, lacunarity, gain. Also warp_mode, octaves
  affine,          ///< source; factor of value - iso (0: left alone). list: as Node says
  mirror,          ///< source; place, side kept: 1 above, -1 below. Also axis
  repeat,          ///< source; periods x, y, z (0: none), copies x, y, z (0: without end)
  sphere,          ///< -; centre x, y, z, radius
  box,             ///< -; centre x, y, z, full sizes x, y, z
  plane,           ///< -; unit normal x, y, z, offset along it
  torus,           ///< -; centre x, y, z, ring's radius, tube's radius. Also axis
  roundbox,        ///< -; centre x, y, z, full sizes x, y, z. list: radius
  capsule,         ///< -; -. list: the ends x, y, z, x, y, z, the radii there
  cylinder,        ///< -; centre x, y, z, radius, height. Also axis
  cone,            ///< -; centre x, y, z, radii at bottom and top, height. Also axis
  ellipsoid,       ///< -; centre x, y, z, radii x, y, z
  gyroid,          ///< -; centre x, y, z, period, thickness (0: one half of space)
  unite,           ///< one or more; smooth radius
  intersect,       ///< one or more; smooth radius
  difference,      ///< a, b; smooth radius
  complement,      ///< source; -
  offset,          ///< source; distance
  shell,           ///< source; thickness, its middle's depth below the surface
  heightmap,       ///< -; first corner (2), sizes (2), height. Also raster, wrap, filter, dims
  volume,          ///< -; -. Also volume, outside, filter
};

/// How a picture goes on beyond its edge: its last pixels, the picture again, or its mirror image.
enum class Wrap : std::uint8_t { clamp, repeat, mirror };
/// What lies between samples: the nearest one, a straight line, or a Catmull-Rom spline (pictures
/// only).
enum class Filter : std::uint8_t { nearest, linear, cubic };

/// Samples that nodes read: a picture's, the top row first.
struct Raster {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<float> samples;
};

/// Samples that nodes read: a volume's, x fastest.
struct SampledVolume {
  Index3 dims{};
  Affine to_index;  ///< from the world to the place among the samples; each number within +-1e100
  std::optional<float> background{};  ///< what samples beyond it are; unset: its nearest one
  Buffer<float> samples{};
};

/// How a curve runs from point to point: straight; by a monotone cubic; held until the next point.
enum class CurveShape : std::uint8_t { linear, smooth, steps };

/// What cellular noise tells of the points: the random number of the nearest; the distance to the
/// nearest; to the second nearest; how much farther that is.
enum class CellReturn : std::uint8_t { value, f1, f2, f2_f1 };

/// How it measures: the root of the sum of squares; the sum of sizes; the largest size.
enum class CellMetric : std::uint8_t { euclidean, manhattan, chebyshev };

/// How a warp moves coordinates: by one octave; octave by octave, each at the place that the ones
/// before have moved it to; by the sum of all octaves at the first place.
enum class WarpMode : std::uint8_t { single, progressive, independent };

/// Names a node of one Graph.
enum class NodeId : std::uint32_t {};

struct Node {
  NodeType type = NodeType::constant;
  std::vector<NodeId> inputs{};    ///< in the order that NodeType names them
  std::array<float, 6> numbers{};  ///< finite; places as NodeType says
  /// More numbers, finite. affine: a 3 x 4 matrix, row by row, that takes a point to the point
  /// where the source is looked up. curve: at least two points, x rising. terrace: at least two,
  /// rising.
  std::vector<float> list{};
  std::uint32_t seed = 0;     ///< generators
  std::uint32_t octaves = 1;  ///< fractals, and warps but single ones: 1 to 32
  std::uint8_t axis = 1;      ///< 0, 1, 2: what a torus, cylinder or cone turns around
  CurveShape curve_shape = CurveShape::linear;
  std::optional<Dims> dims{};  ///< unset: of the fractal above it, else xyz (flat ones: xz)
  std::shared_ptr<const Raster> raster{};         ///< heightmap: needed
  std::shared_ptr<const SampledVolume> volume{};  ///< volume: needed
  std::optional<float> outside{};  ///< volume: finite, takes the place of its background
  Wrap wrap = Wrap::clamp;
  Filter filter = Filter::linear;
  CellReturn cell_return = CellReturn::f1;
  CellMetric cell_metric = CellMetric::euclidean;
  WarpMode warp_mode = WarpMode::single;
};

struct GraphSettings {
  std::uint32_t seed = 0;
  Convention convention = Convention::density;
  float iso = 0;  ///< what union, difference, complement and the solids refer to; finite
};

namespace graph {
struct Program;
}

/// A compiled graph. Threads: immutable; sample() may be called from several threads at once.
class GraphField {
 public:
  explicit GraphField(std::unique_ptr<const graph::Program> program);
  ~GraphField();
  GraphField(GraphField&& other) noexcept;
  GraphField& operator=(GraphField&& other) noexcept;

  /// Fills `out` with the values at lattice indices first + (0..dims-1), whose world coordinates
  /// are origin + index * spacing, computed in double and rounded to float.
  /// Shapes   out: any strides, rows contiguous.
  /// Cost     O(samples * nodes); what does not depend on y is computed once a plane.
  void sample(const Vec3& origin, const Vec3& spacing, const Index3& first, View3<float> out) const;

  /// Fills `out` with the values at `places`, which are world coordinates.
  /// Shapes   out: as many as places.
  /// Cost     O(places * nodes): nothing is shared between places.
  void sample_places(std::span<const std::array<float, 3>> places, std::span<float> out) const;

  /// sample(), where `query` looks: fills what SlabReader::read_surface() promises, within the part
  /// of the query's region (lattice indices) that `out` covers, and notes in `sides` what is left
  /// out of it.
  /// Cost     O(columns * nodes that do not depend on y + samples near the surface * nodes that
  ///          matter there); bounds of the nodes for each of a few thousand samples.
  /// Source   Snyder, "Interval analysis for computer graphics", SIGGRAPH 1992; Keeter, "Massively
  ///          parallel rendering of complex closed-form implicit surfaces", SIGGRAPH 2020 (shorter
  ///          programs for smaller blocks). Differs: nodes that do not depend on y are bounded by
  ///          their samples, which the column needs anyhow.
  void sample_surface(const Vec3& origin, const Vec3& spacing, const Index3& first,
                      const SurfaceQuery& query, View3<float> out, SideMap& sides) const;

 private:
  std::unique_ptr<const graph::Program> program_;
};

/// A graph under construction. A node's inputs must be there before it, so no cycle can arise.
class Graph {
 public:
  static constexpr std::size_t kMaxNodes = 10000;
  static constexpr std::uint32_t kMaxDepth = 256;         ///< nodes on one path
  static constexpr std::size_t kMaxInstructions = 16384;  ///< of a compiled graph

  explicit Graph(const GraphSettings& settings) : settings_(settings) {}

  /// Errors   usage: an unknown or missing input, octaves or axis out of range, a number that is
  ///          not finite, a list of another size or order, too many or too deeply nested nodes.
  NodeId add(Node node);

  [[nodiscard]] const GraphSettings& settings() const { return settings_; }
  [[nodiscard]] const Node& node(NodeId id) const;
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Nodes on the longest path from `id` down to a leaf, itself included.
  [[nodiscard]] std::uint32_t depth(NodeId id) const;

  /// Compiles the field whose value is `root`. Shared nodes are evaluated once.
  /// Errors   usage: fractals and warps of each other that expand past kMaxInstructions.
  [[nodiscard]] GraphField compile(NodeId root) const;

 private:
  GraphSettings settings_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> depths_;
};

}  // namespace mc
