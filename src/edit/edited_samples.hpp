// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "edit/base_samples.hpp"
#include "edit/layer.hpp"

namespace mc::edit {

/// A volume as edits have left it: the blocks that they made over the input, or over the value that
/// a fill put everywhere.
class EditedSamples {
 public:
  explicit EditedSamples(const VolumeReader& input)
      : input_(input), layer_(input_.sample_bytes()) {}

  [[nodiscard]] const InputSamples& input() const { return input_; }
  [[nodiscard]] Layer& layer() { return layer_; }
  [[nodiscard]] const Layer& layer() const { return layer_; }
  [[nodiscard]] SampleType type() const { return input_.volume().type; }
  /// Set after a fill: nothing of the input is left.
  [[nodiscard]] const std::optional<Scalar>& filled() const { return filled_; }
  void exchange_fill(std::optional<Scalar>& other) { std::swap(filled_, other); }

  /// Samples and active bits under a block, whether or not the block is stored.
  void read_base(const Index3& block, std::byte* out) const;
  [[nodiscard]] Mask512 base_active(const Index3& block) const;
  /// A box within the volume, x fastest.
  void read_box(const IndexBox& box, std::span<std::byte> out) const;
  /// Sparse: the value of what is neither leaf nor tile.
  [[nodiscard]] Scalar background() const;

 private:
  void read_base_box(const IndexBox& box, std::span<std::byte> out) const;

  InputSamples input_;
  Layer layer_;
  std::optional<Scalar> filled_;
};

}  // namespace mc::edit
