// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "base/parallel.hpp"
#include "extract/dense.hpp"
#include "extract/threshold.hpp"
#include "pipe/tasks.hpp"

// Dense volumes: a task is a slab of cell layers.

namespace mc::pipe {

namespace {

/// Samples that one slab should hold, so that its planes stay in a core's cache.
constexpr std::uint64_t kSlabSamples = 1U << 20U;
constexpr std::int32_t kMinLayers = 4;   // fewer would read the shared planes too often
constexpr std::int32_t kMaxLayers = 64;  // more would leave threads idle at the end

// Where a plane costs more to make than to move, few are made twice, for the slabs on both sides.
constexpr std::int32_t kDearLayers = 61;  // 64 planes
constexpr std::uint64_t kDearSlabBytes = 64U << 20U;
constexpr int kTasksAThread = 4;

class DenseTasks final : public TaskList {
 public:
  DenseTasks(const SlabReader& reader, const RunOptions& options)
      : reader_(reader),
        prototype_{{reader.volume(), options.to_world.value_or(reader.volume().lattice.to_world),
                    options.extract},
                   {}} {
    const Volume& volume = reader.volume();
    const IndexBox box = options.extract.region.value_or(volume.lattice.box);
    plane_samples_ = static_cast<std::uint64_t>(box.extent(0) * box.extent(1));
    if (options.skip) {
      query_ = {extraction::effective_iso(volume.type, options.extract.iso), box,
                options.extract.border != Border::open};
    }
    plane_bytes_ = static_cast<std::uint64_t>(volume.lattice.box.extent(0)) *
                   static_cast<std::uint64_t>(volume.lattice.box.extent(1)) *
                   sample_size(volume.type);
    layers_ = options.slab_layers > 0 ? options.slab_layers : layers_wanted();
    layers_ = std::min({layers_, extractor().max_layers(), extractor().n_layers()});
    vertex_bytes_ = (options.extract.precision == Precision::f64 ? 24 : 12) +
                    (options.extract.normals == Normals::none ? 0 : 12);
  }

  void set_slots(std::size_t n_slots) override {
    slots_.assign(n_slots, prototype_);
    shared_.reset(2 * (n_slots + 1));
    for (Slot& slot : slots_) slot.extractor.share(&shared_);
  }
  void forget() override { shared_.forget(); }
  [[nodiscard]] std::size_t n_tasks() const override {
    return static_cast<std::size_t>((extractor().n_layers() + layers_ - 1) / layers_);
  }
  [[nodiscard]] std::uint64_t samples(std::size_t n) const override {
    return plane_samples_ * static_cast<std::uint64_t>(last(n) - first(n));
  }
  void fetch(std::size_t n, std::size_t slot) override {
    if (reader_.reads_once()) read(n, slots_[slot]);
  }
  void make(std::size_t n, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    if (!reader_.reads_once()) read(n, s);
    s.extractor.extract(s.slab, first(n), last(n), out.chunk, out.totals);
    out.totals.n_asked = plane_samples_ * s.slab.planes.size();
    out.totals.n_skipped = s.slab.sides.n_left_out();
  }
  void count(std::size_t n, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    read(n, s);
    s.extractor.count(s.slab, first(n), last(n), out.totals);
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots) const override {
    const std::uint64_t slab =
        reader_.rereads_cheaply() ? 0 : plane_bytes_ * static_cast<std::uint64_t>(layers_ + 3);
    return n_slots * (extractor().scratch_bytes() + slab);
  }
  [[nodiscard]] std::uint64_t chunk_bytes() const override {
    // A flat surface through the slab: about a vertex and two triangles a column, twice over.
    return 2 * plane_samples_ * (vertex_bytes_ + 24);
  }

 private:
  struct Slot {
    extraction::DenseExtractor extractor;
    Slab slab;
  };

  [[nodiscard]] const extraction::DenseExtractor& extractor() const { return prototype_.extractor; }
  [[nodiscard]] std::int32_t first(std::size_t n) const {
    return static_cast<std::int32_t>(n) * layers_;
  }
  [[nodiscard]] std::int32_t last(std::size_t n) const {
    return std::min(extractor().n_layers() - first(n), layers_) + first(n);
  }
  [[nodiscard]] std::int32_t layers_wanted() const {
    const auto within = [](std::uint64_t v, std::int32_t lo, std::int32_t hi) {
      return static_cast<std::int32_t>(
          std::clamp<std::uint64_t>(v, std::uint64_t(lo), std::uint64_t(hi)));
    };
    const std::int32_t cached = within(kSlabSamples / plane_samples_, kMinLayers, kMaxLayers);
    if (reader_.rereads_cheaply() || reader_.reads_once()) return cached;
    const auto n_parts = static_cast<std::uint64_t>(kTasksAThread * base::thread_count());
    const auto share = static_cast<std::uint64_t>(extractor().n_layers()) / n_parts;
    const std::int32_t dear =
        within(std::min(kDearSlabBytes / plane_bytes_, share), kMinLayers, kDearLayers);
    return std::max(cached, dear);
  }
  void read(std::size_t n, Slot& s) const {
    const auto [k0, k1] = s.extractor.planes_for(first(n), last(n));
    if (query_) {
      reader_.read_surface(k0, k1, *query_, s.slab);
    } else {
      reader_.read(k0, k1, s.slab);
    }
  }

  const SlabReader& reader_;
  Slot prototype_;
  std::vector<Slot> slots_;
  extraction::SharedPlanes shared_;
  std::optional<SurfaceQuery> query_;  ///< unset: all samples are read
  std::int32_t layers_ = 1;
  std::uint64_t plane_samples_ = 0;
  std::uint64_t plane_bytes_ = 0;
  std::uint64_t vertex_bytes_ = 0;
};

}  // namespace

std::unique_ptr<TaskList> dense_tasks(const SlabReader& reader, const RunOptions& options) {
  return std::make_unique<DenseTasks>(reader, options);
}

}  // namespace mc::pipe
