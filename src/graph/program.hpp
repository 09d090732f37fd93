// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mc/graph.hpp"

// A compiled graph: straight-line instructions, each of which makes one value from values before
// it, over rows of floats. Coordinates are values too, so fractals and warps need nothing special
// here: the compiler emits their sources again over other coordinates.

namespace mc::graph {

/// The operations, each with its row in ops.def.
enum class Op : std::uint8_t {
#define MC_OP(name, ...) name,
#include "graph/ops.def"
};

/// The numbers of an instruction, p0 to p5.
using Numbers = std::array<float, 6>;

/// A value is named by its place in Program::code.
using Value = std::uint32_t;

/// Samples, and how a node reads them. Its pointer is what an instruction holds.
struct DataUse {
  std::shared_ptr<const Raster> raster;         ///< of a heightmap
  std::shared_ptr<const SampledVolume> volume;  ///< of a volume
  Wrap wrap = Wrap::clamp;
  Filter filter = Filter::linear;
  std::optional<float> outside;  ///< what samples beyond a volume are; unset: its nearest one
  float least = 0;               ///< of all of these; NaN where one is not finite
  float greatest = 0;
};

struct Instruction {
  Op op = Op::fill;
  Value out = 0;
  std::array<Value, 3> in{};
  std::uint8_t n_in = 0;
  std::uint32_t seed = 0;
  Numbers p{};
  const DataUse* data = nullptr;  ///< one of Program::data
};

/// Samples are computed in pieces of this many, so that registers stay in the cache.
inline constexpr std::size_t kPiece = 256;

struct Program {
  std::vector<Instruction> code;     ///< value n is made by code[n]
  std::size_t n_flat = 0;            ///< the first so many do not change along y
  std::vector<bool> uniform;         ///< of each value: whether it changes along y only
  std::vector<std::uint32_t> homes;  ///< of each value: the register that holds it
  std::uint32_t n_registers = 0;
  Value result = 0;
  std::vector<std::shared_ptr<const DataUse>> data;  ///< what instructions point to

  /// What is run once a column of samples, and what for each of them.
  [[nodiscard]] std::span<const Instruction> flat() const { return std::span(code).first(n_flat); }
  [[nodiscard]] std::span<const Instruction> deep() const {
    return std::span(code).subspan(n_flat);
  }
};

}  // namespace mc::graph
