// SPDX-License-Identifier: MIT
#include "cli/edit/edit_report.hpp"

#include <nlohmann/json.hpp>

#include <utility>

#include "mc/convert.hpp"

// Keys keep their order; what is unknown is null.

namespace mc::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json box_json(const IndexBox& box) {
  return is_empty(box) ? Json() : Json::array({box.lo, box.hi});
}

Json bounds_json(const Bounds& bounds) {
  return bounds.empty() ? Json() : Json::array({bounds.lo, bounds.hi});
}

void add_chunks(Json& json, const ChunkChanges& changes) {
  json["removed"] = changes.removed;
  json["chunks"] = Json::array();
  for (const ChunkUpdate& chunk : changes.updated) {
    Json one;
    one["id"] = chunk.id;
    if (!chunk.file.empty()) one["file"] = chunk.file;
    one["bytes"] = chunk.n_bytes;
    one["vertices"] = chunk.n_vertices;
    one["triangles"] = chunk.n_triangles;
    one["bounds"] = bounds_json(chunk.bounds);
    json["chunks"].push_back(std::move(one));
  }
  json["surface"] = {{"chunks", changes.sums.n_chunks},
                     {"vertices", changes.sums.n_vertices},
                     {"triangles", changes.sums.n_triangles}};
}

void add_effect(Json& json, const EditEffect& effect) {
  json["dabs"] = effect.n_dabs;
  json["outside"] = effect.n_outside;
  json["samples"] = effect.n_samples;
  json["changed"] = effect.n_changed;
}

}  // namespace

std::string to_json(const RecordReport& report) {
  Json json;
  json["record"] = report.number;
  json["op"] = report.op;
  if (report.count) {
    json["count"] = *report.count;
  } else if (report.output) {
    json["output"] = *report.output;
  } else if (!report.is_state) {
    add_effect(json, report.effect);
  }
  if (!report.is_state) {
    json["touched"] = box_json(report.effect.touched);
    json["bounds"] = bounds_json(report.bounds);
  }
  if (report.n_reached) json["reached_chunks"] = *report.n_reached;
  if (report.chunks) add_chunks(json, *report.chunks);
  json["seconds"] = report.seconds;
  return one_line(json);
}

std::string to_json(const EditRunReport& report) {
  const ScriptReport& done = report.done;
  Json json;
  json["mc"] = MC_VERSION;
  json["status"] = report.status;
  json["error"] = report.error ? Json(*report.error) : Json();
  json["input"] = done.input;
  json["space"] = done.index_space ? "index" : "world";
  json["iso"] = done.iso;
  json["inside"] = name_of(done.inside);
  json["records"] = done.n_records;
  json["edits"] = done.n_edits;
  json["outside"] = done.n_outside;
  json["changed"] = done.n_changed;
  json["stored_blocks"] = done.n_stored_blocks;
  json["stored_bytes"] = done.stored_bytes;
  json["peak_bytes"] = report.peak_bytes;
  json["warnings"] = report.warnings;
  return one_line(json);
}

}  // namespace mc::cli
