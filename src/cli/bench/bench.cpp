// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>

#include "base/parallel.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/bench/bench_bandwidth.hpp"
#include "cli/bench/bench_field.hpp"
#include "cli/bench/bench_noise.hpp"
#include "cli/bench/bench_noise_report.hpp"
#include "cli/bench/bench_plan.hpp"
#include "cli/bench/bench_report.hpp"
#include "cli/bench/bench_surface.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"

// `mc bench`: how fast the library call is on this machine, beside what its memory allows. Nothing
// but that call is inside the clock; arrays and meshes are warm.

namespace mc::cli {

namespace {

/// Makes the mesh once and proves it. Errors   internal.
void prove(BenchSurface& surface, const BenchVolume& volume, const std::string& name) {
  surface.extract();
  std::string fault = fault_of(volume, surface.mesh());
  if (fault.empty() && name == "sphere") {
    fault = fault_of_sphere(surface.mesh(), volume.n, volume.type);
  }
  if (!fault.empty()) throw Error(ErrorKind::internal, name, fault, "please report it");
}

DemoResult time_demo(std::int32_t n_cells, const RoundLimits& limits) {
  const BenchVolume volume = make_demo_volume(n_cells);
  BenchSurface surface(volume, Normals::none);
  prove(surface, volume, fmt::format("demo {}^3", n_cells));
  const TimedBody body{1, [&] { surface.extract(); }};
  const Timing timing = time_rounds({&body, 1}, limits).front();
  return {n_cells, surface.mesh().n_vertices(), surface.mesh().n_triangles(), timing};
}

/// One field with every number of threads, in the same rounds as reading its samples.
std::vector<FieldResult> time_field(const std::string& name, const BenchPlan& plan,
                                    const std::vector<Bandwidth>& bandwidths) {
  const BenchVolume volume = make_bench_volume(name, plan.n_samples, plan.type);
  BenchSurface surface(volume, plan.normals);
  prove(surface, volume, name);
  std::vector<TimedBody> bodies;
  for (const int threads : plan.threads) {
    bodies.push_back({threads, [&] { surface.extract(); }});
    bodies.push_back({threads, [&] { read_memory(volume.samples.data(), volume.samples.size()); }});
  }
  const std::vector<Timing> timings = time_rounds(bodies, plan.limits);
  std::vector<FieldResult> results;
  for (std::size_t t = 0; t < plan.threads.size(); ++t) {
    results.push_back({name, plan.threads[t], volume.samples.size() / sample_size(volume.type),
                       surface.mesh().n_vertices(), surface.mesh().n_triangles(),
                       volume.samples.size(), surface.mesh_bytes(), timings[2 * t],
                       timings[2 * t + 1], bandwidths[t].read()});
  }
  return results;
}

/// Everything, each table shown as soon as it is known.
void bench(const BenchPlan& plan) {
  const auto show_text = [&](const std::string& text) {
    if (!plan.json) print_out(text);
  };
  show_text(bench_head_text(plan));
  const std::vector<Bandwidth> bandwidths = measure_bandwidth(plan.threads, plan.limits);
  show_text(to_text(bandwidths));
  constexpr std::array<std::int32_t, 6> kDemoCells{1, 10, 20, 30, 40, 50};
  std::vector<DemoResult> demo;
  demo.reserve(kDemoCells.size());
  RoundLimits demo_limits = plan.limits;
  demo_limits.seconds /= static_cast<double>(kDemoCells.size());
  for (const std::int32_t n : kDemoCells) demo.push_back(time_demo(n, demo_limits));
  show_text(to_text(demo));
  show_text(field_head_text());
  std::vector<FieldResult> fields;
  for (const std::string& name : plan.fields) {
    for (FieldResult& result : time_field(name, plan, bandwidths)) {
      show_text(to_text(result));
      fields.push_back(std::move(result));
    }
  }
  if (plan.json) print_out(to_json(plan, bandwidths, demo, fields));
}

void bench_noise(const BenchPlan& plan) {
  const std::vector<NoiseResult> results = measure_noises(plan.n_samples, plan.limits);
  print_out(plan.json ? noises_json(plan, results) : noises_text(plan, results));
}

}  // namespace

int run_bench(Invocation& invocation, std::vector<std::string> words) {
  BenchArgs args;
  parse_words("bench", options_of(args), nullptr, std::move(words));
  if (args.common.help) {
    print_out(help_text("bench", args.common.verbose > 0));
    return 0;
  }
  const BenchPlan plan = resolve(args);
  invocation.console.configure(resolve_common(args.common));
  if (!plan.noise) check_bench_memory(plan);  // a run keeps its own budget
  plan.noise ? bench_noise(plan) : bench(plan);
  return 0;
}

}  // namespace mc::cli
