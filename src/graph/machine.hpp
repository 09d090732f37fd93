// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "graph/program.hpp"
#include "mc/base.hpp"

namespace mc::graph {

/// A world coordinate of a lattice index: computed in double, rounded to float.
[[nodiscard]] inline float world_at(double origin, double spacing, std::int64_t index) {
  return static_cast<float>(origin + static_cast<double>(index) * spacing);
}

/// Runs a program at up to kPiece places at once: any places, since every instruction looks at its
/// own only. Where they share one y, flat instructions are run once for all y, and what else
/// changes along y only is computed once a run.
class Machine {
 public:
  explicit Machine(const Program& program)
      : program_(program), registers_(std::size_t{program.n_registers} * kPiece) {}

  /// The places' coordinates, for the caller to fill; y instead of set_y().
  [[nodiscard]] float* x() { return x_.data(); }
  [[nodiscard]] float* z() { return z_.data(); }
  [[nodiscard]] float* y() {
    shares_y_ = false;
    return y_.data();
  }
  void set_count(std::size_t n) { n_ = n; }
  /// All places have this y.
  void set_y(float y) {
    shares_y_ = true;
    y_[0] = y;
  }

  void run(std::span<const Instruction> code);
  [[nodiscard]] const float* row(Value value) const {
    return registers_.data() + std::size_t{program_.homes[value]} * kPiece;
  }

 private:
  void run(const Instruction& instruction, std::size_t n, float* out) const;

  const Program& program_;
  Buffer<float> registers_;
  std::array<float, kPiece> x_{};
  std::array<float, kPiece> z_{};
  std::array<float, kPiece> y_{};  // the first only, where they share it
  bool shares_y_ = true;
  std::size_t n_ = 0;
};

}  // namespace mc::graph
