// SPDX-License-Identifier: MIT
#include "cli/edit_session.hpp"

#include <fmt/format.h>

#include <utility>

#include "cli/chosen_grid.hpp"
#include "cli/extract_job.hpp"
#include "cli/output_probe.hpp"
#include "cli/region.hpp"
#include "cli/surface_choice.hpp"
#include "cli/values.hpp"
#include "cli/volume_job.hpp"
#include "mc/sink.hpp"

// Script, input, outputs: whatever can refuse comes before the first edit. Then the records, see
// edit_records.cpp; then the outputs.

namespace mc::cli {

namespace {

/// Steps that a live session keeps: its memory must not grow for ever.
constexpr std::size_t kLiveUndo = 256;

const ExtractPlan* mesh_plan(const EditOutput& output) {
  return std::get_if<ExtractPlan>(&output.plan);
}

}  // namespace

EditSession::EditSession(const EditArgs& args, EditPlan plan, Invocation& invocation)
    : args_(args),
      plan_(std::move(plan)),
      invocation_(invocation),
      report_(plan_.report, invocation.stop.get_token()),
      script_(plan_.script, {.left = source::SpecNesting::most_samples(plan_.surface.memory_bytes),
                             .root = plan_.surface.source.root}) {
  if (is_heard() || plan_.surface.common.verbose) peak_.emplace();
}

void EditSession::check_script() {
  if (script_.is_live() || plan_.keep_going) return;
  may_undo_ = false;
  script_.check([&](const source::ScriptRecord& record) {
    may_undo_ = may_undo_ || is_step(record.kind);
    if (record.kind == source::RecordKind::write) look_at_write(record);
  });
  if (plan_.outputs.empty() && writes_.empty() && !plan_.emits && !plan_.journal &&
      !plan_.dry_run) {
    throw Error(ErrorKind::usage, "edit", "no output: expected -o FILE",
                "or a write record in the script, or --dry-run");
  }
}

void EditSession::look_at_write(const source::ScriptRecord& record) {
  const std::string path = source::path_of_write(record.path, writes_.size() + 1);
  try {
    writes_.push_back(resolve_write(args_, path));
  } catch (const Error& error) {
    throw Error(error.kind(), script_.place(),
                fmt::format("record {}: {}", record.number, error.what()));
  }
  if (!written_.insert(path).second && !args_.mesh.force) {
    throw Error(ErrorKind::usage, script_.place(),
                fmt::format("record {}: {} would be written a second time", record.number, path),
                "number it: step-{n:04}.glb; or replace it: --force");
  }
}

/// An output that cannot be written is found before the work.
void EditSession::probe(const EditOutput& output) const {
  if (!can_be_probed(output.path)) return;
  if (const ExtractPlan* mesh = mesh_plan(output)) {
    open_mesh_sink(output.path, mesh->sink);
  } else {
    open_volume_sink(output.path, std::get<SamplePlan>(output.plan).sink);
  }
}

void EditSession::check_outputs() {
  for (const auto* outputs : {&plan_.outputs, &writes_}) {
    for (const EditOutput& output : *outputs) probe(output);
  }
}

void EditSession::open_input() {
  const std::vector<std::string>& inputs = args_.mesh.source.inputs;
  totals_.input = inputs.front();
  SourceOptions options = plan_.surface.source;
  options.memory_bytes = plan_.surface.memory_bytes;
  source_.emplace(open_source(inputs, options, invocation_.console));
  totals_.input = source_->place;
  check_region(source_->reader, plan_.surface.extract.region);
  note_chosen_grid(*source_, plan_.surface.source, invocation_.console);
}

/// Once, of the input: edits do not move the surface's value.
void EditSession::choose_surface() {
  const Volume& volume = volume_of(source_->reader);
  const auto measure = [&](std::span<const double> percentiles) {
    return measure_field(source_->reader, percentiles, invocation_.console,
                         invocation_.stop.get_token(), plan_.surface.memory_bytes);
  };
  ExtractPlan& surface = plan_.surface;
  const std::vector<Iso> isos = choose_isos(surface.isos, volume, source_->place, measure);
  surface.inside = choose_inside(surface.inside, surface.invert, volume);
  surface.invert = false;
  surface.isos.clear();
  for (const Iso& iso : isos) {
    surface.isos.push_back({IsoChoice::Kind::number, iso.value});
    const std::string value = iso_text(iso.value, volume.type);
    invocation_.console.note(iso.reason.empty() ? fmt::format("iso {}", value)
                                                : fmt::format("iso {} ({})", value, iso.reason));
  }
  totals_.iso = isos.front().value;
  totals_.inside = *surface.inside;
  totals_.index_space = script_.header().index_space;
  for (EditOutput& output : plan_.outputs) pin(output);
  const EditRules rules{
      .above = *surface.inside == Inside::above,
      .iso = totals_.iso,
      .to_world = totals_.index_space ? Affine{} : volume.lattice.to_world,
  };
  store_.emplace(source_->reader, rules);
  if (args_.mesh.memory) store_->limit_memory(surface.memory_bytes);
}

/// A mesh is cut where the edits took the surface to be.
void EditSession::pin(EditOutput& output) const {
  auto* mesh = std::get_if<ExtractPlan>(&output.plan);
  if (mesh == nullptr) return;
  mesh->isos = plan_.surface.isos;
  mesh->inside = plan_.surface.inside;
  mesh->invert = false;
  mesh->tells_iso = false;
}

void EditSession::begin() {
  if (script_.is_live() || plan_.undo) {
    store_->keep_undo(plan_.undo.value_or(kLiveUndo));
  } else if (!may_undo_) {
    store_->keep_undo(0);
  }
  if (plan_.journal) {
    journal_ = std::make_unique<Journal>(*plan_.journal, script_.journal_header(), args_.mesh.force,
                                         args_.mesh.sync);
    hash_ = store_->hash();
  }
  if (plan_.emits) begin_to_emit();
}

void EditSession::begin_to_emit() {
  emitter_ = std::make_unique<ChunkEmitter>(plan_, *source_, *store_);
  tell_state("open", [&] { return emitter_->emit_all(); });
}

/// What changed since the last write.
void EditSession::end_to_emit() {
  tell_state("end", [&] { return emitter_->emit_changes(store_->take_dirty(), last_number_); });
}

/// Hands chunks out that no record asks for.
template <class Emit>
void EditSession::tell_state(const char* op, Emit&& emit) {
  const auto began = Clock::now();
  RecordReport report{.number = last_number_, .op = op, .is_state = true};
  report.chunks = emit();
  report.seconds = std::chrono::duration<double>(Clock::now() - began).count();
  tell(to_json(report));
}

void EditSession::write_output(EditOutput output) {
  const Source edited{source_->place, store_->reader(), {}};
  if (const ExtractPlan* mesh = mesh_plan(output)) {
    RunReport report;
    run_open_job(*mesh, output.path, edited, invocation_, report);
    if (peak_) report.peak_bytes = peak_->bytes();
    if (is_heard()) tell(to_json(report));
    return;
  }
  auto& volume = std::get<SamplePlan>(output.plan);
  volume.sink.provenance.emplace_back("generator", "mc " MC_VERSION);
  check_region(edited.reader, volume.region);
  write_volume(edited.reader, volume, invocation_);
}

bool EditSession::is_heard() const { return plan_.report || plan_.emits; }

void EditSession::tell(const std::string& line) {
  if (plan_.report) report_.add_line(line);
  if (plan_.lines_on_stdout() && plan_.report != "-") print_out(line + "\n");
}

void EditSession::note_materials() const {
  if (!emitter_ || emitter_->n_materials_held() == 0) return;
  invocation_.console.warn(fmt::format(
      "{}: {} vertices of chunks have a material that is no number from 0 to 65535: the nearest is "
      "taken, 0 for NaN",
      source_->place, emitter_->n_materials_held()));
}

int EditSession::run() {
  check_script();
  open_input();
  check_outputs();
  choose_surface();
  if (plan_.dry_run) {
    describe();
    return status_;
  }
  begin();
  follow_script();
  if (plan_.emits_at_writes) end_to_emit();
  note_materials();
  for (EditOutput& output : plan_.outputs) write_output(std::move(output));
  return status_;
}

void EditSession::close_report(int status, const std::optional<std::string>& error) {
  totals_.status = status;
  totals_.error = error;
  if (store_) {
    totals_.n_stored_blocks = store_->n_stored_blocks();
    totals_.stored_bytes = store_->stored_bytes();
  }
  totals_.warnings = invocation_.console.take_warnings();
  if (peak_) {
    totals_.peak_bytes = peak_->bytes();
    invocation_.console.detail(
        fmt::format("memory: {} at its peak", size_text(totals_.peak_bytes)));
  }
  if (is_heard()) tell(to_json(totals_));
  report_.finish();
}

}  // namespace mc::cli
