// SPDX-License-Identifier: MIT
#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "kernel_bench.hpp"
#include "mc/edit.hpp"
#include "mc/pipe.hpp"
#include "terrain_readers.hpp"

// What a dab of a brush costs, up to the new meshes of all chunks that it reaches: on one thread,
// at random places of a terrain's surface, a percentile of the single times. A dab is the demo's
// (radius 1 in 20x10x20 cells), or a smoothstep of radius 8 in volumes of several sizes, dense and
// sparse. Before timing, chunks that were followed through dabs are compared with fresh ones.

namespace mc::bench {

namespace {

struct Brush {
  double radius;
  FalloffType falloff;
  double strength;
};

/// A terrain under dabs, and the mesher that follows it.
class Site {
 public:
  Site(const Index3& dims, bool sparse, std::int32_t n_cells)
      : terrain_(dims),
        input_(open(terrain_, sparse)),
        store_(input_, {}),
        mesher_(store_, {.extract = {.iso = 0}, .to_world = {}, .n_cells = n_cells}) {
    store_.keep_undo(64);
  }

  /// The next dab, somewhere on the surface, now out of the ground and now into it.
  [[nodiscard]] Edit next(const Brush& brush) {
    Edit edit;
    edit.op = n_dabs_++ % 2 == 0 ? EditOp::add : EditOp::subtract;
    const Index3& n = terrain_.dims();
    const std::int32_t i = place(n[0]), k = place(n[2]);
    edit.shape.center = {static_cast<double>(i), terrain_.height(i, k), static_cast<double>(k)};
    edit.shape.radius = brush.radius;
    edit.falloff.type = brush.falloff;
    edit.strength = brush.strength;
    return edit;
  }
  void apply(const Edit& edit) { store_.apply(edit); }
  void undo() { store_.undo(); }
  /// Makes the chunks anew that changed.
  void follow() {
    mesher_.update(store_.take_dirty(), [this](const SurfaceChunk& chunk) {
      n_triangles_ += chunk.mesh.n_triangles();
      ++n_chunks_;
    });
  }
  /// Follows some dabs and compares.
  [[nodiscard]] bool right();

  [[nodiscard]] std::uint64_t n_triangles() const { return n_triangles_; }
  [[nodiscard]] std::uint64_t n_chunks() const { return n_chunks_; }

 private:
  static VolumeReader open(const Terrain& terrain, bool sparse) {
    if (sparse) return std::unique_ptr<LeafReader>(new TerrainLeaves(terrain));
    return std::unique_ptr<SlabReader>(new TerrainSlabs(terrain));
  }
  /// Not at the border.
  std::int32_t place(std::int32_t n) {
    const std::int32_t margin = std::min(12, n / 4);
    return std::uniform_int_distribution<std::int32_t>(margin, n - 1 - margin)(random_);
  }

  Terrain terrain_;
  VolumeReader input_;
  EditStore store_;
  ChunkMesher mesher_;
  std::mt19937 random_{7};
  std::uint64_t n_dabs_ = 0, n_triangles_ = 0, n_chunks_ = 0;
};

bool Site::right() {
  std::map<Index3, std::vector<float>> followed, fresh;
  const auto keep_in = [](auto& chunks) {
    return [&chunks](const SurfaceChunk& c) {
      chunks[c.id].assign(c.mesh.positions.begin(), c.mesh.positions.end());
      if (c.mesh.n_triangles() == 0) chunks.erase(c.id);
    };
  };
  mesher_.build(keep_in(followed));
  for (int n = 0; n < 8; ++n) {
    apply(next({3, FalloffType::smoothstep, 2}));
    mesher_.update(store_.take_dirty(), keep_in(followed));
  }
  ChunkMesher(store_, {.extract = {.iso = 0}, .to_world = {}, .n_cells = 16}).build(keep_in(fresh));
  return followed == fresh && !fresh.empty();
}

/// Single times, and what is told of them.
class Latencies {
 public:
  void add(double seconds) { seconds_.push_back(seconds); }
  void tell(benchmark::State& state) {
    std::ranges::sort(seconds_);
    for (const auto& [name, share] : kShares) {
      const auto at = static_cast<std::size_t>(share * static_cast<double>(seconds_.size()));
      state.counters[name] = 1e6 * seconds_[std::min(at, seconds_.size() - 1)];
    }
  }

