// SPDX-License-Identifier: MIT
#include "convert/mesh_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "convert/mesh_formats.hpp"
#include "convert/notes.hpp"
#include "convert/output_frame.hpp"
#include "convert/output_probe.hpp"
#include "convert/provenance.hpp"
#include "convert/surface_choice.hpp"
#include "field/volume_attribute.hpp"
#include "mc/host.hpp"
#include "process/cube_stage_list.hpp"

namespace mc::conversion {

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

/// Whether positions far from the origin lose nothing that matters.
bool keeps_far_positions(const SinkFormat& format) {
  const MeshNeeds needs = format.needs({}, true);
  return needs.precision == Precision::f64 || needs.relative_origin;
}

/// Whether to count before making: where counting costs nothing, or one cheap read may be worth it.
/// Where stages change counts, counting makes the mesh, which costs more than spooling it.
CountFirst counting_of(const VolumeReader& reader, bool stages_change_counts) {
  if (stages_change_counts) return CountFirst::no;
  if (!is_dense(reader)) return CountFirst::yes;
  const auto* slabs = std::get_if<std::unique_ptr<SlabReader>>(&reader);
  return slabs != nullptr && (*slabs)->rereads_cheaply() ? CountFirst::if_large : CountFirst::no;
}

}  // namespace

MeshRun::MeshRun(const std::string& output, const ConvertOptions& options, Progress& progress,
                 const std::stop_token& stop, ConvertReport& report)
    : output_(output),
      options_(options),
      stages_(options.stages),
      cube_stages_(options.cube_stages.begin(), options.cube_stages.end()),
      format_(output_format(output, options.sink)),
      progress_(progress),
      stop_(stop),
      report_(report) {
  report_.format = format_.name;
  if (options.simplify) cube_stages_.push_back(&simplify_.emplace(*options.simplify));
}

template <class Work>
void MeshRun::timed(const char* stage, Work&& work) {
  const auto began = std::chrono::steady_clock::now();
  report_.stages.push_back({stage, 0, std::nullopt});
  const std::size_t at = report_.stages.size() - 1;
  work();
  progress_.end_stage();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
  report_.stages[at].seconds = seconds.count();
  if (source_ != nullptr) report_.stages[at].n_bytes = sample_bytes(reader());
  progress_.detail(fmt::format("{}: {:.3f} s", stage, seconds.count()));
}

void MeshRun::use(const Source& source) {
  source_ = &source;
  report_.input = source.place;
  report_.volume = volume();
}

void MeshRun::open(std::span<const std::string> inputs) {
  SourceOptions options = options_.source;
  options.streams = true;
  options.memory_bytes = options_.memory_bytes;
  timed("open", [&] { use(opened_.emplace(open_source(inputs, options, progress_))); });
  note_chosen_grid(*source_, options, progress_);
}

Normals MeshRun::normals() const {
  return options_.normals.value_or(format_.has_normals ? Normals::gradient : Normals::none);
}

/// Those of the volume and of the options.
std::vector<const AttributeReader*> MeshRun::all_attributes() {
  const AttributeReaders own = attributes_of(reader());
  std::vector<const AttributeReader*> all(own.begin(), own.end());
  std::vector<AttributeInfo> infos;
  for (const VolumeAttribute& attribute : options_.attributes) {
    sampled_bytes_ += field::volume_attribute_bytes(*attribute.volume);
    sampled_.push_back(volume_attribute(attribute, volume().lattice.to_world));
    all.push_back(sampled_.back().get());
  }
  for (const AttributeReader* attribute : all) infos.push_back(attribute->info());
  check_attributes(infos);
  return all;
}

/// Takes all attributes, and notes those that the output cannot hold.
void MeshRun::choose_attributes() {
  std::vector<AttributeInfo> left_out;
  for (const AttributeReader* attribute : all_attributes()) {
    if (holds(format_, attribute->info())) {
      attributes_.push_back(attribute);
    } else {
      left_out.push_back(attribute->info());
    }
  }
  if (!left_out.empty()) note_left_out(format_, left_out, progress_);
}

void MeshRun::place_mesh() {
  check_region(reader(), options_.extract.region);
  choose_attributes();
  report_.frame = output_frame(volume(), options_.frame, format_);
  const Affine& to_world = report_.frame->to_world;
  const RoundingLoss loss = rounding_loss(box(), to_world, Precision::f32);
  needs_ = format_.needs(options_.sink, loss.matters);
  check_told_apart(source_->place, box(), to_world, needs_,
                   options_.source.spacing || options_.source.origin);
  if (!loss.matters || needs_.relative_origin) return;
  if (needs_.precision == Precision::f64) {
    progress_.note(fmt::format("coordinates are doubles: float would move vertices by up to {:.3g}",
                               loss.largest_move));
  } else {
    progress_.warn(fmt::format(
        "{}: float coordinates move vertices by up to {:.3g}, more than 1/8192 of a cell; "
        "{} keep them in place",
        report_.format, loss.largest_move, mesh_formats(keeps_far_positions)));
  }
}

