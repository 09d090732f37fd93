// SPDX-License-Identifier: MIT
#include <cstring>
#include <memory>
#include <vector>

#include "graph/rows.hpp"
#include "kernel_bench.hpp"
#include "support/noise_twins.hpp"

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
      graph::gradient_row(instruction, &x[at], &y[at], &z[at], kPiece, &out[at]);
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
  const Instruction instruction{.op = op, .n_in = 3, .seed = kSeed, .p = {1}};
  for (const float askew : {0.0F, 1.0F}) {
    const auto rows = std::make_shared<Rows>(askew);
    add_kernel(
        name + (askew == 0 ? "/along_x" : "/askew"), "points", kRows * kPiece,
        [=] { rows->run(instruction); }, [=] { return rows->right(noise); });
  }
}

}  // namespace

void add_noises() {
  add_noise("perlin2", Op::perlin2,
            [](float x, float y, float) { return twin::perlin2(x, y, kSeed); });
  add_noise("perlin3", Op::perlin3,
            [](float x, float y, float z) { return twin::perlin3(x, y, z, kSeed); });
  add_noise("simplex2", Op::simplex2,
            [](float x, float y, float) { return twin::simplex2(x, y, kSeed); });
  add_noise("simplex3", Op::simplex3,
            [](float x, float y, float z) { return twin::simplex3(x, y, z, kSeed); });
  add_noise("unity2", Op::unity2, [](float x, float y, float) { return twin::unity2(x, y); });
}

}  // namespace mc::bench
