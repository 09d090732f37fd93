// SPDX-License-Identifier: MIT
#include "edit/edited_samples.hpp"

#include <cassert>

// Boxes of samples from the blocks that edits made and from what lies under them.

namespace mc::edit {

void EditedSamples::read_base(const Index3& block, std::byte* out) const {
  if (filled_) return fill_samples(out, kBlockSamples, *filled_, input_.sample_bytes());
  input_.read_block(block, out);
}

Mask512 EditedSamples::base_active(const Index3& block) const {
  return filled_ && input_.leaves() != nullptr ? Mask512{} : input_.read_active(block);
}

Scalar EditedSamples::background() const {
  assert(input_.leaves() != nullptr);
  return filled_ ? *filled_ : input_.leaves()->background();
}

void EditedSamples::read_base_box(const IndexBox& box, std::span<std::byte> out) const {
  if (!filled_) return input_.read_box(box, out);
  fill_samples(out.data(), out.size() / input_.sample_bytes(), *filled_, input_.sample_bytes());
}

void EditedSamples::read_box(const IndexBox& box, std::span<std::byte> out) const {
  const std::size_t size = input_.sample_bytes();
  const IndexBox blocks = blocks_of(box);
  std::uint64_t n_stored = 0;
  for_blocks_of(box, [&](const Index3& block) { n_stored += layer_.find(block) != nullptr; });
  const auto n_blocks =
      static_cast<std::uint64_t>(blocks.extent(0) * blocks.extent(1) * blocks.extent(2));
  if (n_stored < n_blocks) read_base_box(box, out);
  if (n_stored == 0) return;
  for_blocks_of(box, [&](const Index3& at) {
    const Block* block = layer_.find(at);
    if (block != nullptr) copy_from_block(at, block->samples(), size, box, out.data());
  });
}

}  // namespace mc::edit
