// SPDX-License-Identifier: MIT
#include "cli/bench/bench_report.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/simd_target.hpp"
#include "cli/bench/bench_field.hpp"

namespace mc::cli {

using Json = nlohmann::ordered_json;

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown processor";
}

std::string three_digits(double value) {
  const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f}", value, decimals);
}

Json json_of(const Timing& t) {
  return {{"ms", t.median * 1e3},
          {"least_ms", t.least * 1e3},
          {"spread_ms", t.spread * 1e3},
          {"rounds", t.n_rounds}};
}

namespace {

const char* normals_name(Normals normals) {
  switch (normals) {
    case Normals::none:
      return "none";
    case Normals::gradient:
      return "gradient";
    case Normals::face:
      return "face";
  }
  __builtin_unreachable();
}

std::string time_text(double seconds) {
  const bool small = seconds < 0.9995e-3;
  return three_digits(seconds * (small ? 1e6 : 1e3)) + (small ? " us" : " ms");
}

std::string spread_text(const Timing& t) {
  return fmt::format("{:.1f} %", 100 * t.spread / t.median);
}

double gigabytes_a_second(const Bandwidth& b, const Timing& t) {
  return static_cast<double>(b.n_bytes) / t.median / 1e9;
}

Json json_of(const Bandwidth& b) {
  return {{"threads", b.threads},
          {"bytes", b.n_bytes},
          {"read", b.read()},
          {"read_one_stream", static_cast<double>(b.n_bytes) / b.read_one_stream.median},
          {"read_eight_streams", static_cast<double>(b.n_bytes) / b.read_eight_streams.median},
          {"write", static_cast<double>(b.n_bytes) / b.write.median},
          {"write_past_cache", static_cast<double>(b.n_bytes) / b.write_past_cache.median},
          {"touch_small", static_cast<double>(b.n_bytes) / b.touch_small.median},
          {"touch_huge", static_cast<double>(b.n_bytes) / b.touch_huge.median}};
}

Json json_of(const FieldResult& r) {
  const double seconds = r.extract.median;
  return {{"field", r.name},
          {"threads", r.threads},
          {"vertices", r.n_vertices},
          {"triangles", r.n_triangles},
          {"time", json_of(r.extract)},
          {"read", json_of(r.read)},
          {"times_read", r.times_read()},
          {"samples_per_second", static_cast<double>(r.n_samples) / seconds},
          {"triangles_per_second", static_cast<double>(r.n_triangles) / seconds},
          {"bw", r.bandwidth_share()}};
}

}  // namespace

std::string bench_head_text(const BenchPlan& plan) {
  return fmt::format(
      "mc {}, {}, simd {}\n"
      "medians of {} rounds or more, {}^3 samples of {}, normals: {}\n",
      MC_VERSION, processor_name(), base::simd_target_name(), plan.limits.min_rounds,
      plan.n_samples, sample_name(plan.type), normals_name(plan.normals));
}

std::string to_text(const std::vector<Bandwidth>& bandwidths) {
  std::string text = fmt::format("\nmemory, GB/s{:>12}", "threads");
  for (const Bandwidth& b : bandwidths) text += fmt::format("{:>8}", b.threads);
  const auto line = [&](const char* name, const Timing Bandwidth::*way) {
    text += fmt::format("\n  {:22}", name);
    for (const Bandwidth& b : bandwidths) {
      text += fmt::format("{:8.1f}", gigabytes_a_second(b, b.*way));
    }
  };
  line("read, one stream", &Bandwidth::read_one_stream);
  line("read, eight streams", &Bandwidth::read_eight_streams);
  line("write", &Bandwidth::write);
  line("write past the cache", &Bandwidth::write_past_cache);
  line("fresh pages of 4 KiB", &Bandwidth::touch_small);
  line("fresh huge pages", &Bandwidth::touch_huge);
  return text + "\n";
}

std::string to_text(const std::vector<DemoResult>& results) {
  std::string text = fmt::format("\n{:10}{:>10}{:>11}{:>11}{:>9}\n", "demo", "vertices",
                                 "triangles", "time", "spread");
  for (const DemoResult& r : results) {
    text +=
        fmt::format("  {:8}{:>10}{:>11}{:>11}{:>9}\n", fmt::format("{}^3", r.n_cells), r.n_vertices,
                    r.n_triangles, time_text(r.extract.median), spread_text(r.extract));
  }
  return text;
}

std::string field_head_text() {
  return fmt::format("\n{:10}{:>8}{:>11}{:>11}{:>9}{:>8}{:>12}{:>9}{:>6}\n", "field", "threads",
                     "triangles", "time", "spread", "/ read", "Msamples/s", "Mtri/s", "bw");
}

std::string to_text(const FieldResult& r) {
  const double seconds = r.extract.median;
  return fmt::format("  {:8}{:>8}{:>11}{:>11}{:>9} {:>7}{:>12.0f}{:>9.1f}{:>6.2f}\n", r.name,
                     r.threads, r.n_triangles, time_text(seconds), spread_text(r.extract),
                     three_digits(r.times_read()), static_cast<double>(r.n_samples) / seconds / 1e6,
                     static_cast<double>(r.n_triangles) / seconds / 1e6, r.bandwidth_share());
}

std::string to_json(const BenchPlan& plan, const std::vector<Bandwidth>& bandwidths,
                    const std::vector<DemoResult>& demo, const std::vector<FieldResult>& fields) {
  Json json{{"mc", MC_VERSION},
            {"processor", processor_name()},
            {"simd", base::simd_target_name()},
            {"size", plan.n_samples},
            {"type", sample_name(plan.type)},
            {"normals", normals_name(plan.normals)}};
  json["memory"] = Json::array();
  for (const Bandwidth& b : bandwidths) json["memory"].push_back(json_of(b));
  json["demo"] = Json::array();
  for (const DemoResult& r : demo) {
    json["demo"].push_back({{"cells", r.n_cells},
                            {"vertices", r.n_vertices},
                            {"triangles", r.n_triangles},
                            {"time", json_of(r.extract)}});
  }
  json["fields"] = Json::array();
  for (const FieldResult& r : fields) json["fields"].push_back(json_of(r));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mc::cli
