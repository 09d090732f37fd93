// SPDX-License-Identifier: MIT
#include "cli/extract_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "cli/chosen_grid.hpp"
#include "cli/facts.hpp"
#include "cli/output_probe.hpp"
#include "cli/placement.hpp"
#include "cli/region.hpp"
#include "cli/surface_choice.hpp"
#include "cli/values.hpp"
#include "mc/pipe.hpp"

// Open, place, choose, check the budget, then run the engine once an iso. Whatever can refuse comes
// before what takes long.

namespace mc::cli {

namespace {

std::uint64_t sample_bytes(const VolumeReader& reader) {
  const Volume& volume = volume_of(reader);
  const std::uint64_t each = sample_size(volume.type);
  if (const auto* sparse = std::get_if<std::unique_ptr<LeafReader>>(&reader)) {
    return (*sparse)->leaves().size() * LeafReader::kLeafSamples * each;
  }
  std::uint64_t n = each;
  for (int a = 0; a < 3; ++a) n *= static_cast<std::uint64_t>(volume.lattice.box.extent(a));
  return n;
}

/// Whether to count before making: where counting costs nothing, or one cheap read may be worth it.
CountFirst counting_of(const VolumeReader& reader) {
  if (!is_dense(reader)) return CountFirst::yes;
  const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader);
  return dense != nullptr && (*dense)->rereads_cheaply() ? CountFirst::if_large : CountFirst::no;
}

/// What one job knows by and by.
class Extraction {
 public:
  Extraction(const ExtractPlan& plan, std::string output, Invocation& invocation, RunReport& report)
      : plan_(plan), output_(std::move(output)), invocation_(invocation), report_(report) {
    report_.output = output_;
  }

  void open(const std::vector<std::string>& inputs);
  void take(const Source& source);
  void run();

 private:
  void place_mesh();
  void choose_surface();
  void keep_what_is_read_again();
  void describe() const;
  void write();
  template <class Work>
  void timed(const char* stage, Work&& work);
  [[nodiscard]] const VolumeReader& reader() const { return source_->reader; }
  [[nodiscard]] const Volume& volume() const { return volume_of(source_->reader); }
  [[nodiscard]] IndexBox box() const { return plan_.extract.region.value_or(volume().lattice.box); }
  [[nodiscard]] const MaterialReader* materials() const;
  [[nodiscard]] RunOptions run_options(const Iso& iso) const;
  [[nodiscard]] SinkOptions sink_options() const;
  [[nodiscard]] FieldStatistics measure(std::span<const double> percentiles);
  void probe_output() const;
  MeshTotals run_one(const Iso& iso, MeshSink& sink);
  void note_border(const MeshTotals& totals) const;
  void warn_of_materials(const MeshTotals& totals) const;

