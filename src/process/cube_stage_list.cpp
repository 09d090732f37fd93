// SPDX-License-Identifier: MIT
#include "process/cube_stage_list.hpp"

#include <algorithm>
#include <cassert>

namespace mc::process {

void CubeStageList::check() const {
  for (const CubeStage* stage : stages_) {
    const std::int32_t n = stage->n_cells();
    if (n < 2 || n % 2 != 0) {
      throw Error(ErrorKind::usage, stage->name(),
                  "works on cubes of " + std::to_string(n) +
                      " cells; expected an even number of at least 2");
    }
    if (n != n_cells()) {
      throw Error(ErrorKind::usage, stage->name(),
                  "works on cubes of " + std::to_string(n) + " cells, but " +
                      std::string(stages_.front()->name()) + " on cubes of " +
                      std::to_string(n_cells()));
    }
  }
}

bool CubeStageList::measure() const {
  return std::ranges::any_of(stages_, [](const CubeStage* s) { return s->measures(); });
}

std::uint64_t CubeStageList::held_bytes() const {
  std::uint64_t sum = 0;
  for (const CubeStage* stage : stages_) sum += stage->bytes().held;
  return sum;
}

std::uint64_t CubeStageList::vertex_bytes() const {
  std::uint64_t most = 0;
  for (const CubeStage* stage : stages_) {
    most = std::max<std::uint64_t>(most, stage->bytes().each_vertex);
  }
  return most;
}

std::uint64_t CubeStageList::triangle_bytes() const {
  std::uint64_t most = 0;
  for (const CubeStage* stage : stages_) {
    most = std::max<std::uint64_t>(most, stage->bytes().each_triangle);
  }
  return most;
}

bool CubeStageList::with_normals(bool before) const {
  MeshObject object;
  object.has_normals = before;
  bool any = before;
  for (const CubeStage* stage : stages_) {
    stage->describe(object);
    any = any || object.has_normals;
  }
  return any;
}

void CubeStageList::describe(MeshObject& object) const {
  for (const CubeStage* stage : stages_) stage->describe(object);
}

void CubeStageList::apply(MeshCube& cube) const {
  for (const CubeStage* stage : stages_) {
    [[maybe_unused]] const std::size_t n_vertices = cube.mesh.n_vertices();
    [[maybe_unused]] const std::size_t n_triangles = cube.mesh.n_triangles();
    stage->apply(cube);
    assert(cube.n_seam <= cube.mesh.n_vertices() && cube.mesh.n_vertices() <= n_vertices);
    assert(cube.mesh.n_triangles() <= n_triangles);
  }
}

std::string CubeStageList::names() const {
  std::string out;
  for (const CubeStage* stage : stages_) {
    if (!out.empty()) out += ", ";
    out += stage->name();
  }
  return out;
}

}  // namespace mc::process
