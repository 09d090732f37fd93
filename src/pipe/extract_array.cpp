// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "field/visit_type.hpp"
#include "mc/extract.hpp"
#include "mc/pipe.hpp"

// mc::extract(): an array in memory is a SlabReader, a Mesh in memory is a MeshSink.

namespace mc {

namespace {

class ArrayReader final : public SlabReader {
 public:
  ArrayReader(const std::byte* data, std::size_t row_bytes, std::size_t plane_bytes, Volume volume)
      : data_(data), row_bytes_(row_bytes), plane_bytes_(plane_bytes), volume_(std::move(volume)) {}

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    out.k0 = k0;
    out.row_stride_bytes = row_bytes_;
    out.planes.clear();
    for (std::int32_t k = k0; k < k1; ++k) {
      out.planes.push_back(data_ + static_cast<std::size_t>(k) * plane_bytes_);
    }
  }
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

 private:
  const std::byte* data_;
  std::size_t row_bytes_, plane_bytes_;
  Volume volume_;
};

class MeshCollector final : public MeshSink {
 public:
  explicit MeshCollector(Mesh& mesh) : mesh_(mesh) {}

  void begin_object(const MeshObject& /*object*/) override {}
  void write(const MeshChunk& chunk) override {
    if (mesh_.positions.size() + chunk.n_vertices() > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorKind::limit, {}, "the mesh has more than 2^32-1 vertices",
                  "extract it in parts");
    }
    append(chunk.positions, mesh_.positions);
    append(chunk.normals, mesh_.normals);
    const auto base = static_cast<std::uint32_t>(chunk.index_base);
    for (std::size_t n = 0; n < chunk.indices.size(); n += 3) {
      mesh_.triangles.push_back(
          {base + chunk.indices[n], base + chunk.indices[n + 1], base + chunk.indices[n + 2]});
    }
  }
  void end_object(const MeshTotals& /*totals*/) override {}
  void finish() override {}

 private:
  static void append(const Buffer<float>& from, std::vector<std::array<float, 3>>& to) {
    for (std::size_t n = 0; n < from.size(); n += 3) {
      to.push_back({from[n], from[n + 1], from[n + 2]});
    }
  }
  Mesh& mesh_;
};

}  // namespace

template <class T>
Mesh extract(View3<const T> view, const ExtractOptions& options, const Affine& to_world) {
  for (const std::int32_t n : view.dims) {
    if (n < 2) {
      throw Error(ErrorKind::usage, "dims", "fewer than 2 samples along an axis");
    }
  }
  if (!std::isfinite(options.iso)) {
    throw Error(ErrorKind::usage, "iso", "is not finite");
  }
  Volume volume;
  volume.type = field::type_of<T>();
  volume.lattice.box = {{0, 0, 0}, {view.dims[0] - 1, view.dims[1] - 1, view.dims[2] - 1}};
  volume.lattice.to_world = to_world;
  const VolumeReader reader = std::unique_ptr<SlabReader>(std::make_unique<ArrayReader>(
      reinterpret_cast<const std::byte*>(view.data),
      static_cast<std::size_t>(view.row_stride) * sizeof(T),
      static_cast<std::size_t>(view.plane_stride) * sizeof(T), volume));
  RunOptions run_options;
  run_options.extract = options;
  run_options.extract.precision = Precision::f32;
  run_options.memory_bytes = std::numeric_limits<std::uint64_t>::max();
  Mesh mesh;
  MeshCollector collector(mesh);
  run(reader, run_options, true, collector, silent_progress(), {});
  return mesh;
}

template Mesh extract(View3<const std::uint8_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const std::int8_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const std::uint16_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const std::int16_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const std::uint32_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const std::int32_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const std::int64_t>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const Half>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const float>, const ExtractOptions&, const Affine&);
template Mesh extract(View3<const double>, const ExtractOptions&, const Affine&);

}  // namespace mc
