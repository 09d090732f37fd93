// SPDX-License-Identifier: MIT
#include "process/simplify/simplifier.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/vectors.hpp"

namespace mc::process {

namespace {

/// Part of a collapse's cost that grows with the distance, so that in flat parts, where all other
/// costs are nothing, near vertices go first and triangles stay well shaped.
constexpr double kDistanceCost = 1e-5;
constexpr float kTooMuch = std::numeric_limits<float>::infinity();

}  // namespace

Simplifier::Simplifier(CollapseMesh mesh)
    : mesh_(std::move(mesh)),
      quadrics_(mesh_.n_vertices()),
      places_(mesh_.n_vertices()),
      choices_(mesh_.n_vertices()),
      moved_to_(mesh_.n_vertices()),
      queue_(mesh_.n_vertices()) {
  add_triangles();
  for (std::uint32_t v = 0; v < mesh_.n_vertices(); ++v) {
    moved_to_[v] = v;
    set_place(v);
    n_free_ += mesh_.is_free(v) ? 1 : 0;
  }
}

/// Gives each triangle's plane, weighted by its area, to its vertices.
void Simplifier::add_triangles() {
  for (std::size_t t = 0; t < mesh_.n_all_triangles(); ++t) {
    const std::uint32_t* corner = mesh_.triangle(t);
    const Vec3& a = mesh_.position(corner[0]);
    const Vec3 normal =
        cross(minus(mesh_.position(corner[1]), a), minus(mesh_.position(corner[2]), a));
    const double twice_area = length(normal);
    if (!(twice_area > 0)) continue;
    Quadric quadric;
    quadric.add_plane(scaled(normal, 1 / twice_area), a, 0.5 * twice_area);
    for (std::size_t c = 0; c < 3; ++c) quadrics_[corner[c]].add(quadric);
  }
}

void Simplifier::set_place(std::uint32_t vertex) {
  const Vec3& at = mesh_.position(vertex);
  places_[vertex] = {at, std::max(0.0, quadrics_[vertex](at)), quadrics_[vertex].weight};
}

/// Infinite if the error is more than is allowed.
float Simplifier::cost(std::uint32_t from, std::uint32_t onto) const {
  const Quadric& quadric = quadrics_[from];
  const Place& to = places_[onto];
  const double error = std::max(0.0, quadric(to.at) + to.error);
  if (error > max_square_ * (quadric.weight + to.weight)) return kTooMuch;
  const Vec3 step = minus(to.at, places_[from].at);
  return static_cast<float>(error + kDistanceCost * quadric.weight * dot(step, step));
}

/// Chooses the cheapest neighbour of a free vertex among those that are worse than a choice before,
/// and puts the vertex in the queue if there is one.
void Simplifier::choose(std::uint32_t vertex, const Choice& worse_than) {
  Choice best;
  mesh_.for_corners(vertex, [&](std::uint32_t corner) {
    const std::uint32_t onto = mesh_.after(corner);
    const Choice choice{cost(vertex, onto), onto};
    if (choice.cost < kTooMuch && choice < best && worse_than < choice) best = choice;
  });
  choices_[vertex] = best;
  if (best.onto == CollapseQueue::kNone) {
    queue_.remove(vertex);
  } else {
    queue_.put(vertex, best.cost);
  }
}

/// Looks at a neighbour of `changed`, which was one of `gone` before.
void Simplifier::reconsider(std::uint32_t vertex, std::uint32_t gone, std::uint32_t changed) {
  Choice& choice = choices_[vertex];
  if (choice.onto == gone || choice.onto == changed || choice.onto == CollapseQueue::kNone) {
    return choose(vertex, kBest);
  }
  const Choice other{cost(vertex, changed), changed};
  if (!(other < choice)) return;
  choice = other;
  queue_.put(vertex, choice.cost);
}

void Simplifier::collapse(std::uint32_t a, std::uint32_t b) {
  mesh_.collapse(a, b);
  moved_to_[a] = b;
  quadrics_[b].add(quadrics_[a]);
  set_place(b);
  ring_.clear();
  mesh_.for_corners(b, [&](std::uint32_t corner) {
    ring_.push_back(mesh_.after(corner));
    if (!mesh_.is_free(b)) ring_.push_back(mesh_.before(corner));
  });
  if (mesh_.is_free(b)) {
    choose(b, kBest);
  } else {
    std::ranges::sort(ring_);
    ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
  }
  for (const std::uint32_t vertex : ring_) {
    if (mesh_.is_free(vertex)) reconsider(vertex, a, b);
  }
}

void Simplifier::run(const CollapseLimits& limits) {
  max_square_ = limits.max_error * limits.max_error;
  for (std::uint32_t v = 0; v < mesh_.n_vertices(); ++v) {
    if (mesh_.is_free(v)) choose(v, kBest);
  }
  std::size_t n = 0;
  while (n < limits.max_collapses &&
         static_cast<double>(mesh_.n_triangles()) - 1 >= limits.min_triangles) {
    const std::uint32_t vertex = queue_.take();
    if (vertex == CollapseQueue::kNone) break;
    const Choice choice = choices_[vertex];
    if (mesh_.keeps_topology(vertex, choice.onto) && mesh_.keeps_shape(vertex, choice.onto)) {
      collapse(vertex, choice.onto);
      ++n;
    } else {
      choose(vertex, choice);
    }
  }
}

std::uint32_t Simplifier::end_of(std::uint32_t vertex) {
  std::uint32_t end = vertex;
  while (moved_to_[end] != end) end = moved_to_[end];
  while (moved_to_[vertex] != end) vertex = std::exchange(moved_to_[vertex], end);
  return end;
}

}  // namespace mc::process
