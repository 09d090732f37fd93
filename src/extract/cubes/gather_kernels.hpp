// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/cubes/vertex_kernels.hpp"
#include "mc/field.hpp"

// The samples around many edges at once, by the processor's gathers. Compiled for every SIMD target
// and chosen at run time.

namespace mc::extraction {

/// The planes around edges that start in plane k: of whole rows that follow each other. Where there
/// is no plane on one side, the one at hand stands for it, and the scale is 1.
struct PlaneSamples {
  SampleType type = SampleType::f32;
  bool swap = false;
  const std::byte* before = nullptr;      ///< plane k - 1; for gradients only
  const std::byte* here = nullptr;        ///< plane k
  const std::byte* after = nullptr;       ///< plane k + 1; for gradients and k-edges only
  const std::byte* after_next = nullptr;  ///< plane k + 2; for gradients of k-edges only
  float lower_scale = 0.5F;               ///< of differences across planes at the lower end
  float upper_scale = 0.5F;
  std::size_t row_bytes = 0;
  std::array<std::int32_t, 2> first{};     ///< i and j of the sample that planes start with
  std::array<std::int32_t, 2> lo{}, hi{};  ///< of the first and the last that may be looked at
};

/// Where gather_edges() puts what it finds.
struct EdgeSamples {
  float *a = nullptr, *b = nullptr;                      ///< samples at the lower and upper end
  std::array<float*, 3> lower_gradient, upper_gradient;  ///< per step of the lattice
  std::uint32_t* failed = nullptr;                       ///< room for a number each
};

struct Gathered {
  std::size_t n = 0;         ///< edges looked at, from the first on
  std::size_t n_failed = 0;  ///< of these
};

/// Gathers the samples at the ends of i- and j-edges, or of k-edges if `between`, and central
/// differences there, one-sided at the planes' border, if `gradients`. Lists those edges of which
/// an end lies outside the planes. Looks at all edges, or at none: where the target has no gathers,
/// the sample type is none of u8, i8, u16, i16 and f32, or planes are too small for neighbours or
/// too large for 32-bit offsets. Reads and writes up to the next multiple of kEdgesAtOnce.
Gathered gather_edges(const PlaneSamples& planes, const EdgePlaces& edges, bool between,
                      bool gradients, const EdgeSamples& out);

}  // namespace mc::extraction
