// SPDX-License-Identifier: MIT
#include "cli/messages/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/machine_memory.hpp"
#include "cli/arguments/values.hpp"

// All JSON that leaves the program. Keys keep their order; numbers that are not finite are null;
// bytes that are no UTF-8 (in file names) are replaced.

namespace mc::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json bounds_json(const Bounds& bounds) {
  return bounds.empty() ? Json() : Json::array({bounds.lo, bounds.hi});
}

/// dims() wants extents that fit; a hostile file's may not.
Json dims_json(const IndexBox& box) {
  return Json::array({box.extent(0), box.extent(1), box.extent(2)});
}

Json input_json(const ConvertReport& report) {
  Json input;
  input["place"] = report.input;
  const auto volume_text = [&](auto text) {
    return report.volume ? text_or_null(text(*report.volume)) : Json();
  };
  input["format"] = volume_text([](const Volume& v) { return v.format; });
  input["grid"] = volume_text([](const Volume& v) { return v.name; });
  input["type"] = volume_text([](const Volume& v) { return std::string(sample_name(v.type)); });
  input["class"] = volume_text([](const Volume& v) { return std::string(name_of(v.cls)); });
  const auto& at = report.frame;
  input["frame"] = at ? Json(name_of(at->source_frame)) : Json();
  input["up"] = at && at->source_frame == Frame::none ? Json(name_of(at->source_up)) : Json();
  input["units"] = at ? Json(name_of(at->source_units)) : Json();
  return input;
}

/// What simplification left, in world units and in cells.
void add_simplified(Json& json, const ConvertReport& report) {
  if (report.totals.empty() || !report.totals.front().distances || !report.frame) return;
  std::uint64_t n = 0;
  MeshDistances all;
  double sum_squares = 0;
  for (const MeshTotals& one : report.totals) {
    n += one.n_extracted;
    sum_squares += static_cast<double>(one.n_extracted) * one.distances->rms * one.distances->rms;
    all.max = std::max(all.max, one.distances->max);
  }
  if (n != 0) all.rms = std::sqrt(sum_squares / static_cast<double>(n));
  const double cell = std::cbrt(std::abs(report.frame->to_world.determinant()));
  json["extracted_triangles"] = n;
  json["distance_rms"] = all.rms;
  json["distance_max"] = all.max;
  json["distance_rms_cells"] = all.rms / cell;
  json["distance_max_cells"] = all.max / cell;
}

void add_totals(Json& json, const std::vector<MeshTotals>& totals) {
  static constexpr const char* kKeys[] = {
      "vertices", "triangles", "boundary_edges", "nonmanifold_edges", "euler", "components",
      "area",     "volume",    "bounds"};
  for (const char* key : kKeys) json[key] = nullptr;
  if (totals.empty()) return;
  MeshTotals sum;
  std::int64_t euler = 0;
  sum.area = sum.volume = 0;
  for (const MeshTotals& one : totals) {
    sum.n_vertices += one.n_vertices;
    sum.n_triangles += one.n_triangles;
    sum.n_boundary_edges += one.n_boundary_edges;
    sum.bounds.include(one.bounds);
    euler += one.euler();
    sum.area = sum.area && one.area ? std::optional(*sum.area + *one.area) : std::nullopt;
    sum.volume = sum.volume && one.volume ? std::optional(*sum.volume + *one.volume) : std::nullopt;
  }
  json["vertices"] = sum.n_vertices;
  json["triangles"] = sum.n_triangles;
  json["boundary_edges"] = sum.n_boundary_edges;
  json["nonmanifold_edges"] = 0;  // by the construction of the case table
  json["euler"] = euler;
  if (totals.front().components) {
    ComponentCounts components;
    for (const MeshTotals& one : totals) {
      components.found += one.components->found;
      components.kept += one.components->kept;
    }
    json["kept_components"] = components.kept;
    json["dropped_components"] = components.dropped();
  }
  json["area"] = or_null(sum.area);
  json["volume"] = or_null(sum.volume);
  json["bounds"] = bounds_json(sum.bounds);
}

Json stages_json(const std::vector<StageTime>& stages) {
  Json all = Json::array();
  for (const StageTime& stage : stages) {
    all.push_back(
        {{"name", stage.name}, {"seconds", stage.seconds}, {"bytes", or_null(stage.n_bytes)}});
  }
  return all;
}

Json volume_json(const GridDescription& grid) {
  const Volume& v = grid.volume;
  Json json;
  json["name"] = text_or_null(v.name);
  json["format"] = v.format;
  json["type"] = grid.type_name;
  json["class"] = name_of(v.cls);
  json["dims"] = grid.refused.empty() ? dims_json(v.lattice.box) : Json();
  json["first_index"] = grid.refused.empty() ? Json(v.lattice.box.lo) : Json();
  const Affine& map = v.lattice.to_world;
  json["spacing"] = {map.spacing(0), map.spacing(1), map.spacing(2)};
  json["affine"] = map.m;
  json["frame"] = name_of(v.frame);
  json["units"] = name_of(v.units);
  json["active"] = or_null(v.n_active);
  json["refused"] = text_or_null(grid.refused);
  return json;
}

