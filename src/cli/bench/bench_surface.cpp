// SPDX-License-Identifier: MIT
#include "cli/bench/bench_surface.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "field/visit_type.hpp"

// Wrong and fast is void: a mesh is proven before it is timed, with nothing of the engine's.

namespace mc::cli {

namespace {

template <class T>
View3<const T> view_of(const BenchVolume& volume) {
  return {reinterpret_cast<const T*>(volume.samples.data()), {volume.n, volume.n, volume.n}};
}

template <class T>
bool above(T sample, double iso) {
  return static_cast<double>(field::number(sample)) >= iso;
}

/// Crossed edges that start in plane k.
template <class T>
std::uint64_t crossed_edges(const View3<const T>& view, double iso, std::int32_t k) {
  std::uint64_t n_crossed = 0;
  const auto crosses = [&](const T* at, std::ptrdiff_t step) {
    return above(at[0], iso) != above(at[step], iso);
  };
  for (std::int32_t j = 0; j < view.dims[1]; ++j) {
    const T* row = view.data + k * view.plane_stride + j * view.row_stride;
    for (std::int32_t i = 0; i < view.dims[0]; ++i) {
      if (i + 1 < view.dims[0] && crosses(row + i, 1)) ++n_crossed;
      if (j + 1 < view.dims[1] && crosses(row + i, view.row_stride)) ++n_crossed;
      if (k + 1 < view.dims[2] && crosses(row + i, view.plane_stride)) ++n_crossed;
    }
  }
  return n_crossed;
}

std::uint64_t crossed_edges(const BenchVolume& volume) {
  return field::visit_type(volume.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    const View3<const T> view = view_of<T>(volume);
    std::vector<std::uint64_t> planes(static_cast<std::size_t>(volume.n));
    base::for_ranges(planes.size(), 1, [&](std::size_t k0, std::size_t k1) {
      for (std::size_t k = k0; k < k1; ++k) {
        planes[k] = crossed_edges(view, volume.iso, static_cast<std::int32_t>(k));
      }
    });
    std::uint64_t sum = 0;
    for (const std::uint64_t n : planes) sum += n;
    return sum;
  });
}

/// Mixes the ends of a side; the finaliser of SplitMix64.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = (a << 32 | b) + 0x9E3779B97F4A7C15U;
  h = (h ^ h >> 30) * 0xBF58476D1CE4E5B9U;
  h = (h ^ h >> 27) * 0x94D049BB133111EBU;
  return h ^ h >> 31;
}

/// Whether a side from `a` to `b` lies in a face of the cube [-1, 1]^3, where the mesh may end.
bool on_border(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a[axis] == b[axis] && std::abs(a[axis]) == 1) return true;
  }
  return false;
}

/// Sides inside the volume, each way with its sign: zero when each is run as often one way as the
/// other.
std::uint64_t side_sum(const Mesh& mesh) {
  std::uint64_t sum = 0;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangle[c];
      const std::uint32_t b = triangle[(c + 1) % 3];
      if (on_border(mesh.positions[a], mesh.positions[b])) continue;
      sum += a < b ? mixed(a, b) : std::uint64_t{0} - mixed(b, a);
    }
  }
  return sum;
}

std::string index_fault(const Mesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      if (v >= used.size()) return fmt::format("a triangle names vertex {} of {}", v, used.size());
      used[v] = true;
    }
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) return fmt::format("vertex {} is in no triangle", v);
  }
  return {};
}

std::string normal_fault(const Mesh& mesh) {
  for (const auto& n : mesh.normals) {
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(std::abs(length - 1) < 1e-5)) return fmt::format("a normal of length {}", length);
  }
  return {};
}

}  // namespace

BenchSurface::BenchSurface(const BenchVolume& volume, Normals normals)
    : volume_(volume),
      to_world_(Affine::scale_translate(
          {2.0 / (volume.n - 1), 2.0 / (volume.n - 1), 2.0 / (volume.n - 1)}, {-1, -1, -1})) {
  options_.iso = volume.iso;
  options_.inside = volume.inside;
  options_.normals = normals;
}

void BenchSurface::extract() {
  field::visit_type(volume_.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    extractor_.extract(view_of<T>(volume_), options_, to_world_, mesh_);
  });
}

std::uint64_t BenchSurface::mesh_bytes() const {
  return 12 * (mesh_.positions.size() + mesh_.normals.size() + mesh_.triangles.size());
}

std::string fault_of(const BenchVolume& volume, const Mesh& mesh) {
  const std::uint64_t n_crossed = crossed_edges(volume);
  if (mesh.positions.size() != n_crossed) {
    return fmt::format("{} vertices on {} crossed edges", mesh.positions.size(), n_crossed);
  }
  if (std::string fault = index_fault(mesh); !fault.empty()) return fault;
  if (side_sum(mesh) != 0) return "a triangle's side inside the volume is not run once each way";
  return normal_fault(mesh);
}

std::string fault_of_sphere(const Mesh& mesh, std::int32_t n, SampleType type) {
  double area = 0;
  double volume = 0;
  for (const auto& triangle : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& at = mesh.positions[triangle[c]];
      p[c] = {at[0], at[1], at[2]};
    }
    const Vec3 u{p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
    const Vec3 v{p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
    const Vec3 w = cross(u, v);
    area += std::hypot(w[0], w[1], w[2]) / 2;
    volume += (p[0][0] * w[0] + p[0][1] * w[1] + p[0][2] * w[2]) / 6;
  }
  constexpr double r = kSphereRadius;
  const double wanted_area = 4 * std::numbers::pi * r * r;
  const double wanted_volume = wanted_area * r / 3;
  // Chords cut off about (h/r)^2 / 6 of the volume; 8-bit samples move vertices by a cell or more.
  const double h = 2.0 / (n - 1);
  const double allowed = h * h / (r * r) + 0.01;
  // Where a level of values spans more than a cell the surface is a stair, of more area.
  const double level = sample_size(type) == 1 ? 2.0 / 255 : 0;
  const double stair = std::hypot(1.0, level / h);
  if (area < wanted_area * (1 - allowed) || area > wanted_area * stair * (1 + allowed) ||
      std::abs(volume / wanted_volume - 1) > allowed) {
    return fmt::format("area {:.6} and volume {:.6} instead of {:.6} and {:.6}", area, volume,
                       wanted_area, wanted_volume);
  }
  return {};
}

}  // namespace mc::cli
