// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"

// Extraction of an array in memory, one thread and all, beside the time to read the same array
// once: the ratio of the two is what counts. A sink that drops chunks stands in for an output.

namespace mc::bench {
namespace {

constexpr std::int32_t kSize = 256;

double sphere(double x, double y, double z) { return 0.8 - std::sqrt(x * x + y * y + z * z); }
double gyroid(double x, double y, double z) {
  const double s = 4 * std::numbers::pi;  // four periods an axis
  return std::sin(s * x) * std::cos(s * y) + std::sin(s * y) * std::cos(s * z) +
         std::sin(s * z) * std::cos(s * x);
}

const std::vector<float>& field(int which) {
  static std::vector<float> fields[2];
  std::vector<float>& out = fields[which];
  if (out.empty()) {
    for (std::int32_t k = 0; k < kSize; ++k) {
      for (std::int32_t j = 0; j < kSize; ++j) {
        for (std::int32_t i = 0; i < kSize; ++i) {
          const auto at = [](std::int32_t n) { return 2.0 * n / (kSize - 1) - 1; };
          out.push_back(static_cast<float>((which == 0 ? sphere : gyroid)(at(i), at(j), at(k))));
        }
      }
    }
  }
  return out;
}

class ArraySlabs final : public SlabReader {
 public:
  explicit ArraySlabs(const std::vector<float>& samples) : samples_(samples) {
    volume_.lattice.box = {{0, 0, 0}, {kSize - 1, kSize - 1, kSize - 1}};
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    out.k0 = k0;
    out.row_stride_bytes = kSize * sizeof(float);
    out.planes.clear();
    for (std::int32_t k = k0; k < k1; ++k) {
      out.planes.push_back(reinterpret_cast<const std::byte*>(
          samples_.data() + static_cast<std::size_t>(k) * kSize * kSize));
    }
  }
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

 private:
  const std::vector<float>& samples_;
  Volume volume_;
};

class DroppingSink final : public MeshSink {
 public:
  void begin_object(const MeshObject& /*object*/) override {}
  void place(const MeshChunk& chunk, std::size_t /*slot*/) override {
    benchmark::DoNotOptimize(chunk.indices.data());
  }
  void end_object(const MeshTotals& /*totals*/) override {}
  void finish() override {}
};

void extract_field(benchmark::State& state) {
  const base::ThreadLimit limit(static_cast<int>(state.range(2)));
  const std::vector<float>& samples = field(static_cast<int>(state.range(0)));
  const VolumeReader reader = std::unique_ptr<SlabReader>(std::make_unique<ArraySlabs>(samples));
  RunOptions options;
  options.extract.normals = state.range(1) == 0 ? Normals::none : Normals::gradient;
  DroppingSink sink;
  std::uint64_t n_triangles = 0;
  for ([[maybe_unused]] auto _ : state) {
    n_triangles = run(reader, options, false, sink, silent_progress(), {}).n_triangles;
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["samples/s"] =
      benchmark::Counter(rounds * static_cast<double>(samples.size()), benchmark::Counter::kIsRate);
  state.counters["triangles/s"] =
      benchmark::Counter(rounds * static_cast<double>(n_triangles), benchmark::Counter::kIsRate);
}
BENCHMARK(extract_field)
    ->ArgNames({"gyroid", "normals", "threads"})
    ->ArgsProduct({{0, 1}, {0, 1}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// What memory allows: the largest sample, by one thread.
void read_field(benchmark::State& state) {
  const std::vector<float>& samples = field(0);
  for ([[maybe_unused]] auto _ : state) {
    float lanes[64] = {};
    for (std::size_t n = 0; n < samples.size(); n += 64) {
      for (std::size_t l = 0; l < 64; ++l) lanes[l] = std::max(lanes[l], samples[n + l]);
    }
    benchmark::DoNotOptimize(lanes);
  }
  state.counters["samples/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(samples.size()),
      benchmark::Counter::kIsRate);
}
BENCHMARK(read_field)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace mc::bench

BENCHMARK_MAIN();
