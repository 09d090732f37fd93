// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "mc/process.hpp"

namespace mc::process {

/// The stages of a run, taken together.
class StageList {
 public:
  /// Keeps references to the stages.
  explicit StageList(MeshStages stages) : stages_(stages) {}

  /// Errors   usage: a negative reach; a stage that changes counts and reaches no other layer.
  void check() const;
  [[nodiscard]] bool empty() const { return stages_.empty(); }
  /// Layers of cells on each side that the result depends on.
  [[nodiscard]] std::int64_t reach() const;
  /// Whether stages are applied to windows with a halo, not to each chunk alone.
  [[nodiscard]] bool need_windows() const { return reach() != 0; }
  [[nodiscard]] bool move_vertices() const;
  [[nodiscard]] bool change_counts() const;
  [[nodiscard]] std::uint64_t held_bytes() const;
  /// Scratch of the stage that takes most.
  [[nodiscard]] std::uint64_t vertex_bytes() const;
  [[nodiscard]] std::uint64_t triangle_bytes() const;
  /// Whether vertices have normals at any time, if the extraction makes them or not.
  [[nodiscard]] bool with_normals(bool extracted) const;

  void describe(MeshObject& object) const;
  void apply(MeshWindow& window) const;
  /// "a, b": all, and those that need windows.
  [[nodiscard]] std::string names() const;
  [[nodiscard]] std::string window_names() const;

 private:
  MeshStages stages_;
};

}  // namespace mc::process
