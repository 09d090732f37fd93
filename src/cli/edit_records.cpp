// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <utility>

#include "cli/edit_session.hpp"

// The records of a script, one by one: done and told of, or only described.

namespace mc::cli {

namespace {

/// Samples that `more` touched, besides those of `sum`.
void include(EditEffect& sum, const EditEffect& more) {
  sum.touched = joined(sum.touched, more.touched);
  sum.n_samples += more.n_samples;
  sum.n_changed += more.n_changed;
  sum.n_dabs += more.n_dabs;
  sum.n_outside += more.n_outside;
}

std::string description_of(const RecordReport& report) {
  const EditEffect& e = report.effect;
  const std::string what = fmt::format("record {:<4} {:<8} {} dabs, {} samples", report.number,
                                       report.op, e.n_dabs, e.n_samples);
  if (is_empty(e.touched)) return what + ", outside the volume\n";
  return fmt::format("{} in {} chunks, {} to {}\n", what, *report.n_reached,
                     fmt::join(e.touched.lo, ","), fmt::join(e.touched.hi, ","));
}

}  // namespace

/// The next good record; bad ones are told of, and end the script unless it is to be kept going.
std::optional<source::ScriptRecord> EditSession::next_record() {
  for (;;) {
    try {
      return script_.next();
    } catch (const Error& error) {
      // A record may name a volume that is too large.
      if (error.kind() != ErrorKind::usage && error.kind() != ErrorKind::limit) throw;
      const int status = show(invocation_.console, {static_cast<int>(error.kind()), error.lines()});
      if (status_ == 0) status_ = status;
      if (plan_.keep_going) continue;
      invocation_.console.note(
          fmt::format("{}: stopped; what came before stands", script_.place()));
      return std::nullopt;
    }
  }
}

void EditSession::follow_script() {
  while (const auto record = next_record()) {
    if (invocation_.stop.stop_requested()) throw Cancelled();
    do_record(*record);
    last_number_ = record->number;
    ++totals_.n_records;
  }
  if (!script_.torn().empty()) {
    invocation_.console.warn(
        fmt::format("{}: the journal's last line is torn and was left out", script_.torn()));
  }
  if (totals_.n_outside > 1) {
    invocation_.console.note(fmt::format("{} edits lay outside the volume", totals_.n_outside));
  }
}

void EditSession::do_record(const source::ScriptRecord& record) {
  const auto began = Clock::now();
  RecordReport report{.number = record.number, .op = record.op};
  check_hash(record, record.before, "before");
  if (is_step(record.kind)) {
    step_back_or_forth(record, report);
  } else if (record.kind == source::RecordKind::write) {
    EditOutput output = resolve_write(args_, source::path_of_write(record.path, ++n_writes_));
    report.output = output.path;
    pin(output);
    write_output(std::move(output));
  } else {
    report.effect = apply(record);
    totals_.n_changed += report.effect.n_changed;
    note_in_journal(record, 1);
  }
  check_hash(record, record.after, "after");
  if (emitter_ && (!plan_.emits_at_writes || record.kind == source::RecordKind::write)) {
    report.chunks = emitter_->emit_changes(store_->take_dirty(), record.number);
  }
  if (!is_heard()) return;
  report.bounds = bounds_of(report.effect.touched);
  report.seconds = std::chrono::duration<double>(Clock::now() - began).count();
  tell(to_json(report));
}

EditEffect EditSession::apply(const source::ScriptRecord& record) {
  if (record.kind == source::RecordKind::edit) {
    const EditEffect effect = store_->apply(record.edit);
    ++totals_.n_edits;
    count_outside(record, effect);
    return effect;
  }
  EditEffect sum;
  store_->begin_group();
  for (const source::ScriptRecord& member : record.members) include(sum, apply(member));
  store_->end_group();
  return sum;
}

void EditSession::count_outside(const source::ScriptRecord& record, const EditEffect& effect) {
  if (effect.n_dabs == 0 || effect.n_outside < effect.n_dabs) return;
  if (totals_.n_outside++ != 0) return;
  invocation_.console.warn(fmt::format(
      "{}: {} lies outside the volume and changes nothing; more such edits are only counted",
      script_.place(),
      record.number != 0 ? fmt::format("record {}", record.number) : "an edit of a group"));
}

void EditSession::step_back_or_forth(const source::ScriptRecord& record, RecordReport& report) {
  const bool back = record.kind == source::RecordKind::undo;
  const std::size_t n = back ? store_->undo(record.count) : store_->redo(record.count);
  report.count = n;
  if (n < record.count) {
    invocation_.console.warn(fmt::format("{}: record {}: {} of {} steps {}: there were no more",
                                         script_.place(), record.number, n, record.count,
                                         back ? "undone" : "done again"));
  }
  if (n > 0) note_in_journal(record, n);
}

/// A journal is of use only on the volume that it was recorded on.
void EditSession::check_hash(const source::ScriptRecord& record,
                             const std::optional<std::uint64_t>& expected, const char* when) const {
  if (!expected || *expected == store_->hash()) return;
  throw Error(ErrorKind::input, script_.place(),
              fmt::format("record {}: the volume {} it differs from the one that was recorded",
                          record.number, when),
              R"(replay a journal on its own input, or leave out "before" and "after")");
}

void EditSession::note_in_journal(const source::ScriptRecord& record, std::size_t n_steps) {
  if (!journal_) return;
  const std::uint64_t before = std::exchange(hash_, store_->hash());
  const std::string text = is_step(record.kind)
                               ? fmt::format(R"({{"op":"{}","count":{}}})", record.op, n_steps)
                               : record.text;
  journal_->add(text, before, hash_);
}

/// The corners' box in the script's space.
Bounds EditSession::bounds_of(const IndexBox& touched) const {
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

EditEffect EditSession::measure(const source::ScriptRecord& record) {
  if (record.kind == source::RecordKind::edit) return store_->measure(record.edit);
  EditEffect sum;
  for (const source::ScriptRecord& member : record.members) include(sum, measure(member));
  return sum;
}

/// What each record would touch of the volume as it is.
void EditSession::describe() {
  const ChunkMesher chunks(*store_, chunk_options(plan_, *source_));
  while (const auto record = next_record()) {
    ++totals_.n_records;
    if (is_step(record->kind) || record->kind == source::RecordKind::write) {
      if (plan_.report != "-") {
        print_out(fmt::format("record {:<4} {}{}\n", record->number, record->op,
                              record->path.empty() ? "" : " " + record->path));
      }
      continue;
    }
    RecordReport report{.number = record->number, .op = record->op, .effect = measure(*record)};
    report.n_reached = chunks.n_reached(report.effect.touched);
    report.bounds = bounds_of(report.effect.touched);
    if (plan_.report) report_.add_line(to_json(report));
    if (plan_.report != "-") print_out(description_of(report));
  }
}

}  // namespace mc::cli
