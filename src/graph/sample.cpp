// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <utility>

#include "graph/program.hpp"
#include "graph/rows.hpp"
#include "mc/graph.hpp"

// Runs a program over a lattice: plane by plane, each in columns of kPiece samples, so that all
// registers stay in the cache and what does not depend on y is computed once for all rows.

namespace mc {

namespace graph {
namespace {

class Machine {
 public:
  explicit Machine(const Program& program)
      : program_(program), registers_(std::size_t{program.n_registers} * kPiece) {}

  /// World coordinates of the next samples: x of each, y and z of all.
  void place_x(double origin, double spacing, std::int64_t first, std::size_t n) {
    n_ = n;
    for (std::size_t i = 0; i < n; ++i) {
      x_[i] = static_cast<float>(origin + static_cast<double>(first + std::int64_t(i)) * spacing);
    }
  }
  void place_y(double y) { y_ = static_cast<float>(y); }
  void place_z(double z) { z_ = static_cast<float>(z); }

  void run(const std::vector<Instruction>& code) {
    for (const Instruction& instruction : code) {
      run(instruction);
    }
  }
  [[nodiscard]] const float* result() { return row(program_.result); }

 private:
  float* row(std::uint32_t n) { return registers_.data() + std::size_t{n} * kPiece; }
  void run(const Instruction& instruction);

  const Program& program_;
  Buffer<float> registers_;
  std::array<float, kPiece> x_{};
  float y_ = 0;
  float z_ = 0;
  std::size_t n_ = 0;
};

void Machine::run(const Instruction& instruction) {
  float* out = row(instruction.out);
  const float* a = row(instruction.in[0]);
  const float* b = row(instruction.in[1]);
  const float* c = row(instruction.in[2]);
  const float frequency = instruction.p[0];
  switch (instruction.op) {
    case Op::x:
      std::copy_n(x_.begin(), n_, out);
      return;
    case Op::y:
      std::fill_n(out, n_, y_);
      return;
    case Op::z:
      std::fill_n(out, n_, z_);
      return;
    case Op::perlin2:
      return perlin2_row(a, b, frequency, instruction.seed, n_, out);
    case Op::perlin3:
      return perlin3_row(a, b, c, frequency, instruction.seed, n_, out);
    case Op::simplex2:
      return simplex2_row(a, b, frequency, instruction.seed, n_, out);
    case Op::simplex3:
      return simplex3_row(a, b, c, frequency, instruction.seed, n_, out);
    case Op::unity2:
      return unity2_row(a, b, frequency, n_, out);
    case Op::sphere:
    case Op::box:
    case Op::plane:
    case Op::torus:
    case Op::cylinder:
    case Op::cone:
    case Op::capsule:
    case Op::ellipsoid:
    case Op::gyroid:
      return solid_row(instruction, a, b, c, n_, out);
    default:
      return arithmetic_row(instruction, a, b, c, n_, out);
  }
}

}  // namespace
}  // namespace graph

GraphField::GraphField(std::unique_ptr<const graph::Program> program)
    : program_(std::move(program)) {}
GraphField::~GraphField() = default;
GraphField::GraphField(GraphField&& other) noexcept = default;
GraphField& GraphField::operator=(GraphField&& other) noexcept = default;

void GraphField::sample(const Vec3& origin, const Vec3& spacing, const Index3& first,
                        View3<float> out) const {
  graph::Machine machine(*program_);
  const auto at = [&](std::size_t axis, std::int64_t index) {
    return origin[axis] + static_cast<double>(first[axis] + index) * spacing[axis];
  };
  for (std::int32_t k = 0; k < out.dims[2]; ++k) {
    machine.place_z(at(2, k));
    float* plane = out.data + k * out.plane_stride;
    for (std::int64_t i = 0; i < out.dims[0]; i += std::int64_t{graph::kPiece}) {
      const auto n = static_cast<std::size_t>(
          std::min<std::int64_t>(out.dims[0] - i, std::int64_t{graph::kPiece}));
      machine.place_x(origin[0], spacing[0], first[0] + i, n);
      machine.run(program_->once_a_plane);
      for (std::int32_t j = 0; j < out.dims[1]; ++j) {
        machine.place_y(at(1, j));
        machine.run(program_->once_a_row);
        std::copy_n(machine.result(), n, plane + j * out.row_stride + i);
      }
    }
  }
}

}  // namespace mc
