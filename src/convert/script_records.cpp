// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <utility>

#include "convert/script_run.hpp"

// The records of a script, one by one: done and reported, or only described.

namespace mc::conversion {

namespace {

/// Samples that `more` touched, besides those of `sum`.
void include(EditEffect& sum, const EditEffect& more) {
  sum.touched = joined(sum.touched, more.touched);
  sum.n_samples += more.n_samples;
  sum.n_changed += more.n_changed;
  sum.n_dabs += more.n_dabs;
  sum.n_outside += more.n_outside;
}

}  // namespace

/// Returns the next valid record; reports invalid ones, and stops at the first unless keep_going.
std::optional<source::ScriptRecord> ScriptRun::next_record() {
  for (;;) {
    try {
      return script_.next();
    } catch (const Error& error) {
      // A record may name a volume that is too large.
      if (error.kind() != ErrorKind::usage && error.kind() != ErrorKind::limit) throw;
      observer_.fault(error);
      if (!report_.fault) report_.fault = error.kind();
      if (options_.keep_going) continue;
      progress_.note(fmt::format("{}: stopped; what came before stands", script_.place()));
      return std::nullopt;
    }
  }
}

void ScriptRun::follow_script() {
  while (const auto record = next_record()) {
    if (stop_.stop_requested()) throw Cancelled();
    do_record(*record);
    last_number_ = record->number;
    ++report_.n_records;
  }
  if (!script_.torn().empty()) {
    progress_.warn(
        fmt::format("{}: the journal's last line is torn and was left out", script_.torn()));
  }
  if (report_.n_outside > 1) {
    progress_.note(fmt::format("{} edits lay outside the volume", report_.n_outside));
  }
}

void ScriptRun::do_record(const source::ScriptRecord& record) {
  const auto began = Clock::now();
  RecordReport report{.number = record.number, .op = record.op};
  check_hash(record, record.before, "before");
  if (is_step(record.kind)) {
    step_back_or_forth(record, report);
  } else if (record.kind == source::RecordKind::write) {
    const ScriptOutput output = output_of_write(source::path_of_write(record.path, ++n_writes_));
    report.output = output.path;
    write_output(output);
  } else {
    report.effect = apply(record);
    report_.n_changed += report.effect.n_changed;
    note_in_journal(record, 1);
  }
  check_hash(record, record.after, "after");
  if (chunks_ && (!options_.chunks->at_writes || record.kind == source::RecordKind::write)) {
    report.chunks = chunks_->write_changes(store_->take_dirty(), record.number);
  }
  report.bounds = bounds_of(report.effect.touched);
  report.seconds = std::chrono::duration<double>(Clock::now() - began).count();
  observer_.record(report);
}

EditEffect ScriptRun::apply(const source::ScriptRecord& record) {
  if (record.kind == source::RecordKind::edit) {
    const EditEffect effect = store_->apply(record.edit);
    ++report_.n_edits;
    count_outside(record, effect);
    return effect;
  }
  EditEffect sum;
  store_->begin_group();
  for (const source::ScriptRecord& member : record.members) include(sum, apply(member));
  store_->end_group();
  return sum;
}

void ScriptRun::count_outside(const source::ScriptRecord& record, const EditEffect& effect) {
  if (effect.n_dabs == 0 || effect.n_outside < effect.n_dabs) return;
  if (report_.n_outside++ != 0) return;
  progress_.warn(fmt::format(
      "{}: {} lies outside the volume and changes nothing; more such edits are only counted",
      script_.place(),
      record.number != 0 ? fmt::format("record {}", record.number) : "an edit of a group"));
}

void ScriptRun::step_back_or_forth(const source::ScriptRecord& record, RecordReport& report) {
  const bool back = record.kind == source::RecordKind::undo;
  const std::size_t n = back ? store_->undo(record.count) : store_->redo(record.count);
  report.count = n;
  if (n < record.count) {
    progress_.warn(fmt::format("{}: record {}: {} of {} steps {}: there were no more",
                               script_.place(), record.number, n, record.count,
                               back ? "undone" : "done again"));
  }
  if (n > 0) note_in_journal(record, n);
}

/// A journal is of use only on the volume that it was recorded on.
void ScriptRun::check_hash(const source::ScriptRecord& record,
                           const std::optional<std::uint64_t>& expected, const char* when) const {
  if (!expected || *expected == store_->hash()) return;
  throw Error(ErrorKind::input, script_.place(),
              fmt::format("record {}: the volume {} it differs from the one that was recorded",
                          record.number, when),
              R"(replay a journal on its own input, or leave out "before" and "after")");
}

void ScriptRun::note_in_journal(const source::ScriptRecord& record, std::size_t n_steps) {
  if (!journal_) return;
  const std::uint64_t before = std::exchange(hash_, store_->hash());
  const std::string text = is_step(record.kind)
                               ? fmt::format(R"({{"op":"{}","count":{}}})", record.op, n_steps)
                               : record.text;
  journal_->add(text, before, hash_);
}

/// The corners' box in the script's space.
Bounds ScriptRun::bounds_of(const IndexBox& touched) const {
  Bounds bounds;
  if (is_empty(touched)) return bounds;
  for (int corner = 0; corner < 8; ++corner) {
    const auto at = [&](std::size_t a) {
      return static_cast<double>(((corner >> a) & 1) != 0 ? touched.hi[a] : touched.lo[a]);
    };
    bounds.include(store_->rules().to_world({at(0), at(1), at(2)}));
  }
  return bounds;
}

EditEffect ScriptRun::measure(const source::ScriptRecord& record) {
  if (record.kind == source::RecordKind::edit) return store_->measure(record.edit);
  EditEffect sum;
  for (const source::ScriptRecord& member : record.members) include(sum, measure(member));
  return sum;
}

/// What each record would touch of the volume as it is.
void ScriptRun::describe() {
  const std::int32_t n_cells = options_.chunks.value_or(ChunkOutput{}).n_cells;
  const ChunkMesher chunks(*store_, chunk_options(options_.base, n_cells, *source_, surface_));
  while (const auto record = next_record()) {
    ++report_.n_records;
    RecordReport report{.number = record->number, .op = record->op};
    if (record->kind == source::RecordKind::write) {
      report.output = record->path;
    } else if (is_step(record->kind)) {
      report.count = record->count;
    } else {
      report.effect = measure(*record);
      report.n_reached = chunks.n_reached(report.effect.touched);
      report.bounds = bounds_of(report.effect.touched);
    }
    observer_.record(report);
  }
}

}  // namespace mc::conversion
