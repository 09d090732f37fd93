// SPDX-License-Identifier: MIT
#include "off/off.hpp"

#include <memory>
#include <string>

namespace {

/// Keeps the faces, which come after all vertices, in memory.
class OffSink final : public mc::MeshSink {
 public:
  OffSink(const std::string& path, const mc::SinkOptions& options) : out_(path, options, false) {}

  void begin_object(const mc::MeshObject&) override {}
  void place(const mc::MeshChunk& chunk, std::size_t) override {
    for (std::size_t n = 0; n < chunk.positions.size(); n += 3) {
      vertices_ += std::to_string(chunk.positions[n]) + ' ' +
                   std::to_string(chunk.positions[n + 1]) + ' ' +
                   std::to_string(chunk.positions[n + 2]) + '\n';
    }
    for (std::size_t n = 0; n < chunk.indices.size(); n += 3) {
      faces_ += '3';
      for (std::size_t c = 0; c < 3; ++c) {
        faces_ += ' ' + std::to_string(chunk.index_base + chunk.indices[n + c]);
      }
      faces_ += '\n';
    }
  }
  void end_object(const mc::MeshTotals& totals) override {
    out_.write("OFF\n" + std::to_string(totals.n_vertices) + ' ' +
               std::to_string(totals.n_triangles) + " 0\n");
    out_.write(vertices_);
    out_.write(faces_);
  }
  void finish() override { out_.finish(); }

 private:
  mc::OutputStream out_;
  std::string vertices_, faces_;
};

std::unique_ptr<mc::MeshSink> open(const std::string& path, const mc::SinkOptions& options) {
  return std::make_unique<OffSink>(path, options);
}

mc::MeshNeeds needs(const mc::SinkOptions&, bool) { return {}; }

}  // namespace

constexpr mc::SinkFormat kOffFormat{.name = "off",
                                    .display = "OFF",
                                    .extensions = "off",
                                    .open_mesh = open,
                                    .needs = needs,
                                    .text = mc::TextForm::always,
                                    .has_normals = false};
