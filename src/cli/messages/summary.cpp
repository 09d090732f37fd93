// SPDX-License-Identifier: MIT
#include "cli/messages/summary.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include "base/machine_memory.hpp"

namespace mc::cli {

void Summary::add_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  n_bytes_ += static_cast<std::uint64_t>(status.st_size);
}

void Summary::add_mesh(std::span<const MeshTotals> totals) {
  has_mesh_ = true;
  for (const MeshTotals& one : totals) {
    n_vertices_ += one.n_vertices;
    n_triangles_ += one.n_triangles;
  }
}

void Summary::add_samples(const IndexBox& box) {
  samples_ = fmt::format("{} x {} x {} samples", box.extent(0), box.extent(1), box.extent(2));
}

void Summary::add_input(bool written) {
  ++n_inputs_;
  if (written) ++n_written_;
}

std::string Summary::text(const std::string& files) const {
  std::vector<std::string> parts;
  if (n_inputs_ > 0) parts.push_back(fmt::format("{} of {} meshes", n_written_, n_inputs_));
  if (has_mesh_) {
    parts.push_back(fmt::format("{} vertices, {} triangles", n_vertices_, n_triangles_));
  }
  if (!samples_.empty()) parts.push_back(samples_);
  if (n_bytes_ > 0) parts.push_back(base::size_text(n_bytes_));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began_;
  parts.push_back(fmt::format("{:.2f} s", seconds.count()));
  return fmt::format("{}: {}", files, fmt::join(parts, ", "));
}

}  // namespace mc::cli
