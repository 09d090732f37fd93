// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "edit/block_weights.hpp"
#include "edit/edited_samples.hpp"
#include "mc/edit.hpp"

namespace mc::edit {

/// For each reached sample of a block the mean (or median) of what lies around it; samples of the
/// border go on beyond it, NaN counts nowhere.
void find_means(const Edit& edit, const EditedSamples& before, const Index3& block,
                const Mask512& reached, std::span<double, kBlockSamples> out);

/// The length of the gradient in the world, by central differences; one-sided at the border.
void find_slopes(const Affine& to_world, const EditedSamples& before, const Index3& block,
                 const Mask512& reached, std::span<double, kBlockSamples> out);

/// Sums over the crossed lattice edges that start at reached samples, by their weights: what a
/// plane through the surface is made of.
struct SurfaceSums {
  double weight = 0;
  Vec3 point{};
  Vec3 gradient{};

  void add(const SurfaceSums& other);
  /// The plane through the mean point across the mean gradient.
  [[nodiscard]] std::optional<FlattenPlane> plane(bool above) const;
};
SurfaceSums sum_surface(const EditRules& rules, const EditedSamples& before, const Index3& block,
                        const BlockWeights& weights);

}  // namespace mc::edit
