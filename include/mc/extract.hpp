// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"

// The isosurface extractor: bit-parallel Flying Edges over dense slabs and sparse leaves.

namespace mc {

/// Which side of the surface is solid.
enum class Inside : std::uint8_t { above, below };
enum class Normals : std::uint8_t { none, gradient, face };
enum class Interpolation : std::uint8_t { linear, midpoint };

struct Method;             // mc/method.hpp
class ComponentSelection;  // which components of a surface remain

/// A run of layers: [first, last).
struct LayerRange {
  std::int32_t first = 0, last = 0;

  bool operator==(const LayerRange&) const = default;
};

struct ExtractOptions {
  double iso = 0;  ///< sample units; finite
  Inside inside =
      Inside::above;  ///< above: value >= iso; below: !(value < iso) is outside. NaN is never solid
  Border border = Border::open;
  std::optional<IndexBox>
      region{};  ///< only these samples, as if there were no others; inside a dense volume's box
  Normals normals = Normals::gradient;
  Interpolation interpolation = Interpolation::linear;
  double cutoff = 0;  ///< edges whose values differ by less take the midpoint; >= 0
  double min_edge =
      1.0 / 1024;  ///< in [0, 0.5]: t is kept in [E, 1-E]; 0 allows coincident vertices
  Precision precision = Precision::f32;  ///< of positions
  Vec3 origin{};                         ///< subtracted from every position before rounding
  bool measure = false;                  ///< also sum area and volume (costs about as much again)
  /// Only the mesh of these layers, which lie within part_layers(); normals and the border are
  /// those of the whole. The meshes of successive parts are the whole one cut up: indices start at
  /// 0 in each part, and those past its own vertices name the first vertices of the next part. Not
  /// for streams and ChunkMesher.
  std::optional<LayerRange> part{};
  const Method* method = nullptr;  ///< null: cubes_method()
  /// Components that remain, of the same volume, iso, side and region; null: all. The run sets it
  /// (RunOptions::keep). Not for ChunkMesher.
  const ComponentSelection* selection = nullptr;

  bool operator==(const ExtractOptions&) const = default;
};

/// Extracts surfaces of arrays in memory, again and again. Keeps scratch from call to call: with a
/// mesh that is kept as well, a call like the last one allocates nothing on one thread, and on
/// several no more than its threads need, whatever the size.
class Extractor {
 public:
  Extractor();
  ~Extractor();
  Extractor(Extractor&& other) noexcept;
  Extractor& operator=(Extractor&& other) noexcept;

  /// Extracts the surface of an array into `mesh`, whose memory is used again.
  /// Shapes   view: at least 2 samples along each axis; T is one of uint8_t, int8_t, uint16_t,
  ///          int16_t, uint32_t, int32_t, int64_t, Half, float, double.
  /// Units    iso in sample units; positions are `to_world` of lattice indices.
  /// Solid    see Inside; triangles wind counter-clockwise seen from outside, also under a
  ///          mirroring map.
  /// Errors   usage: a thin view, an iso that is not finite; limit: more than 2^32-1 vertices.
  ///          The mesh is then empty.
  /// Threads  uses the caller's arena; the result does not depend on the thread count. One call at
  ///          a time.
  /// Cost     O(samples) reads, then O(surface); one bit a sample of scratch for a few planes.
  /// Source   Schroeder, Maynard, Geveci, "Flying Edges", LDAV 2015. Differs: one bit a sample,
  ///          ids by popcount, a case table whose face rule leaves no holes.
  template <class T>
  void extract(View3<const T> view, const ExtractOptions& options, const Affine& to_world,
               Mesh& mesh);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Extracts one surface: Extractor::extract() into a new mesh.
template <class T>
Mesh extract(View3<const T> view, const ExtractOptions& options, const Affine& to_world = {});

}  // namespace mc
