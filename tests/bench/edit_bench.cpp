// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "kernel_bench.hpp"
#include "mc/edit.hpp"
#include "support/memory_readers.hpp"

// What brushes cost, without meshing: warm, one thread. The volumes need no memory: planes of all
// sizes are one plane, and the sparse terrain is a shell of leaves.

namespace mc::bench {

namespace {

/// A dense volume of which every plane is the same memory.
class OnePlane final : public SlabReader {
 public:
  explicit OnePlane(const Index3& dims)
      : plane_(static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(dims[1]), 0.25F) {
    volume_.type = SampleType::f32;
    volume_.lattice.box = {{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}};
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    out.k0 = k0;
    out.row_stride_bytes = static_cast<std::size_t>(volume_.lattice.box.extent(0)) * sizeof(float);
    out.planes.assign(static_cast<std::size_t>(k1 - k0),
                      reinterpret_cast<const std::byte*>(plane_.data()));
  }
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

 private:
  Volume volume_;
  std::vector<float> plane_;
};

/// The leaves around a rolling surface y = h(x, z) over side x side samples: a distance of +-4.
class ShellOfLeaves final : public LeafReader {
 public:
  explicit ShellOfLeaves(std::int32_t side) {
    volume_.type = SampleType::f32;
    std::vector<double> heights;
    for (std::int32_t z = 0; z < side; z += 8) {
      heights.clear();
      for (std::int32_t x = 0; x < side; x += 8) heights.push_back(height(x + 4, z + 4));
      for (std::int32_t y = 0; y < side; y += 8) {
        for (std::int32_t x = 0; x < side; x += 8) {
          const double off = heights[static_cast<std::size_t>(x / 8)] - (y + 4);
          if (std::abs(off) < 12) origins_.push_back({x, y, z});
        }
      }
    }
    volume_.lattice.box = {{0, 0, 0}, {side - 1, side - 1, side - 1}};
  }
  static double height(double x, double z) {
    return 512 + 60 * std::sin(x * 0.013) + 60 * std::cos(z * 0.017);
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] Scalar background() const override { return Scalar::of(-4.0F); }
  [[nodiscard]] std::span<const Index3> leaves() const override { return origins_; }
  const std::byte* leaf_values(std::size_t n, std::byte* scratch) const override {
    auto* out = reinterpret_cast<float*>(scratch);
    const Index3& at = origins_[n];
    const auto h = static_cast<float>(height(at[0] + 4, at[2] + 4));
    for (std::int32_t s = 0; s < 512; ++s) {
      out[s] = h - static_cast<float>(at[1] + s / 8 % 8);
    }
    return scratch;
  }
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t /*n*/) const override {
    std::array<std::uint64_t, 8> all;
    all.fill(~std::uint64_t{0});
    return all;
  }
  [[nodiscard]] std::span<const Tile> tiles() const override { return {}; }

 private:
  Volume volume_;
  std::vector<Index3> origins_;
};

Edit ball(const Vec3& center, double radius, FalloffType falloff) {
  Edit edit;
  edit.shape.center = center;
  edit.shape.radius = radius;
  edit.falloff.type = falloff;
  edit.strength = 0.04;
  return edit;
}

/// Dabs of one brush at random places near the middle; the last 64 can be undone.
void dab(benchmark::State& state, const VolumeReader& input, double radius, FalloffType falloff) {
  const base::ThreadLimit one(1);
  EditStore store(input, {});
  store.keep_undo(64);
  const Index3 dims = volume_of(input).lattice.dims();
  std::mt19937 random(1);
  std::vector<Edit> edits;
  for (int n = 0; n < 256; ++n) {
    Vec3 at;
    for (std::size_t a = 0; a < 3; ++a) {
      const double room = std::min(dims[a] / 2.0, 40.0);
      at[a] = std::floor(dims[a] / 2.0 +
                         std::uniform_real_distribution<double>(-room, room)(random) * 0.7);
    }
    edits.push_back(ball(at, radius, falloff));
  }
  for (const Edit& edit : edits) store.apply(edit);
  std::uint64_t n_samples = 0;
  std::size_t n = 0;
  for ([[maybe_unused]] auto _ : state) n_samples += store.apply(edits[n++ % 256]).n_samples;
  state.counters["samples"] =
      benchmark::Counter(static_cast<double>(n_samples), benchmark::Counter::kAvgIterations);
}

/// Undo and redo in turn of an edit; the time is of one of both.
void undo(benchmark::State& state, const VolumeReader& input, double radius) {
  const base::ThreadLimit one(1);
  EditStore store(input, {});
  store.apply(ball({64, 64, 64}, radius, FalloffType::smoothstep));
  store.apply(ball({66, 64, 64}, radius, FalloffType::smoothstep));
  bool done = true;
  for ([[maybe_unused]] auto _ : state) {
    done ? store.undo() : store.redo();
    done = !done;
  }
}

void dabs_on_terrain(benchmark::State& state) {
  const base::ThreadLimit one(1);
  const VolumeReader input = std::make_unique<ShellOfLeaves>(1024);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(20, 1000);
  std::vector<Edit> edits;
  for (int n = 0; n < 1000; ++n) {
    const double x = place(random), z = place(random);
    edits.push_back(ball({x, ShellOfLeaves::height(x, z), z}, 8, FalloffType::smoothstep));
  }
  for ([[maybe_unused]] auto _ : state) {
    EditStore store(input, {});
    for (const Edit& edit : edits) store.apply(edit);
    state.counters["blocks"] = static_cast<double>(store.n_stored_blocks());
  }
}

}  // namespace

void add_edits() {
  const auto add = [](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(("edit/" + name).c_str(), run)->Unit(benchmark::kMicrosecond);
  };
  add("demo", [](benchmark::State& state) {
    const VolumeReader input = std::make_unique<OnePlane>(Index3{21, 11, 21});
    dab(state, input, 1, FalloffType::hard);
  });
  for (const std::int32_t side : {128, 512, 1024}) {
    add("radius8/" + std::to_string(side), [=](benchmark::State& state) {
      const VolumeReader input = std::make_unique<OnePlane>(Index3{side, side, side});
      dab(state, input, 8, FalloffType::smoothstep);
    });
    add("undo8/" + std::to_string(side), [=](benchmark::State& state) {
      const VolumeReader input = std::make_unique<OnePlane>(Index3{side, side, side});
      undo(state, input, 8);
    });
  }
  add("terrain1024/1000_dabs", dabs_on_terrain);
}

}  // namespace mc::bench
