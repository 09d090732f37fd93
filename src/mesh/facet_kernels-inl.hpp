// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see facet_kernels.hpp for what the function does.

#if defined(MC_MESH_FACET_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_MESH_FACET_KERNELS_INL
#undef MC_MESH_FACET_KERNELS_INL
#else
#define MC_MESH_FACET_KERNELS_INL
#endif

#include <hwy/highway.h>

#include "mesh/facet_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::mesh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The operations of base/vectors.hpp in their order, so that every target gives the same bits.
inline void compute_normals(FacetBlock& block) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> single;
  static_assert(kFacetBlock % hn::MaxLanes(d) == 0);
  for (std::size_t n = 0; n < kFacetBlock; n += hn::Lanes(d)) {
    const auto load = [&](std::size_t row) {
      return hn::PromoteTo(d, hn::Load(single, &block.corner[row][n]));
    };
    const auto x = load(0), y = load(1), z = load(2);
    const auto ax = hn::Sub(load(3), x), ay = hn::Sub(load(4), y), az = hn::Sub(load(5), z);
    const auto bx = hn::Sub(load(6), x), by = hn::Sub(load(7), y), bz = hn::Sub(load(8), z);
    const auto nx = hn::Sub(hn::Mul(ay, bz), hn::Mul(az, by));
    const auto ny = hn::Sub(hn::Mul(az, bx), hn::Mul(ax, bz));
    const auto nz = hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
    const auto area = hn::Sqrt(hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz)));
    const auto has_area = hn::And(hn::Gt(area, hn::Zero(d)), hn::IsFinite(area));
    const auto store = [&](std::size_t axis, auto component) {
      const auto unit = hn::IfThenElseZero(has_area, hn::Div(component, area));
      const auto rounded = hn::Add(hn::DemoteTo(single, unit), hn::Zero(single));
      hn::Store(rounded, single, &block.normal[axis][n]);
    };
    store(0, nx);
    store(1, ny);
    store(2, nz);
  }
}

}  // namespace mc::mesh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
