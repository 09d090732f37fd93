// SPDX-License-Identifier: MIT
#include "cli/bench/bench_noise.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "base/simd_target.hpp"
#include "cli/bench/bench_field.hpp"
#include "graph/rows.hpp"
#include "mc/graph.hpp"
#include "mc/pipe.hpp"

// Bodies that compute noise, each with the values that it makes.

namespace mc::cli {

namespace {

/// Values a cycle of one AVX2 core at 4.9 GHz, in three dimensions, as FastNoise2 publishes them.
constexpr double kPublishedPerlin = 261e6 / 4.9e9;
constexpr double kPublishedSimplex = 268e6 / 4.9e9;
constexpr double kPublishedCellular = 52e6 / 4.9e9;

struct NoiseBody {
  std::string name;
  std::uint64_t n_points = 0;
  double published = 0;
  TimedBody body;
};

constexpr std::size_t kSteps = std::size_t{1} << 20;

/// So many steps that each wait for the one before, and take a cycle on any processor.
void count_cycles() {
  std::uint64_t value = 1;
  std::uint64_t mask = 0x5555;
  for (std::size_t n = 0; n < kSteps; n += 8) {
    for (int step = 0; step < 8; ++step) {
      value ^= mask;
      asm volatile("" : "+r"(value), "+r"(mask));
    }
  }
}

/// Rows along x; or askew, as a warp leaves them: every coordinate changes from place to place.
class NoiseRows {
 public:
  explicit NoiseRows(float askew) {
    for (std::size_t n = 0; n < kPlaces; ++n) {
      const auto i = static_cast<float>(n % graph::kPiece);
      const std::size_t row = n / graph::kPiece;
      const auto j = static_cast<float>(row);
      at_[0][n] = i * 0.173F - 3.1F;
      at_[1][n] = j * 0.31F + i * 0.021F * askew;
      at_[2][n] = j * 0.29F - i * 0.017F * askew - 5;
    }
  }
  void run(const graph::Instruction& noise) {
    for (std::size_t n = 0; n < kPlaces; n += graph::kPiece) {
      graph::any_row(noise, &at_[0][n], &at_[1][n], &at_[2][n], graph::kPiece, &out_[n]);
    }
  }
  static constexpr std::size_t kPlaces = 64 * graph::kPiece;

 private:
  std::array<std::array<float, kPlaces>, 3> at_{};
  std::array<float, kPlaces> out_{};
};

NoiseBody noise_body(std::string name, graph::Op op, float askew, double published) {
  const auto rows = std::make_shared<NoiseRows>(askew);
  graph::Instruction noise{.op = op, .n_in = 3, .seed = 1337, .p = {1, 1}};
  noise.p[2] = static_cast<float>(CellReturn::f1);
  return {std::move(name), NoiseRows::kPlaces, published, {1, [=] { rows->run(noise); }}};
}

/// Six octaves of Perlin's noise on a lattice.
NoiseBody fractal_body() {
  constexpr Index3 kDims{256, 16, 4};
  const auto field = std::make_shared<const GraphField>(make_fractal_field());
  const auto samples = std::make_shared<Buffer<float>>(256 * 16 * 4);
  return {"fbm, six octaves", samples->size(), 0, {1, [=] {
                                                     field->sample(
                                                         {0.3, 0.2, 0.1}, {0.0173, 0.0173, 0.0173},
                                                         {0, 0, 0},
                                                         View3<float>(samples->data(), kDims));
                                                   }}};
}

/// Computes all samples that a run asks for.
class FieldReader final : public SlabReader {
 public:
  FieldReader(GraphField field, std::int32_t n) : field_(std::move(field)), spacing_(2.0 / n) {
    volume_.type = SampleType::f32;
    volume_.lattice.box = {{0, 0, 0}, {n - 1, n / 2 - 1, n - 1}};
    volume_.lattice.to_world = Affine::scale_translate({spacing_, spacing_, spacing_}, kOrigin);
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] bool rereads_cheaply() const override { return false; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    const Index3 dims = volume_.lattice.dims();
    out.allocate(planes_of(volume_.lattice.box, k0, k1), sizeof(float));
    field_.sample(kOrigin, {spacing_, spacing_, spacing_}, {0, 0, k0},
                  {reinterpret_cast<float*>(out.storage.data()), {dims[0], dims[1], k1 - k0}});
  }

 private:
  static constexpr Vec3 kOrigin{-1, -0.5, -1};
  GraphField field_;
  double spacing_;
  Volume volume_;
};

class NoSink final : public MeshSink {
 public:
  void begin_object(const MeshObject& /*object*/) override {}
  void place(const MeshChunk& /*chunk*/, std::size_t /*slot*/) override {}
  void end_object(const MeshTotals& /*totals*/) override {}
  void finish() override {}
};

/// A terrain to triangles, which are then dropped.
NoiseBody terrain_body(std::string name, GraphField field, std::int32_t n) {
  auto source = std::make_unique<FieldReader>(std::move(field), n);
  const auto side = static_cast<std::uint64_t>(n);
  const std::uint64_t n_samples = side * (side / 2) * side;
  const auto reader = std::make_shared<const VolumeReader>(std::move(source));
  return {std::move(name), n_samples, 0, {1, [=] {
                                            NoSink sink;
                                            run(*reader, {}, true, sink, silent_progress(), {});
                                          }}};
}

std::vector<NoiseBody> noise_bodies(std::int32_t n) {
  std::vector<NoiseBody> bodies;
  bodies.push_back(noise_body("perlin, along x", graph::Op::perlin3, 0, kPublishedPerlin));
  bodies.push_back(noise_body("perlin, askew", graph::Op::perlin3, 1, kPublishedPerlin));
  bodies.push_back(noise_body("simplex", graph::Op::simplex3, 1, kPublishedSimplex));
  bodies.push_back(noise_body("cellular F1", graph::Op::cellular3, 1, kPublishedCellular));
  bodies.push_back(fractal_body());
  bodies.push_back(terrain_body("hills to mesh", make_terrain_field(Dims::xz, 3), n));
  bodies.push_back(terrain_body("cliffs to mesh", make_terrain_field(Dims::xyz, 1.28), n));
  return bodies;
}

}  // namespace

std::vector<NoiseResult> measure_noises(std::int32_t n, const RoundLimits& limits) {
  const std::vector<NoiseBody> bodies = noise_bodies(n);
  std::vector<TimedBody> timed{{1, count_cycles}};
  for (const NoiseBody& b : bodies) timed.push_back(b.body);
  std::vector<NoiseResult> results;
  const std::string before = base::simd_target_name();
  for (const std::string& target : base::simd_targets()) {
    base::set_simd_target(target);
    const std::vector<Timing> timings = time_rounds(timed, limits);
    const double clock = static_cast<double>(kSteps) / timings[0].least;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      results.push_back(
          {bodies[b].name, target, bodies[b].n_points, timings[b + 1], clock, bodies[b].published});
    }
  }
  base::set_simd_target(before);
  return results;
}

}  // namespace mc::cli
