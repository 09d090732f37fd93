// SPDX-License-Identifier: MIT
#include "convert/script_run.hpp"

#include <fmt/format.h>

#include <utility>

#include "convert/notes.hpp"
#include "convert/output_probe.hpp"
#include "convert/surface_choice.hpp"
#include "convert/watching_inputs.hpp"

// Script, input, outputs: everything that can refuse comes before the first edit. Then the records,
// see script_records.cpp; then the outputs.

namespace mc::conversion {

namespace {

/// Steps that a live script keeps, so that its memory does not grow without end.
constexpr std::size_t kLiveUndo = 256;

bool is_mesh(const ScriptOutput& output) {
  return output_format(output.path, output.options.sink).open_mesh != nullptr;
}

}  // namespace

ScriptRun::ScriptRun(std::span<const std::string> inputs, const std::string& script,
                     const ScriptOptions& options, ScriptObserver& observer, Progress& progress,
                     const std::stop_token& stop, ScriptReport& report)
    : inputs_(inputs),
      options_(options),
      observer_(observer),
      progress_(progress),
      stop_(stop),
      report_(report),
      script_(script, {.left = source::SpecNesting::most_samples(options.base.memory_bytes),
                       .root = options.base.source.root}) {}

void ScriptRun::check_script() {
  if (script_.is_live() || options_.keep_going) return;
  may_undo_ = false;
  script_.check([&](const source::ScriptRecord& record) {
    may_undo_ = may_undo_ || is_step(record.kind);
    if (record.kind == source::RecordKind::write) look_at_write(record);
  });
  if (options_.outputs.empty() && writes_.empty() && !options_.chunks && !options_.journal &&
      !options_.base.dry_run) {
    throw Error(ErrorKind::usage, "edit", "no output: expected -o FILE",
                "or a write record in the script, or --dry-run");
  }
}

void ScriptRun::look_at_write(const source::ScriptRecord& record) {
  const std::string path = source::path_of_write(record.path, writes_.size() + 1);
  try {
    writes_.push_back(output_of_write(path));
  } catch (const Error& error) {
    throw Error(error.kind(), script_.place(),
                fmt::format("record {}: {}", record.number, error.what()));
  }
  if (!written_.insert(path).second && !options_.base.sink.force) {
    throw Error(ErrorKind::usage, script_.place(),
                fmt::format("record {}: {} would be written a second time", record.number, path),
                "number it: step-{n:04}.glb; or replace it: --force");
  }
}

ScriptOutput ScriptRun::output_of_write(const std::string& path) const {
  if (options_.output_of_write) return options_.output_of_write(path);
  ScriptOutput output{path, options_.base};
  output.options.sink.to.clear();
  return output;
}

/// An output that cannot be written is found before the work.
void ScriptRun::probe(const ScriptOutput& output) const {
  if (!can_be_probed(output.path)) return;
  if (is_mesh(output)) {
    open_mesh_sink(output.path, output.options.sink);
  } else {
    open_volume_sink(output.path, output.options.sink);
  }
}

void ScriptRun::check_outputs() {
  for (const auto* outputs : {&options_.outputs, &std::as_const(writes_)}) {
    for (const ScriptOutput& output : *outputs) probe(output);
  }
}

void ScriptRun::open_input() {
  SourceOptions from = options_.base.source;
  from.memory_bytes = options_.base.memory_bytes;
  source_.emplace(open_source(inputs_, from, progress_));
  report_.input = source_->place;
  check_region(source_->reader, options_.base.extract.region);
  note_chosen_grid(*source_, from, progress_);
}

/// Decided once, of the input: edits do not change the isovalue.
void ScriptRun::choose_surface() {
  const Volume& volume = volume_of(source_->reader);
  const auto measure = [&](std::span<const double> percentiles) {
    return measure_field(source_->reader, percentiles, progress_, stop_,
                         options_.base.memory_bytes);
  };
  const SurfaceChoice& choice = options_.base.surface;
  surface_.inside = choose_inside(choice, volume);
  surface_.border = choose_border(choice, volume);
  surface_.isos = choose_isos(choice.isos, volume, source_->place, measure,
                              options_.base.source.further_formats);
  note_isos(surface_, volume.type, progress_);
  report_.iso = surface_.isos.front().value;
  report_.inside = surface_.inside;
  report_.index_space = script_.header().index_space;
  const EditRules rules{
      .above = surface_.inside == Inside::above,
      .iso = report_.iso,
      .to_world = report_.index_space ? Affine{} : volume.lattice.to_world,
  };
  store_.emplace(source_->reader, rules);
  if (options_.limits_store) store_->limit_memory(options_.base.memory_bytes);
}

void ScriptRun::begin() {
  if (script_.is_live() || options_.undo) {
    store_->keep_undo(options_.undo.value_or(kLiveUndo));
  } else if (!may_undo_) {
    store_->keep_undo(0);
  }
  const SinkOptions& sink = options_.base.sink;
  if (options_.journal) {
    journal_ = std::make_unique<Journal>(*options_.journal, script_.journal_header(), sink.force,
                                         sink.sync);
    hash_ = store_->hash();
  }
  if (!options_.chunks) return;
  chunks_ = std::make_unique<ChunkWriter>(*options_.chunks, options_.base, *source_, surface_,
                                          *store_, observer_);
  report_state("open", [&] { return chunks_->write_all(); });
}

/// Hands out chunks that no record asks for.
template <class Write>
void ScriptRun::report_state(const char* op, Write&& write) {
  const auto began = Clock::now();
  RecordReport report{.number = last_number_, .op = op, .is_state = true};
  report.chunks = write();
  report.seconds = std::chrono::duration<double>(Clock::now() - began).count();
  observer_.record(report);
}

void ScriptRun::write_output(const ScriptOutput& output) {
  const Source edited{source_->place, store_->reader(), {}};
  if (!is_mesh(output)) {
    write_volume(edited.reader, output.path, volume_options(output.options), progress_, stop_);
    return;
  }
  ConvertReport report;
  write_mesh(edited, surface_, output.path, output.options, progress_, stop_, report);
  observer_.output(output.path, report);
}

void ScriptRun::warn_of_clamped_values() const {
  if (!chunks_) return;
  const AttributeReaders attributes = store_->attributes();
  const std::vector<std::uint64_t>& n_clamped = chunks_->n_clamped();
  for (std::size_t n = 0; n < std::min(n_clamped.size(), attributes.size()); ++n) {
    if (n_clamped[n] == 0) continue;
    warn_of_clamped(source_->place, attributes[n]->info(),
                    fmt::format("{} vertices of chunks", n_clamped[n]), progress_);
  }
}

void ScriptRun::run() {
  check_script();
  open_input();
  check_outputs();
  choose_surface();
  if (options_.base.dry_run) return describe();
  begin();
  follow_script();
  if (options_.chunks && options_.chunks->at_writes) {
    report_state("end", [&] { return chunks_->write_changes(store_->take_dirty(), last_number_); });
  }
  warn_of_clamped_values();
  for (const ScriptOutput& output : options_.outputs) write_output(output);
}

void ScriptRun::report_store() {
  if (!store_) return;
  report_.n_stored_blocks = store_->n_stored_blocks();
  report_.stored_bytes = store_->stored_bytes();
}

}  // namespace mc::conversion

namespace mc {

void apply_script(std::span<const std::string> inputs, const std::string& script,
                  const ScriptOptions& options, ScriptObserver& observer, Progress& progress,
                  const std::stop_token& stop, ScriptReport& report) {
  report = {};
  report.input = inputs.front();
  conversion::watching_inputs([&] {
    conversion::ScriptRun run(inputs, script, options, observer, progress, stop, report);
    try {
      run.run();
    } catch (...) {
      run.report_store();
      throw;
    }
    run.report_store();
  });
}

}  // namespace mc