FieldStatistics MeshRun::measure(std::span<const double> percentiles) {
  FieldStatistics statistics;
  timed("statistics", [&] {
    statistics = measure_field(reader(), percentiles, progress_, stop_, options_.memory_bytes);
  });
  return statistics;
}

/// One pass is enough for one iso that is known, over all planes, with stages that need no halo;
/// else a stream is copied first.
void MeshRun::spool_if_read_again() {
  if (!opened_ || !is_stream(opened_->reader)) return;
  const std::vector<IsoChoice>& isos = options_.surface.isos;
  const bool again = isos.size() > 1 || options_.extract.region || options_.keep ||
                     stages_.need_windows() || !cube_stages_.empty();
  if (iso_needs_data(isos, volume()) || (again && !options_.dry_run)) {
    timed("spool", [&] { spool_stream(opened_->reader, progress_); });
  }
}

/// An output that cannot be written is found before the data are read for the iso.
void MeshRun::probe_output() const {
  if (can_be_probed(output_)) open_mesh_sink(output_, options_.sink);
}

void MeshRun::choose_surface() {
  const SurfaceChoice& choice = options_.surface;
  surface_.inside = choose_inside(choice, volume());
  surface_.border = choose_border(choice, volume());
  report_.surface = surface_;
  if (iso_needs_data(choice.isos, volume()) && !options_.dry_run) probe_output();
  spool_if_read_again();
  surface_.isos = choose_isos(
      choice.isos, volume(), source_->place,
      [&](std::span<const double> percentiles) { return measure(percentiles); },
      options_.source.further_formats);
  note_isos(surface_, volume().type, progress_);
}

RunOptions MeshRun::run_options(double iso) const {
  RunOptions options;
  options.extract = options_.extract;
  options.extract.iso = iso;
  options.extract.inside = surface_.inside;
  options.extract.border = surface_.border;
  options.extract.normals = normals();
  options.extract.precision = needs_.precision;
  const Affine& to_world = report_.frame->to_world;
  if (needs_.relative_origin) options.extract.origin = double_origin(box(), to_world);
  options.object.name = surface_.isos.size() == 1 && !volume().name.empty()
                            ? volume().name
                            : fmt::format("iso {}", value_text(iso, volume().type));
  options.attributes = attributes_;
  options.memory_bytes = memory_beside(sampled_bytes_, options_.memory_bytes);
  options.keep = options_.keep;
  options.count_first = counting_of(reader(), stages_.change_counts() || !cube_stages_.empty());
  options.stages = options_.stages;
  options.cube_stages = cube_stages_;
  options.skip = options_.skip;
  options.formatted = needs_.formatted;
  for (const AttributeReader* attribute : attributes_) {
    options.formatted.vertex_bytes +=
        static_cast<std::uint32_t>(format_.attribute_bytes(attribute->info(), options_.sink));
  }
  options.to_world = to_world;
  return options;
}

SinkOptions MeshRun::sink_options() const {
  SinkOptions options = options_.sink;
  options.to = report_.format;
  options.progress = &progress_;
  options.provenance = provenance_of(volume(), surface_, *report_.frame, format_);
  return options;
}

/// The engine has not looked at the values; whoever asked for this iso needs their range.
void MeshRun::refuse_empty(double iso) {
  const auto* stream = std::get_if<std::unique_ptr<PlaneStream>>(&reader());
  const FieldStatistics statistics = stream != nullptr ? (*stream)->statistics() : measure({});
  const SampleType type = volume().type;
  const std::string value = value_text(iso, type);
  if (statistics.n_nan + statistics.n_infinite == statistics.n_samples) {
    throw Error(ErrorKind::empty, source_->place,
                fmt::format("no surface at iso {}: none of the {} samples is a finite number",
                            value, statistics.n_samples));
  }
  const std::string fault =
      fmt::format("no surface at iso {}: the data lie in [{}, {}]", value,
                  value_text(statistics.min, type), value_text(statistics.max, type));
  if (statistics.min == statistics.max) {
    throw Error(ErrorKind::empty, source_->place, fault, "all samples are the same");
  }
  throw Error(ErrorKind::empty, source_->place, fault, Remedy::choose_iso);
}

