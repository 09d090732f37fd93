// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "cli/bench/bench_field.hpp"
#include "mc/extract.hpp"
#include "mc/mesh.hpp"

// The library call that benchmarks time, and the proof that its result is right.

namespace mc::cli {

/// Extracts one volume again and again into the same mesh. World units are those of the field: the
/// volume spans [-1, 1] along each axis.
class BenchSurface {
 public:
  /// Keeps a reference to `volume`.
  BenchSurface(const BenchVolume& volume, Normals normals);

  void extract();
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] std::uint64_t mesh_bytes() const;

 private:
  const BenchVolume& volume_;
  ExtractOptions options_;
  Affine to_world_;
  Extractor extractor_;
  Mesh mesh_;
};

/// Checks a mesh of `volume` against plain counting: there is a vertex for each crossed lattice
/// edge, every triangle's sides inside the volume are run once each way, every vertex is used, and
/// normals are of unit length. Returns what is wrong, or "".
/// Cost     one scalar pass over the samples, one over the mesh.
std::string fault_of(const BenchVolume& volume, const Mesh& mesh);

/// Checks the area and volume of the sphere in [-1, 1]^3, from n samples an axis of a type, against
/// 4/3 pi r^3. Returns what is wrong, or "".
std::string fault_of_sphere(const Mesh& mesh, std::int32_t n, SampleType type);

}  // namespace mc::cli
