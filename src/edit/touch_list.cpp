// SPDX-License-Identifier: MIT
#include "edit/touch_list.hpp"

#include <algorithm>

#include "mc/base.hpp"

// Which blocks a brush reaches: the box of each position is halved until a part misses it or is one
// block, so that a long thin brush costs its own blocks and not its box.

namespace mc::edit {

namespace {

struct Touch {
  Index3 block;
  std::uint32_t position;
};

/// Parts of so many blocks are not looked at more closely.
constexpr std::int64_t kSmall = 32;

class Descent {
 public:
  Descent(const Stroke& stroke, std::uint64_t most, std::vector<Touch>& out)
      : stroke_(stroke), most_(most), out_(out) {}

  void add(std::uint32_t position) {
    position_ = position;
    n_before_ = out_.size();
    const IndexBox& box = stroke_.positions[position].box;
    if (is_empty(box)) return;
    const IndexBox blocks = blocks_of(box);
    split(blocks, n_blocks(blocks) > kSmall);
  }

 private:
  static std::int64_t n_blocks(const IndexBox& b) {
    // A volume has below 2^28 blocks along an axis; where the product would not fit it is large.
    const auto n = static_cast<double>(b.extent(0)) * static_cast<double>(b.extent(1)) *
                   static_cast<double>(b.extent(2));
    return n > 0x1p62 ? std::int64_t{1} << 62U : static_cast<std::int64_t>(n);
  }

  void split(const IndexBox& blocks, bool look) {
    const Position& at = stroke_.positions[position_];
    if (look) {
      const IndexBox samples{samples_of(blocks.lo).lo, samples_of(blocks.hi).hi};
      if (misses(stroke_.brush, at, common_part(samples, at.box))) return;
    }
    if (n_blocks(blocks) == 1 || !look) return list(blocks);
    int longest = 0;
    for (int a = 1; a < 3; ++a) {
      if (blocks.extent(a) > blocks.extent(longest)) longest = a;
    }
    const auto a = static_cast<std::size_t>(longest);
    const auto middle = static_cast<std::int32_t>(blocks.lo[a] + (blocks.extent(longest) - 1) / 2);
    IndexBox lower = blocks;
    IndexBox upper = blocks;
    lower.hi[a] = middle;
    upper.lo[a] = middle + 1;
    split(lower, look);
    split(upper, look);
  }

  void list(const IndexBox& blocks) {
    for (std::int32_t k = blocks.lo[2]; k <= blocks.hi[2]; ++k) {
      for (std::int32_t j = blocks.lo[1]; j <= blocks.hi[1]; ++j) {
        for (std::int32_t i = blocks.lo[0]; i <= blocks.hi[0]; ++i) {
          out_.push_back({{i, j, k}, position_});
        }
      }
    }
    if (out_.size() - n_before_ > most_) {
      throw Error(ErrorKind::limit, "edit",
                  "the brush reaches more blocks of 8x8x8 samples than memory holds",
                  "make it smaller, or the volume coarser");
    }
  }

  const Stroke& stroke_;
  std::uint64_t most_;
  std::vector<Touch>& out_;
  std::uint32_t position_ = 0;
  std::size_t n_before_ = 0;
};

}  // namespace

TouchList::TouchList(const Stroke& stroke, std::uint32_t first, std::uint32_t last,
                     std::uint64_t most_blocks) {
  std::vector<Touch> touches;
  Descent descent(stroke, most_blocks, touches);
  const auto& all = stroke.positions;
  const auto from = std::partition_point(all.begin(), all.end(),
                                         [&](const Position& p) { return p.group < first; });
  for (auto at = from; at != all.end() && at->group < last; ++at) {
    descent.add(static_cast<std::uint32_t>(at - all.begin()));
  }
  std::sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) {
    return a.block == b.block ? a.position < b.position : comes_before(a.block, b.block);
  });
  positions_.reserve(touches.size());
  for (const Touch& touch : touches) {
    if (blocks_.empty() || blocks_.back() != touch.block) {
      blocks_.push_back(touch.block);
      starts_.push_back(positions_.size());
    }
    positions_.push_back(touch.position);
  }
  starts_.push_back(positions_.size());
}

}  // namespace mc::edit
