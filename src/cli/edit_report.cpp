// SPDX-License-Identifier: MIT
#include "cli/edit_report.hpp"

#include <nlohmann/json.hpp>

#include "cli/report.hpp"
#include "cli/surface_choice.hpp"

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

}  // namespace

std::string to_json(const RecordReport& report) {
  Json json;
  json["record"] = report.number;
  json["op"] = report.op;
  if (report.count) {
    json["count"] = *report.count;
  } else if (report.output) {
    json["output"] = *report.output;
  } else {
    json["dabs"] = report.effect.n_dabs;
    json["outside"] = report.effect.n_outside;
    json["samples"] = report.effect.n_samples;
    json["changed"] = report.effect.n_changed;
  }
  json["touched"] = box_json(report.effect.touched);
  json["bounds"] = bounds_json(report.bounds);
  json["seconds"] = report.seconds;
  return one_line(json);
}

std::string to_json(const EditTotals& totals) {
  Json json;
  json["mc"] = MC_VERSION;
  json["status"] = totals.status;
  json["error"] = totals.error ? Json(*totals.error) : Json();
  json["input"] = totals.input;
  json["space"] = totals.index_space ? "index" : "world";
  json["iso"] = totals.iso;
  json["inside"] = name_of(totals.inside);
  json["records"] = totals.n_records;
  json["edits"] = totals.n_edits;
  json["outside"] = totals.n_outside;
  json["changed"] = totals.n_changed;
  json["stored_blocks"] = totals.n_stored_blocks;
  json["stored_bytes"] = totals.stored_bytes;
  json["peak_bytes"] = peak_bytes();
  json["warnings"] = totals.warnings;
  return one_line(json);
}

}  // namespace mc::cli
