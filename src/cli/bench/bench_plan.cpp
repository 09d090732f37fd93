// SPDX-License-Identifier: MIT
#include "cli/bench/bench_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/parallel.hpp"
#include "cli/arguments/resolve.hpp"
#include "cli/arguments/values.hpp"
#include "cli/bench/bench_bandwidth.hpp"
#include "cli/bench/bench_field.hpp"
#include "mc/base.hpp"

// The words of `mc bench` to a plan, and whether the machine has room for it.

namespace mc::cli {

namespace {

std::vector<std::string> fields_of(const BenchArgs& args) {
  if (!args.fields) return {kBenchFields.begin(), kBenchFields.end()};
  std::vector<std::string> fields;
  for (const std::string_view name : split(*args.fields, ',')) {
    if (std::find(kBenchFields.begin(), kBenchFields.end(), name) == kBenchFields.end()) {
      refuse_choice("--fields", name, kBenchFields);
    }
    fields.emplace_back(name);
  }
  return fields;
}

/// One thread and all of them, where the user does not say.
std::vector<int> threads_of(const BenchArgs& args) {
  if (!args.threads) {
    const int all = base::thread_count();
    return all == 1 ? std::vector<int>{1} : std::vector<int>{1, all};
  }
  std::vector<int> threads;
  for (const std::string_view n : split(*args.threads, ',')) {
    threads.push_back(static_cast<int>(parse_integer("--threads", n, 1, 4096)));
  }
  return threads;
}

/// Noises are f32 without normals, on one thread.
void refuse_beside_noise(const BenchArgs& args) {
  if (!args.noise) return;
  for (const auto& [option, given] : {std::pair{"--fields", args.fields.has_value()},
                                      {"--type", args.type.has_value()},
                                      {"--normals", args.normals.has_value()},
                                      {"--threads", args.threads.has_value()}}) {
    if (given) {
      throw Error(ErrorKind::usage, option, "contradicts --noise", "give one of them");
    }
  }
}

}  // namespace

BenchPlan resolve(const BenchArgs& args) {
  refuse_beside_noise(args);
  BenchPlan plan;
  plan.fields = fields_of(args);
  if (args.size) {
    plan.n_samples = static_cast<std::int32_t>(parse_integer("--size", *args.size, 8, 65536));
  }
  if (args.type) plan.type = parse_type(*args.type);
  if (args.normals) plan.normals = parse_normals(*args.normals);
  plan.threads = threads_of(args);
  if (args.seconds) plan.limits.seconds = parse_number_within("--seconds", *args.seconds, 0, 3600);
  plan.json = args.json;
  plan.noise = args.noise;
  return plan;
}

double bench_bytes(const BenchPlan& plan) {
  const double n = plan.n_samples;
  const double field = n * n * n * static_cast<double>(sample_size(plan.type));
  // The gyroid has the most, 77 triangles to a column of samples from 256^3 on; a small cube has
  // less than two in a cell. A triangle takes 18 bytes with its share of vertices, 24 with normals,
  // and as much again while a vector grows.
  const double triangles = std::min(100 * n * n, 2 * n * n * n);
  return field + 48 * triangles + static_cast<double>(kBandwidthBytes);
}

void check_bench_memory(const BenchPlan& plan) {
  const double needed = bench_bytes(plan);
  const auto available = static_cast<double>(base::available_bytes());
  if (needed <= available) return;
  throw Error(ErrorKind::limit, "--size",
              fmt::format("this benchmark needs about {:.1f} GiB, but {:.1f} GiB are free",
                          needed / (1 << 30), available / (1 << 30)),
              "choose a smaller --size");
}

}  // namespace mc::cli
