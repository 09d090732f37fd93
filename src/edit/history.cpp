// SPDX-License-Identifier: MIT
#include "edit/history.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "edit/box_list.hpp"

// Undo by copy on write: blocks are never changed where they lie, so the one before is kept as it
// was.

namespace mc::edit {

void History::open() {
  if (depth_++ > 0) return;
  ++id_;
  open_step_.parts.resize(1);
}

void History::close() {
  assert(depth_ > 0);
  if (--depth_ > 0) return;
  Step step = std::exchange(open_step_, {});
  for (Step& undone : undone_) discard(undone);
  undone_.clear();
  if (most_ == 0) return discard(step);
  done_.push_back(std::move(step));
  keep(most_);
}

void History::begin_group() { open(); }
void History::end_group() { close(); }
void History::begin_edit() { open(); }

void History::end_edit(const IndexBox& changed) {
  add_box(changed, open_step_.boxes);
  close();
}

void History::put(Layer& layer, const Index3& at, BlockPtr block) {
  if (block) block->step = id_;
  BlockPtr old = layer.exchange(at, std::move(block));
  if (most_ == 0 || (old && old->step == id_)) return layer.pool().give_back(std::move(old));
  open_step_.parts.back().changes.push_back({&layer, at, std::move(old)});
}

void History::fill(const Scalar& value) {
  auto fill = std::make_unique<Fill>();
  fill->value = value;
  swap_fill(*fill);
  open_step_.parts.back().fill = std::move(fill);
  open_step_.parts.emplace_back();
}

void History::swap_fill(Fill& fill) {
  world_.samples.layer().exchange_all(fill.blocks);
  world_.samples.exchange_fill(fill.value);
}

void History::swap(Part& part) {
  for (Change& change : part.changes) {
    change.block = change.layer->exchange(change.at, std::move(change.block));
  }
}

std::size_t History::undo(std::size_t count, std::vector<IndexBox>& dirty) {
  assert(depth_ == 0);
  std::size_t n = 0;
  for (; n < count && !done_.empty(); ++n) {
    Step step = std::move(done_.back());
    done_.pop_back();
    for (auto part = step.parts.rbegin(); part != step.parts.rend(); ++part) {
      if (part->fill) swap_fill(*part->fill);
      swap(*part);
    }
    for (const IndexBox& box : step.boxes) add_box(box, dirty);
    undone_.push_back(std::move(step));
  }
  return n;
}

std::size_t History::redo(std::size_t count, std::vector<IndexBox>& dirty) {
  assert(depth_ == 0);
  std::size_t n = 0;
  for (; n < count && !undone_.empty(); ++n) {
    Step step = std::move(undone_.back());
    undone_.pop_back();
    for (Part& part : step.parts) {
      swap(part);
      if (part.fill) swap_fill(*part.fill);
    }
    for (const IndexBox& box : step.boxes) add_box(box, dirty);
    done_.push_back(std::move(step));
  }
  return n;
}

void History::discard(Step& step) {
  for (Part& part : step.parts) {
    for (Change& change : part.changes) change.layer->pool().give_back(std::move(change.block));
    if (!part.fill) continue;
    for (auto& [at, block] : part.fill->blocks) {
      world_.samples.layer().pool().give_back(std::move(block));
    }
  }
  step = {};
}

void History::keep(std::size_t n_steps) {
  most_ = n_steps;
  while (done_.size() > most_) {
    discard(done_.front());
    done_.pop_front();
  }
  while (undone_.size() > most_) {
    discard(undone_.front());
    undone_.pop_front();
  }
}

}  // namespace mc::edit
