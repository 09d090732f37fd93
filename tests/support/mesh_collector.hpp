// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"

// Runs an extraction into memory, chunk by chunk, as a sink would see it.

namespace mc::test {

struct Collected {
  Mesh mesh;
  std::vector<std::uint16_t> materials;  ///< of mesh.attributes
  MeshTotals totals;
  MeshObject object;
  int n_objects = 0;
};

class CollectingSink final : public MeshSink {
 public:
  explicit CollectingSink(Collected& out) : out_(out) {}

  void begin_object(const MeshObject& object) override {
    out_.object = object;
    ++out_.n_objects;
  }
  void place(const MeshChunk& chunk, std::size_t /*slot*/) override {
    append(chunk.positions, out_.mesh.positions);
    append(chunk.positions_f64, out_.mesh.positions_f64);
    append(chunk.normals, out_.mesh.normals);
    out_.mesh.attributes.resize(chunk.attributes.size());
    for (std::size_t n = 0; n < chunk.attributes.size(); ++n) {
      const VertexAttribute& from = chunk.attributes[n];
      VertexAttribute& to = out_.mesh.attributes[n];
      to.info = from.info;
      to.values.insert(to.values.end(), from.values.begin(), from.values.end());
      if (from.info != material_attribute()) continue;
      const auto indices = from.values_as<std::uint16_t>();
      out_.materials.insert(out_.materials.end(), indices.begin(), indices.end());
    }
    const auto base = static_cast<std::uint32_t>(chunk.index_base);
    for (std::size_t n = 0; n < chunk.indices.size(); n += 3) {
      out_.mesh.triangles.push_back(
          {base + chunk.indices[n], base + chunk.indices[n + 1], base + chunk.indices[n + 2]});
    }
  }
  void end_object(const MeshTotals& totals) override { out_.totals = totals; }
  void finish() override {}

 private:
  template <class T>
  static void append(const Buffer<T>& from, auto& to) {
    for (std::size_t n = 0; n < from.size(); n += 3) {
      to.push_back({from[n], from[n + 1], from[n + 2]});
    }
  }
  Collected& out_;
};

/// What decides how, never what: the result must not depend on it.
struct How {
  int threads = 1;
  std::int32_t slab_layers = 0;
  bool count_first = false;
  bool skip = true;
  std::uint64_t chunk_bytes = 0;
  std::optional<KeepRule> keep{};  ///< but which components remain decides what
};

inline Collected collect(const VolumeReader& reader, const ExtractOptions& options,
                         const How& how = {}) {
  const base::ThreadLimit limit(how.threads);
  RunOptions run_options;
  run_options.extract = options;
  run_options.slab_layers = how.slab_layers;
  run_options.count_first = how.count_first ? CountFirst::yes : CountFirst::no;
  run_options.skip = how.skip;
  run_options.attributes = attributes_of(reader);
  run_options.chunk_bytes = how.chunk_bytes;
  run_options.keep = how.keep;
  Collected out;
  CollectingSink sink(out);
  run(reader, run_options, true, sink, silent_progress(), {});
  return out;
}

/// A reader that somebody else owns, as a VolumeReader.
inline VolumeReader owned(std::unique_ptr<SlabReader> reader) { return reader; }
inline VolumeReader owned(std::unique_ptr<LeafReader> reader) { return reader; }

}  // namespace mc::test
