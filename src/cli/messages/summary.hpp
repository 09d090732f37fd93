// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cli/messages/console.hpp"
#include "mc/convert.hpp"

// The one line that a command that succeeded says on a terminal, unless it wrote into a pipe.

namespace mc::cli {

class Summary {
 public:
  Summary() : began_(std::chrono::steady_clock::now()) {}

  /// A file that was written.
  void add_file(const std::string& path);
  void add_mesh(std::span<const MeshTotals> totals);
  void add_samples(const IndexBox& box);
  /// An input of a batch; `written`: its mesh was made.
  void add_input(bool written);

  /// "head.glb: 6 vertices, 8 triangles, 1.2 KiB, 0.01 s"; `files` stands first.
  [[nodiscard]] std::string text(const std::string& files) const;

 private:
  std::chrono::steady_clock::time_point began_;
  std::uint64_t n_inputs_ = 0, n_written_ = 0;
  std::uint64_t n_vertices_ = 0, n_triangles_ = 0, n_bytes_ = 0;
  bool has_mesh_ = false;
  std::string samples_;
};

}  // namespace mc::cli