  const ExtractPlan& plan_;
  std::string output_;
  Invocation& invocation_;
  RunReport& report_;
  std::optional<Source> opened_;
  const Source* source_ = nullptr;
  Placement placement_;
  MeshNeeds needs_;
  std::vector<Iso> isos_;
  Inside inside_ = Inside::above;
  Border border_ = Border::open;
};

template <class Work>
void Extraction::timed(const char* stage, Work&& work) {
  const auto began = std::chrono::steady_clock::now();
  report_.stages.push_back({stage, 0, std::nullopt});
  const std::size_t at = report_.stages.size() - 1;
  work();
  invocation_.console.end_stage();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
  report_.stages[at].seconds = seconds.count();
  if (source_ != nullptr) report_.stages[at].n_bytes = sample_bytes(reader());
  invocation_.console.detail(fmt::format("{}: {:.3f} s", stage, seconds.count()));
}

void Extraction::take(const Source& source) {
  source_ = &source;
  report_.input = source.place;
  report_.volume = volume();
}

void Extraction::open(const std::vector<std::string>& inputs) {
  report_.input = inputs.front();
  SourceOptions options = plan_.source;
  options.streams = true;
  options.memory_bytes = plan_.memory_bytes;
  timed("open", [&] { take(opened_.emplace(open_source(inputs, options, invocation_.console))); });
  note_chosen_grid(*source_, plan_.source, invocation_.console);
}

void Extraction::place_mesh() {
  check_region(reader(), plan_.extract.region);
  if (materials_of(reader()) != nullptr && !find_sink_format(plan_.format)->holds_materials) {
    invocation_.console.note(
        fmt::format("{} holds no materials, so they are left out; write ply, "
                    "glb or gltf",
                    plan_.format));
  }
  placement_ = place(volume(), plan_.place, plan_.format);
  report_.placement = placement_;
  const RoundingLoss loss = rounding_loss(box(), placement_.to_world, Precision::f32);
  needs_ = find_sink_format(plan_.format)->needs(plan_.sink, loss.matters);
  check_told_apart(source_->place, box(), placement_.to_world, needs_,
                   plan_.source.spacing || plan_.source.origin);
  if (!loss.matters || needs_.relative_origin) return;
  if (needs_.precision == Precision::f64) {
    invocation_.console.note(fmt::format(
        "coordinates are doubles: float would move vertices by up to {:.3g}", loss.largest_move));
  } else {
    invocation_.console.warn(fmt::format(
        "{}: float coordinates move vertices by up to {:.3g}, more than 1/8192 of a cell; "
        "ply or glb keep them in place",
        plan_.format, loss.largest_move));
  }
}

FieldStatistics Extraction::measure(std::span<const double> percentiles) {
  FieldStatistics statistics;
  timed("statistics", [&] {
    statistics = measure_field(reader(), percentiles, invocation_.console,
                               invocation_.stop.get_token(), plan_.memory_bytes);
  });
  return statistics;
}

/// One pass is enough for one iso that is known, over all planes; else a stream is copied first.
void Extraction::keep_what_is_read_again() {
  if (!opened_ || !is_stream(opened_->reader)) return;
  const bool again = plan_.isos.size() > 1 || plan_.extract.region;
  if (iso_needs_data(plan_.isos, volume()) || (again && !plan_.dry_run)) {
    timed("spool", [&] { spool_stream(opened_->reader, invocation_.console); });
  }
}

void Extraction::choose_surface() {
  check_memory(reader(), run_options({}));
  inside_ = choose_inside(plan_.inside, plan_.invert, volume());
  border_ = choose_border(plan_.border, volume());
  report_.inside = inside_;
  if (iso_needs_data(plan_.isos, volume()) && !plan_.dry_run) probe_output();
  keep_what_is_read_again();
  isos_ = choose_isos(plan_.isos, volume(), source_->place,
                      [&](std::span<const double> percentiles) { return measure(percentiles); });
  for (const Iso& iso : isos_) {
    report_.isos.push_back(iso.value);
    if (!plan_.tells_iso) continue;
    const std::string value = iso_text(iso.value, volume().type);
    invocation_.console.note(iso.reason.empty() ? fmt::format("iso {}", value)
                                                : fmt::format("iso {} ({})", value, iso.reason));
  }
}

/// An output that cannot be written is found before the data are read for the iso.
void Extraction::probe_output() const {
  if (can_be_probed(output_)) open_mesh_sink(output_, plan_.sink);
}

/// The volume's, where the output can hold them.
const MaterialReader* Extraction::materials() const {
  return find_sink_format(plan_.format)->holds_materials ? materials_of(reader()) : nullptr;
}

RunOptions Extraction::run_options(const Iso& iso) const {
  RunOptions options;
  options.extract = plan_.extract;
  options.extract.iso = iso.value;
  options.extract.inside = inside_;
  options.extract.border = border_;
  options.extract.precision = needs_.precision;
  if (needs_.relative_origin) options.extract.origin = double_origin(box(), placement_.to_world);
  options.object.iso = iso.value;
  options.object.name = isos_.size() == 1 && !volume().name.empty()
                            ? volume().name
                            : fmt::format("iso {}", iso_text(iso.value, volume().type));
  options.object.has_normals = plan_.extract.normals != Normals::none;
  options.object.precision = needs_.precision;
  options.object.origin = options.extract.origin;
  options.materials = materials();
  options.memory_bytes = plan_.memory_bytes;
  options.count_first = counting_of(reader());
  options.skip = plan_.skip;
  options.formatted = needs_.formatted;
  options.to_world = placement_.to_world;
  return options;
}

SinkOptions Extraction::sink_options() const {
  SinkOptions options = plan_.sink;
  options.progress = &invocation_.console;
  options.provenance = facts_of(volume(), isos_, inside_, border_, placement_, plan_.format);
  return options;
}

MeshTotals Extraction::run_one(const Iso& iso, MeshSink& sink) {
  RunOptions options = run_options(iso);
  if (plan_.common.verbose) {
    options.tell_need = [this](const MemoryNeed& need) {
      invocation_.console.detail(fmt::format("memory: {}", memory_text(need)));
    };
  }
  try {
    return mc::run(reader(), options, plan_.allow_empty, sink, invocation_.console,
                   invocation_.stop.get_token());
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::empty) throw;
  }
  // The engine has not looked at the values; who asked for this iso wants to know them.
  const auto* stream = std::get_if<std::unique_ptr<PlaneStream>>(&reader());
  const FieldStatistics statistics = stream != nullptr ? (*stream)->statistics() : measure({});
  const std::string value = iso_text(iso.value, volume().type);
  if (statistics.n_nan + statistics.n_infinite == statistics.n_samples) {
    throw Error(ErrorKind::empty, source_->place,
                fmt::format("no surface at iso {}: none of the {} samples is a finite number",
                            value, statistics.n_samples));
  }
  throw Error(
      ErrorKind::empty, source_->place,
      fmt::format("no surface at iso {}: the data lie in [{}, {}]", value,
                  iso_text(statistics.min, volume().type), iso_text(statistics.max, volume().type)),
      statistics.min == statistics.max ? "all samples are the same"
                                       : "choose an --iso between them");
}

