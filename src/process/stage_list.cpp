// SPDX-License-Identifier: MIT
#include "process/stage_list.hpp"

#include <algorithm>
#include <cassert>

namespace mc::process {

namespace {

/// Of MeshWindow::keep(): the new id of each vertex.
constexpr std::uint32_t kKeepBytes = 4;

[[maybe_unused]] bool is_whole(const MeshChunk& mesh) {
  return mesh.normals.empty() || mesh.normals.size() == 3 * mesh.n_vertices();
}

void append_name(const MeshStage& stage, std::string& list) {
  if (!list.empty()) list += ", ";
  list += stage.name();
}

}  // namespace

void StageList::check() const {
  for (const MeshStage* stage : stages_) {
    if (stage->reach() < 0) {
      throw Error(ErrorKind::usage, stage->name(), "reaches a negative number of layers");
    }
    if (stage->changes_counts() && stage->reach() == 0) {
      throw Error(ErrorKind::usage, stage->name(),
                  "changes counts, but reaches no other layer; expected a reach of at least 1");
    }
  }
}

std::int64_t StageList::reach() const {
  std::int64_t sum = 0;
  for (const MeshStage* stage : stages_) sum += stage->reach();
  return sum;
}

bool StageList::move_vertices() const {
  return std::ranges::any_of(stages_, [](const MeshStage* s) { return s->moves_vertices(); });
}

bool StageList::change_counts() const {
  return std::ranges::any_of(stages_, [](const MeshStage* s) { return s->changes_counts(); });
}

std::uint64_t StageList::held_bytes() const {
  std::uint64_t sum = 0;
  for (const MeshStage* stage : stages_) sum += stage->bytes().held;
  return sum;
}

std::uint64_t StageList::vertex_bytes() const {
  std::uint64_t most = 0;
  for (const MeshStage* stage : stages_) {
    most = std::max<std::uint64_t>(
        most, stage->bytes().each_vertex + (stage->changes_counts() ? kKeepBytes : 0));
  }
  return most;
}

std::uint64_t StageList::triangle_bytes() const {
  std::uint64_t most = 0;
  for (const MeshStage* stage : stages_) {
    most = std::max<std::uint64_t>(most, stage->bytes().each_triangle);
  }
  return most;
}

bool StageList::with_normals(bool extracted) const {
  MeshObject object;
  object.has_normals = extracted;
  bool any = extracted;
  for (const MeshStage* stage : stages_) {
    stage->describe(object);
    any = any || object.has_normals;
  }
  return any;
}

void StageList::describe(MeshObject& object) const {
  for (const MeshStage* stage : stages_) stage->describe(object);
}

void StageList::apply(MeshWindow& window) const {
  for (const MeshStage* stage : stages_) {
    [[maybe_unused]] const std::size_t n_before = window.n_vertices();
    stage->apply(window);
    assert(is_whole(window.mesh));
    assert(stage->changes_counts() ? window.n_vertices() <= n_before
                                   : window.n_vertices() == n_before);
  }
}

std::string StageList::names() const {
  std::string out;
  for (const MeshStage* stage : stages_) append_name(*stage, out);
  return out;
}

std::string StageList::window_names() const {
  std::string out;
  for (const MeshStage* stage : stages_) {
    if (stage->reach() != 0) append_name(*stage, out);
  }
  return out;
}

}  // namespace mc::process
