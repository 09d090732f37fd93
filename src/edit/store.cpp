// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "base/machine_memory.hpp"
#include "edit/box_list.hpp"
#include "edit/brush_pass.hpp"
#include "edit/edited_materials.hpp"
#include "edit/edited_reader.hpp"
#include "edit/history.hpp"
#include "mc/edit.hpp"

// The store: one edit is laid out as a stroke and applied in one pass over the blocks that it
// reaches, or, where it looks around, in one pass for each position and repetition.

namespace mc {

namespace {

using edit::BrushPass;
using edit::Stroke;

}  // namespace

struct EditStore::State {
  State(const VolumeReader& input, const EditRules& its_rules)
      : world(input), rules(its_rules), history(world) {}

  /// Samples that there are; a sparse volume has room for a ring around them in 32 bits.
  [[nodiscard]] IndexBox room() const {
    constexpr std::int32_t kReach = (1 << 30) - 16;
    return world.samples.input().leaves() == nullptr
               ? world.samples.input().volume().lattice.box
               : IndexBox{{-kReach, -kReach, -kReach}, {kReach - 1, kReach - 1, kReach - 1}};
  }
  /// The same, bounded: all leaves, tiles and stored blocks.
  [[nodiscard]] IndexBox extent() const {
    IndexBox out = world.samples.input().extent();
    if (world.samples.input().leaves() == nullptr) return out;
    for (const auto& [at, block] : world.samples.layer().blocks()) {
      out = joined(out, edit::samples_of(at));
    }
    return out;
  }
  [[nodiscard]] std::uint64_t stored_bytes() const {
    return world.samples.layer().pool().live_bytes() + world.materials.pool().live_bytes();
  }
  [[nodiscard]] std::uint64_t blocks_left(const edit::Layer& layer) const {
    const std::uint64_t used = std::min(stored_bytes(), memory_bytes);
    return (memory_bytes - used) / layer.pool().block_bytes();
  }
  [[nodiscard]] Stroke stroke_of(const Edit& edit) const {
    const bool endless = edit.shape.type == ShapeType::plane;
    return edit::lay_out(edit, rules, room(), endless ? extent() : IndexBox{});
  }

  EditEffect fill(const Edit& edit);
  EditEffect run(const Edit& edit, const Stroke& stroke);
  void run_passes(const Edit& edit, const Stroke& stroke, BrushPass& pass);

  edit::World world;
  edit::EditedMaterials materials{world};
  EditRules rules;
  edit::History history;
  std::vector<IndexBox> dirty;
  std::uint64_t memory_bytes = base::machine_bytes();
  mutable std::optional<Volume> volume;  // unset: to be found again
};

EditEffect EditStore::State::fill(const Edit& edit) {
  EditEffect out;
  out.touched = extent();
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::uint64_t>(std::max<std::int64_t>(out.touched.extent(a), 0));
    out.n_samples = a == 0 ? n : out.n_samples * n;
  }
  out.n_changed = out.n_samples;
  history.begin_edit();
  history.fill(edit::sample_of(edit.value, world.samples.type()));
  history.end_edit(out.touched);
  return out;
}

EditEffect EditStore::State::run(const Edit& edit, const Stroke& stroke) {
  BrushPass pass(edit, rules, stroke, world);
  const edit::Layer& layer = edit.op == EditOp::paint ? world.materials : world.samples.layer();
  pass.plan(0, stroke.n_groups, blocks_left(layer));
  history.begin_edit();
  try {
    run_passes(edit, stroke, pass);
  } catch (...) {  // what was done is one step, which can be undone
    history.end_edit(pass.effect().touched);
    edit::add_box(pass.effect().touched, dirty);
    throw;
  }
  history.end_edit(pass.effect().touched);
  return pass.effect();
}

void EditStore::State::run_passes(const Edit& edit, const Stroke& stroke, BrushPass& pass) {
  if (!edit::looks_around(edit.op)) return pass.run(edit.steps, history);
  const std::uint32_t n_times = edit.steps * (edit.op == EditOp::smooth ? edit.iterations : 1);
  for (std::uint32_t group = 0; group < stroke.n_groups; ++group) {
    pass.plan(group, group + 1, blocks_left(world.samples.layer()));
    if (!pass.find_plane()) continue;
    for (std::uint32_t n = 0; n < n_times; ++n) pass.run(1, history);
  }
}

EditStore::EditStore(const VolumeReader& input, const EditRules& rules)
    : state_(std::make_unique<State>(input, rules)) {}
EditStore::~EditStore() = default;
EditStore::EditStore(EditStore&& other) noexcept = default;
EditStore& EditStore::operator=(EditStore&& other) noexcept = default;

const EditRules& EditStore::rules() const { return state_->rules; }

const Volume& EditStore::volume() const {
  if (!state_->volume) state_->volume = edit::describe(state_->world.samples);
  return *state_->volume;
}

EditEffect EditStore::measure(const Edit& edit) const {
  if (edit.op == EditOp::fill) {
    EditEffect out;
    out.touched = state_->extent();
    out.n_samples = static_cast<std::uint64_t>(out.touched.extent(0) * out.touched.extent(1)) *
                    static_cast<std::uint64_t>(out.touched.extent(2));
    return out;
  }
  const Stroke stroke = state_->stroke_of(edit);
  BrushPass pass(edit, state_->rules, stroke, state_->world);
  pass.plan(0, stroke.n_groups, std::numeric_limits<std::uint64_t>::max());
  pass.measure();
  return pass.effect();
}

EditEffect EditStore::apply(const Edit& edit) {
  state_->volume.reset();
  EditEffect out;
  if (edit.op == EditOp::fill) {
    out = state_->fill(edit);
  } else {
    const Stroke stroke = state_->stroke_of(edit);
    out = state_->run(edit, stroke);
  }
  edit::add_box(out.touched, state_->dirty);
  return out;
}

void EditStore::begin_group() { state_->history.begin_group(); }
void EditStore::end_group() { state_->history.end_group(); }

std::size_t EditStore::undo(std::size_t count) {
  state_->volume.reset();
  return state_->history.undo(count, state_->dirty);
}
std::size_t EditStore::redo(std::size_t count) {
  state_->volume.reset();
  return state_->history.redo(count, state_->dirty);
}
void EditStore::keep_undo(std::size_t n_steps) { state_->history.keep(n_steps); }
void EditStore::limit_memory(std::uint64_t bytes) { state_->memory_bytes = bytes; }

std::vector<IndexBox> EditStore::take_dirty() { return std::exchange(state_->dirty, {}); }

void EditStore::read_box(const IndexBox& box, std::span<std::byte> out) const {
  state_->world.samples.read_box(box, out);
}

std::uint64_t EditStore::n_stored_blocks() const {
  return state_->world.samples.layer().blocks().size() + state_->world.materials.blocks().size();
}
std::uint64_t EditStore::stored_bytes() const { return state_->stored_bytes(); }

std::uint64_t EditStore::hash() const {
  edit::World& world = state_->world;
  std::uint64_t h = world.samples.layer().hash() * 3 + world.materials.hash() * 5;
  if (world.samples.filled()) {
    h += (world.samples.filled()->as<std::uint64_t>() | 1U) * 0x9E3779B97F4A7C15U;
  }
  return h;
}

AttributeReaders EditStore::attributes() const { return state_->materials.attributes(); }

VolumeReader EditStore::reader() const { return edit::make_reader(state_->world, volume()); }

}  // namespace mc