 private:
  /// In microseconds.
  static constexpr std::pair<const char*, double> kShares[] = {
      {"p01", 0.01}, {"p10", 0.1},  {"p25", 0.25}, {"p50", 0.5},    {"p75", 0.75},
      {"p90", 0.9},  {"p95", 0.95}, {"p99", 0.99}, {"p999", 0.999}, {"max", 1}};
  std::vector<double> seconds_;
};

/// What of a dab is timed.
enum class Timed { all, edit, undo };

/// Of this thread, so that whoever else wants the processor is not counted.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class F>
double seconds_of(F&& f) {
  const double start = processor_seconds();
  f();
  return processor_seconds() - start;
}

void run_dabs(benchmark::State& state, Site& site, const Brush& brush, Timed timed) {
  const base::ThreadLimit one(1);
  Latencies latencies;
  const std::uint64_t chunks_before = site.n_chunks(), triangles_before = site.n_triangles();
  for ([[maybe_unused]] auto _ : state) {
    const Edit edit = site.next(brush);
    const double to_edit = seconds_of([&] { site.apply(edit); });
    double seconds = to_edit + seconds_of([&] { site.follow(); });
    if (timed == Timed::edit) seconds = to_edit;
    if (timed == Timed::undo) {
      seconds = seconds_of([&] {
        site.undo();
        site.follow();
      });
    }
    latencies.add(seconds);
    state.SetIterationTime(seconds);
  }
  latencies.tell(state);
  const auto n = static_cast<double>(state.iterations());
  state.counters["chunks"] = static_cast<double>(site.n_chunks() - chunks_before) / n;
  state.counters["triangles"] = static_cast<double>(site.n_triangles() - triangles_before) / n;
}

struct Case {
  std::string name;
  Index3 dims;
  bool sparse;
  std::int32_t n_cells;
  Brush brush;
};

void add_dabs(const Case& c, Timed timed, const std::string& suffix, int n_dabs) {
  benchmark::RegisterBenchmark((c.name + suffix).c_str(),
                               [=](benchmark::State& state) {
                                 if (!Site({64, 64, 64}, c.sparse, 16).right())
                                   return state.SkipWithError("chunks differ");
                                 Site site(c.dims, c.sparse, c.n_cells);
                                 for (int n = 0; n < 200; ++n) {  // warms scratch
                                   site.apply(site.next(c.brush));
                                   site.follow();
                                 }
                                 run_dabs(state, site, c.brush, timed);
                               })
      ->Iterations(n_dabs)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace

void add_chunks() {
  constexpr Brush kDemo{1, FalloffType::hard, 0.04};
  constexpr Brush kSmooth{8, FalloffType::smoothstep, 2};
  const std::int32_t n_default = ChunkOptions{}.n_cells;
  std::vector<Case> cases{{"Dab/demo", {21, 11, 21}, false, n_default, kDemo}};
  for (const std::int32_t n : {128, 512, 1024}) {
    const std::string name = std::string("Dab/dense/") + std::to_string(n);
    cases.push_back({name, {n, n, n}, false, n_default, kSmooth});
  }
  cases.push_back({"Dab/sparse/1024", {1024, 1024, 1024}, true, n_default, kSmooth});
  for (const Case& c : cases) {
    add_dabs(c, Timed::all, "", 4000);
    add_dabs(c, Timed::edit, "/edit", 4000);
    add_dabs(c, Timed::undo, "/undo", 2000);
  }
  for (const std::int32_t n_cells : {8, 16, 32, 64, 128}) {
    add_dabs({"Chunk", {512, 512, 512}, false, n_cells, kSmooth}, Timed::all,
             std::string("/") + std::to_string(n_cells), 1000);
  }
}

}  // namespace mc::bench