Json grid_json(const GridInfo& grid) {
  Json json = volume_json(grid.description);
  for (const char* key : {"samples", "nan", "infinite", "range", "mean", "percentiles",
                          "suggested_iso", "iso_reason"}) {
    json[key] = nullptr;
  }
  if (!grid.statistics) return json;
  const FieldStatistics& s = *grid.statistics;
  json["samples"] = s.n_samples;
  json["nan"] = s.n_nan;
  json["infinite"] = s.n_infinite;
  json["range"] = {s.min, s.max};
  json["mean"] = s.mean;
  Json percentiles;
  const std::size_t n_percentiles = std::min(std::size(kInfoPercentiles), s.percentiles.size());
  for (std::size_t n = 0; n < n_percentiles; ++n) {
    percentiles[std::to_string(static_cast<int>(kInfoPercentiles[n]))] = s.percentiles[n];
  }
  json["percentiles"] = percentiles;
  json["suggested_iso"] = grid.iso;
  json["iso_reason"] = grid.iso_reason;
  if (grid.memory) {
    json["memory"] = {{"budget", grid.memory->budget},
                      {"expected", grid.memory->expected},
                      {"most", grid.memory->most},
                      {"least", grid.memory->least}};
  }
  return json;
}

}  // namespace

std::string to_json(const RunReport& report) {
  const ConvertReport& done = report.done;
  Json json;
  json["mc"] = MC_VERSION;
  json["status"] = report.status;
  json["error"] = or_null(report.error);
  if (report.skipped) json["skipped"] = true;
  json["input"] = input_json(done);
  json["output"] = or_null(report.output);
  json["iso"] = Json::array();
  if (done.surface) {
    for (const Iso& iso : done.surface->isos) json["iso"].push_back(iso.value);
  }
  json["inside"] = done.surface ? Json(name_of(done.surface->inside)) : Json();
  json["dims"] = done.volume ? dims_json(done.volume->lattice.box) : Json();
  json["affine"] = done.frame ? Json(done.frame->to_world.m) : Json();
  add_totals(json, done.totals);
  add_simplified(json, done);
  json["stages"] = stages_json(done.stages);
  json["peak_bytes"] = report.peak_bytes;
  json["warnings"] = report.warnings;
  return one_line(json);
}

std::string to_json(const InputInfo& info) {
  Json json;
  json["mc"] = MC_VERSION;
  json["input"] = info.place;
  json["error"] = or_null(info.error);
  json["grids"] = Json::array();
  for (const GridInfo& grid : info.grids) json["grids"].push_back(grid_json(grid));
  return one_line(json);
}

std::string to_json(const std::string& path, const MeshReport& report, bool defective) {
  Json json;
  json["mc"] = MC_VERSION;
  json["mesh"] = path;
  json["defective"] = defective;
  json["closed"] = report.closed();
  json["vertices"] = report.n_vertices;
  json["triangles"] = report.n_triangles;
  json["not_finite"] = report.not_finite;
  json["out_of_range"] = report.out_of_range;
  json["degenerate"] = report.degenerate;
  json["duplicate"] = report.duplicate;
  json["boundary_edges"] = report.boundary_edges;
  json["nonmanifold_edges"] = report.nonmanifold_edges;
  json["nonmanifold_vertices"] = report.nonmanifold_vertices;
  json["misoriented_edges"] = report.misoriented_edges;
  json["unreferenced_vertices"] = report.unreferenced_vertices;
  json["duplicate_vertices"] = report.duplicate_vertices;
  json["components"] = report.components;
  json["euler"] = report.euler;
  json["area"] = report.area;
  json["volume"] = report.volume;
  json["bounds"] = bounds_json(report.bounds);
  return one_line(json);
}

const char* name_of(VolumeClass cls) {
  switch (cls) {
    case VolumeClass::unknown:
      return "unknown";
    case VolumeClass::level_set:
      return "level set";
    case VolumeClass::fog:
      return "fog volume";
    case VolumeClass::mask:
      return "mask";
    case VolumeClass::density_spec:
      return "density spec";
    case VolumeClass::sdf_spec:
      return "sdf spec";
  }
  return "unknown";
}

std::string memory_text(const MemoryNeed& need) {
  return fmt::format("{} expected, {} at most, of {}; {} would do", base::size_text(need.expected),
                     base::size_text(need.most), base::size_text(need.budget),
                     base::size_text(need.least));
}

std::string dry_run_text(const ConvertReport& report, const std::string& output,
                         const std::optional<IndexBox>& region) {
  const Volume& v = *report.volume;
  const IndexBox box = region.value_or(v.lattice.box);
  std::string text = fmt::format("input    {}\n", report.input);
  text += fmt::format("format   {}{}{}\n", v.format, v.name.empty() ? "" : ", grid ", v.name);
  text += fmt::format("samples  {} x {} x {} {}, {}\n", box.extent(0), box.extent(1), box.extent(2),
                      sample_name(v.type), base::size_text(*report.stages.back().n_bytes));
  for (const Iso& iso : report.surface->isos) {
    text += fmt::format("iso      {}{}\n", value_text(iso.value, v.type),
                        iso.reason.empty() ? "" : fmt::format(" ({})", iso.reason));
  }
  text += fmt::format("inside   {}\n", name_of(report.surface->inside));
  text += fmt::format("border   {}\n", name_of(report.surface->border));
  text += fmt::format("frame    {}, units {}\n", name_of(report.frame->source_frame),
                      name_of(report.frame->units));
  text += fmt::format("memory   {}\n", memory_text(*report.memory));
  return text + fmt::format("output   {} ({})\n", output, report.format);
}

}  // namespace mc::cli