MeshTotals MeshRun::run_one(double iso, MeshSink& sink) {
  RunOptions options = run_options(iso);
  options.tell_need = options_.on_memory_need;
  try {
    return mc::run(reader(), options, options_.allow_empty, sink, progress_, stop_);
  } catch (const Error& e) {
    const bool has_surface = stages_.change_counts() || e.remedy() == Remedy::keep_smaller;
    if (e.kind() != ErrorKind::empty || has_surface) throw;
  }
  refuse_empty(iso);
}

/// Says how far the mesh was simplified, and when its shape forbade to reach the goal.
void MeshRun::report_simplified(const MeshTotals& totals) const {
  constexpr double kMissed = 1.02;  // of the goal; cubes round theirs
  const double cell = std::cbrt(std::abs(report_.frame->to_world.determinant()));
  const auto n_extracted = static_cast<double>(totals.n_extracted);
  const auto n = static_cast<double>(totals.n_triangles);
  progress_.note(
      fmt::format("simplified {} to {} triangles ({:.1f} %); vertices moved away {:.3g} cells rms, "
                  "{:.3g} at most",
                  totals.n_extracted, totals.n_triangles, 100 * n / n_extracted,
                  totals.distances->rms / cell, totals.distances->max / cell));
  const SimplifyGoal& goal = *options_.simplify;
  const double wanted = goal.by == SimplifyGoal::By::ratio ? goal.ratio * n_extracted
                        : goal.by == SimplifyGoal::By::count
                            ? std::min(n_extracted, static_cast<double>(goal.count))
                            : n;
  if (n > kMissed * wanted) {
    progress_.note(fmt::format(
        "{:.0f} triangles were asked for, but to remove more would harm the mesh", wanted));
  }
}

void MeshRun::report_totals(const MeshTotals& totals) const {
  if (surface_.border == Border::open && !options_.surface.border && totals.n_boundary_edges != 0 &&
      !stages_.change_counts()) {
    progress_.note_remedy(fmt::format("the mesh is open at the volume's border: {} boundary edges",
                                      totals.n_boundary_edges),
                          Remedy::close_border);
  }
  for (std::size_t n = 0; n < totals.n_clamped.size(); ++n) {
    if (totals.n_clamped[n] == 0) continue;
    warn_of_clamped(source_->place, attributes_[n]->info(),
                    fmt::format("{} of {} vertices", totals.n_clamped[n], totals.n_vertices),
                    progress_);
  }
  if (totals.components) {
    const ComponentCounts& components = *totals.components;
    progress_.note(fmt::format("kept {} of {} components", components.kept, components.found));
  }
  if (simplify_ && totals.n_extracted != 0) report_simplified(totals);
  progress_.detail(
      fmt::format("{}: {} vertices, {} triangles", output_, totals.n_vertices, totals.n_triangles));
  if (totals.n_skipped == 0) return;
  progress_.detail(fmt::format(
      "skipped {} of {} samples, far from the surface ({:.1f} %)", totals.n_skipped, totals.n_asked,
      100 * static_cast<double>(totals.n_skipped) / static_cast<double>(totals.n_asked)));
}

void MeshRun::write() {
  if (!stages_.empty()) progress_.detail(fmt::format("stages: {}", stages_.names()));
  const process::CubeStageList cube_stages(cube_stages_);
  if (!cube_stages.empty()) progress_.detail(fmt::format("cube stages: {}", cube_stages.names()));
  timed("extract", [&] {
    const std::unique_ptr<MeshSink> sink = open_mesh_sink(output_, sink_options());
    for (const Iso& iso : surface_.isos) report_.totals.push_back(run_one(iso.value, *sink));
    refuse_changed_inputs();
    sink->finish();
  });
  for (const MeshTotals& totals : report_.totals) report_totals(totals);
}

void MeshRun::run(const std::optional<Surface>& surface) {
  place_mesh();
  check_memory(reader(), run_options(0));
  if (surface) {
    surface_ = *surface;
  } else {
    choose_surface();
  }
  report_.surface = surface_;
  if (options_.dry_run) {
    report_.memory = memory_needed(reader(), run_options(surface_.isos.front().value));
  } else {
    write();
  }
}

}  // namespace mc::conversion

namespace mc {

std::unique_ptr<AttributeReader> volume_attribute(const VolumeAttribute& attribute,
                                                  const Affine& to_world) {
  return field::volume_attribute(*attribute.volume, attribute.name, to_world);
}

}  // namespace mc
