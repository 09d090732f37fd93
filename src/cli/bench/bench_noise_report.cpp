// SPDX-License-Identifier: MIT
#include "cli/bench/bench_noise_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/bench/bench_report.hpp"

namespace mc::cli {

namespace {

using Json = nlohmann::ordered_json;

/// The first result of each target, in order; or the results of the first target.
std::vector<NoiseResult> unlike(const std::vector<NoiseResult>& results,
                                std::string NoiseResult::*what) {
  std::vector<NoiseResult> out;
  for (const NoiseResult& r : results) {
    const auto same = [&](const NoiseResult& o) { return o.*what == r.*what; };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(r);
  }
  return out;
}

/// A line of one figure of each target's result with this name.
template <class Figure>
std::string line(const std::vector<NoiseResult>& results, const std::string& name,
                 const Figure& figure) {
  std::string text = fmt::format("\n  {:22}", name);
  for (const NoiseResult& r : results) {
    if (r.name == name) text += fmt::format("{:>9}", three_digits(figure(r)));
  }
  return text;
}

}  // namespace

std::string noises_text(const BenchPlan& plan, const std::vector<NoiseResult>& results) {
  std::string text = fmt::format(
      "mc {}, {}, one thread\n"
      "least of {} rounds or more; meshes of {}x{}x{} samples\n\n{:24}",
      MC_VERSION, processor_name(), plan.limits.min_rounds, plan.n_samples, plan.n_samples / 2,
      plan.n_samples, "Mpoints/s");
  const std::vector<NoiseResult> targets = unlike(results, &NoiseResult::simd);
  for (const NoiseResult& r : targets) text += fmt::format("{:>9}", r.simd);
  text += fmt::format("\n  {:22}", "core, GHz");
  for (const NoiseResult& r : targets) text += fmt::format("{:>9.2f}", r.clock / 1e9);
  const std::vector<NoiseResult> noises = unlike(results, &NoiseResult::name);
  for (const NoiseResult& noise : noises) {
    text +=
        line(results, noise.name, [](const NoiseResult& r) { return r.points_a_second() / 1e6; });
  }
  text += "\n\nby FastNoise2's, a GHz";
  for (const NoiseResult& noise : noises) {
    if (noise.published == 0) continue;
    text += line(results, noise.name, [](const NoiseResult& r) { return r.by_published(); });
  }
  return text + "\n";
}

std::string noises_json(const BenchPlan& plan, const std::vector<NoiseResult>& results) {
  Json json{{"mc", MC_VERSION}, {"processor", processor_name()}, {"size", plan.n_samples}};
  json["noises"] = Json::array();
  for (const NoiseResult& r : results) {
    Json entry{{"noise", r.name},
               {"simd", r.simd},
               {"time", json_of(r.time)},
               {"points_per_second", r.points_a_second()},
               {"hz", r.clock}};
    if (r.published != 0) entry["by_fastnoise2"] = r.by_published();
    json["noises"].push_back(std::move(entry));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mc::cli
