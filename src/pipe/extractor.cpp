// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"
#include "mc/extract.hpp"
#include "mc/pipe.hpp"
#include "mesh/chunk_room.hpp"
#include "mesh/memory_sink.hpp"
#include "pipe/drive.hpp"
#include "pipe/tasks.hpp"

// Arrays in memory to meshes in memory: an array is a SlabReader, a mesh is a MeshSink, and what a
// run needs besides is kept for the next.

namespace mc {

namespace {

/// An array of samples, which may be another at every run.
class ArrayReader final : public SlabReader {
 public:
  ArrayReader(SampleType type, const Index3& dims) {
    volume_.type = type;
    volume_.lattice.box = {{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}};
  }

  template <class T>
  void look_at(View3<const T> view) {
    data_ = reinterpret_cast<const std::byte*>(view.data);
    row_bytes_ = view.row_stride * std::ptrdiff_t{sizeof(T)};
    plane_bytes_ = view.plane_stride * std::ptrdiff_t{sizeof(T)};
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    out.k0 = k0;
    out.row_stride_bytes = static_cast<std::size_t>(row_bytes_);
    out.planes.clear();
    for (std::int32_t k = k0; k < k1; ++k) {
      out.planes.push_back(data_ + k * plane_bytes_);
    }
  }
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

 private:
  const std::byte* data_ = nullptr;
  std::ptrdiff_t row_bytes_ = 0, plane_bytes_ = 0;
  Volume volume_;
};

void check(const Index3& dims, const ExtractOptions& options) {
  for (const std::int32_t n : dims) {
    if (n < 2) {
      throw Error(ErrorKind::usage, "dims", "fewer than 2 samples along an axis");
    }
  }
  if (!std::isfinite(options.iso)) {
    throw Error(ErrorKind::usage, "iso", "is not finite");
  }
}

}  // namespace

struct Extractor::Scratch {
  /// Tasks over arrays of one type and size, with one set of options.
  struct Setup {
    Setup(SampleType type, const Index3& extent, const RunOptions& options)
        : dims(extent), reader(type, extent), tasks(pipe::dense_tasks(reader, options)) {}
    Setup(const Setup&) = delete;
    Setup& operator=(const Setup&) = delete;

    Index3 dims;
    ArrayReader reader;
    std::unique_ptr<pipe::TaskList> tasks;
    pipe::Room room{.n_slots = 0, .chunk_bytes = mesh::ChunkRoom::kUnlimited, .n_makers = 0};
  };

  /// The tasks for this call: those of the last one, where they fit.
  Setup& set_up(SampleType type, const Index3& dims, const ExtractOptions& options,
                const Affine& to_world) {
    const bool fits = setup && setup->dims == dims && setup->reader.volume().type == type &&
                      run_options.extract == options && run_options.to_world == to_world;
    if (!fits) {
      setup.reset();
      run_options.extract = options;
      run_options.to_world = to_world;
      setup.emplace(type, dims, run_options);
    }
    const std::size_t n_slots = base::pipeline_slots();
    if (n_slots != setup->room.n_slots) {
      setup->room.n_slots = n_slots;
      setup->tasks->set_room(setup->room);
    }
    return *setup;
  }

  RunOptions run_options;
  std::optional<Setup> setup;
  pipe::Drive drive;
  mesh::MemorySink sink;
};

Extractor::Extractor() : scratch_(std::make_unique<Scratch>()) {}
Extractor::~Extractor() = default;
Extractor::Extractor(Extractor&& other) noexcept = default;
Extractor& Extractor::operator=(Extractor&& other) noexcept = default;

template <class T>
void Extractor::extract(View3<const T> view, const ExtractOptions& options, const Affine& to_world,
                        Mesh& mesh) {
  Scratch& s = *scratch_;
  s.sink.start(mesh);
  check(view.dims, options);
  try {
    Scratch::Setup& setup = s.set_up(field::type_of<T>(), view.dims, options, to_world);
    setup.reader.look_at(view);
    setup.tasks->forget();
    s.drive.run(*setup.tasks, setup.room, s.run_options, true, {}, s.sink, silent_progress(), {});
  } catch (...) {
    s.sink.start(mesh);  // what is there of it is no mesh
    throw;
  }
  s.sink.finish();
}

template <class T>
Mesh extract(View3<const T> view, const ExtractOptions& options, const Affine& to_world) {
  Mesh mesh;
  Extractor().extract(view, options, to_world, mesh);
  return mesh;
}

#define MC_EXTRACT_FOR(T)                                                                        \
  template void Extractor::extract(View3<const T>, const ExtractOptions&, const Affine&, Mesh&); \
  template Mesh extract(View3<const T>, const ExtractOptions&, const Affine&)

MC_EXTRACT_FOR(std::uint8_t);
MC_EXTRACT_FOR(std::int8_t);
MC_EXTRACT_FOR(std::uint16_t);
MC_EXTRACT_FOR(std::int16_t);
MC_EXTRACT_FOR(std::uint32_t);
MC_EXTRACT_FOR(std::int32_t);
MC_EXTRACT_FOR(std::int64_t);
MC_EXTRACT_FOR(Half);
MC_EXTRACT_FOR(float);
MC_EXTRACT_FOR(double);

#undef MC_EXTRACT_FOR

}  // namespace mc
