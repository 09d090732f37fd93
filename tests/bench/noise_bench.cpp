// SPDX-License-Identifier: MIT
#include <cstring>
#include <memory>
#include <vector>

#include "graph/rows.hpp"
#include "kernel_bench.hpp"
#include "support/cell_twins.hpp"

// The noises over rows of samples, each compared to the bit with its plain twin. Rows lie along x,
// as those of a lattice do; or askew, as a warp leaves them: every coordinate changes from sample
// to sample.

namespace mc::bench {

namespace {

namespace twin = mc::tests::twin;
using graph::Instruction;
using graph::kPiece;
using graph::Op;

constexpr std::size_t kRows = 16;
constexpr std::uint32_t kSeed = 1337;

struct Rows {
  std::vector<float> x, y, z, out;

  explicit Rows(float askew) : out(kRows * kPiece) {
    for (std::size_t n = 0; n < out.size(); ++n) {
      const auto i = static_cast<float>(n % kPiece);
      const auto j = static_cast<float>(n / kPiece);
      x.push_back(i * 0.173F - 3.1F);
      y.push_back(j * 0.31F + i * 0.021F * askew);
      z.push_back(j * 0.29F - i * 0.017F * askew - 5);
    }
  }
  void run(const Instruction& instruction) {
    for (std::size_t at = 0; at < out.size(); at += kPiece) {
      graph::any_row(instruction, &x[at], &y[at], &z[at], kPiece, &out[at]);
    }
  }
  template <class Twin>
  [[nodiscard]] bool right(const Twin& noise) const {
    for (std::size_t n = 0; n < out.size(); ++n) {
      const float wanted = noise(x[n], y[n], z[n]);
      if (std::memcmp(&wanted, &out[n], sizeof wanted) != 0) return false;
    }
    return true;
  }
};

template <class Twin>
void add_noise(const std::string& name, Op op, const Twin& noise) {
  const Instruction instruction{.op = op, .n_in = 3, .seed = kSeed, .p = {1, 1, 1}};
  for (const float askew : {0.0F, 1.0F}) {
    const auto rows = std::make_shared<Rows>(askew);
    add_kernel(
        name + (askew == 0 ? "/along_x" : "/askew"), "points", kRows * kPiece,
        [=] { rows->run(instruction); }, [=] { return rows->right(noise); });
  }
}

template <class Twin>
void add_flat(const std::string& name, Op op, const Twin& noise) {
  add_noise(name, op, [=](float x, float y, float) { return noise(x, y, kSeed); });
}
template <class Twin>
void add_deep(const std::string& name, Op op, const Twin& noise) {
  add_noise(name, op, [=](float x, float y, float z) { return noise(x, y, z, kSeed); });
}

}  // namespace

void add_noises() {
  Node nearest;  // cellular noise: the distance to the nearest point
  nearest.numbers[1] = 1;
  add_flat("perlin2", Op::perlin2, twin::perlin2);
  add_deep("perlin3", Op::perlin3, twin::perlin3);
  add_flat("simplex2", Op::simplex2,
           [](float x, float y, std::uint32_t seed) { return twin::simplex2(x, y, seed); });
  add_deep("simplex3", Op::simplex3, twin::simplex3);
  add_flat("open_simplex2", Op::open_simplex2, twin::open_simplex2);
  add_deep("open_simplex3", Op::open_simplex3, twin::open_simplex3);
  add_flat("unity2", Op::unity2,
           [](float x, float y, std::uint32_t) { return twin::unity2(x, y); });
  add_deep("white3", Op::white3, twin::white);
  add_flat("value2", Op::value2, twin::value2);
  add_deep("value3", Op::value3, twin::value3);
  add_flat("value_cubic2", Op::value_cubic2, twin::value_cubic2);
  add_deep("value_cubic3", Op::value_cubic3, twin::value_cubic3);
  add_flat("cellular2_f1", Op::cellular2, [=](float x, float y, std::uint32_t seed) {
    return twin::cellular(nearest, true, x, y, 0, seed);
  });
  add_deep("cellular3_f1", Op::cellular3, [=](float x, float y, float z, std::uint32_t seed) {
    return twin::cellular(nearest, false, x, y, z, seed);
  });
}

}  // namespace mc::bench