void Extraction::note_border(const MeshTotals& totals) const {
  if (border_ != Border::open || plan_.border || totals.n_boundary_edges == 0) return;
  invocation_.console.note(fmt::format(
      "the mesh is open at the volume's border: {} boundary edges; --border closed caps it",
      totals.n_boundary_edges));
}

void Extraction::warn_of_materials(const MeshTotals& totals) const {
  if (totals.n_materials_held == 0) return;
  invocation_.console.warn(fmt::format(
      "{}: {} of {} vertices have a material that is no number from 0 to 65535: the nearest is "
      "taken, 0 for NaN",
      source_->place, totals.n_materials_held, totals.n_vertices));
}

void Extraction::write() {
  timed("extract", [&] {
    const std::unique_ptr<MeshSink> sink = open_mesh_sink(output_, sink_options());
    for (const Iso& iso : isos_) report_.totals.push_back(run_one(iso, *sink));
    refuse_changed_inputs();
    sink->finish();
  });
  for (const MeshTotals& totals : report_.totals) {
    note_border(totals);
    warn_of_materials(totals);
    invocation_.console.detail(fmt::format("{}: {} vertices, {} triangles", output_,
                                           totals.n_vertices, totals.n_triangles));
    if (totals.n_skipped != 0) {
      invocation_.console.detail(fmt::format(
          "skipped {} of {} samples, far from the surface ({:.1f} %)", totals.n_skipped,
          totals.n_asked,
          100 * static_cast<double>(totals.n_skipped) / static_cast<double>(totals.n_asked)));
    }
  }
}

void Extraction::describe() const {
  const Volume& v = volume();
  const IndexBox taken = box();
  std::string text = fmt::format("input    {}\n", source_->place);
  text += fmt::format("format   {}{}{}\n", v.format, v.name.empty() ? "" : ", grid ", v.name);
  text += fmt::format("samples  {} x {} x {} {}, {}\n", taken.extent(0), taken.extent(1),
                      taken.extent(2), sample_name(v.type), size_text(sample_bytes(reader())));
  for (const Iso& iso : isos_) {
    text += fmt::format("iso      {}{}\n", iso_text(iso.value, v.type),
                        iso.reason.empty() ? "" : fmt::format(" ({})", iso.reason));
  }
  text += fmt::format("inside   {}\n", name_of(inside_));
  text += fmt::format("border   {}\n", name_of(border_));
  text += fmt::format("frame    {}, units {}\n", name_of(placement_.source_frame),
                      name_of(placement_.units));
  text += fmt::format("memory   {}\n",
                      memory_text(memory_needed(reader(), run_options(isos_.front()))));
  text += fmt::format("output   {} ({})\n", output_, plan_.format);
  print_out(text);
}

void Extraction::run() {
  place_mesh();
  choose_surface();
  if (!plan_.dry_run) {
    write();
  } else if (plan_.report != "-") {
    describe();
  }
}

}  // namespace

void run_job(const ExtractPlan& plan, const Job& job, Invocation& invocation, RunReport& report) {
  Extraction extraction(plan, job.output, invocation, report);
  extraction.open(job.inputs);
  extraction.run();
}

void run_open_job(const ExtractPlan& plan, const std::string& output, const Source& source,
                  Invocation& invocation, RunReport& report) {
  Extraction extraction(plan, output, invocation, report);
  extraction.take(source);
  extraction.run();
}

}  // namespace mc::cli
