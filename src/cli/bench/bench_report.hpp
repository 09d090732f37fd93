// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/bench/bench_bandwidth.hpp"
#include "cli/bench/bench_plan.hpp"
#include "cli/bench/bench_rounds.hpp"

// The figures of `mc bench`, as tables for people and as JSON. Keys are those of mc-bench(1).

namespace mc::cli {

/// One terrain of the demo's table.
struct DemoResult {
  std::int32_t n_cells = 0;  ///< along each axis
  std::uint64_t n_vertices = 0, n_triangles = 0;
  Timing extract;
};

/// One field with one number of threads.
struct FieldResult {
  std::string name;
  int threads = 1;
  std::uint64_t n_samples = 0, n_vertices = 0, n_triangles = 0;
  std::uint64_t sample_bytes = 0, mesh_bytes = 0;
  Timing extract;
  Timing read;                ///< of the same samples, with as many threads
  double read_bandwidth = 0;  ///< bytes a second, with as many threads

  [[nodiscard]] double times_read() const { return extract.median / read.median; }
  /// The time that the samples and the mesh would take at the read bandwidth, by the time taken.
  [[nodiscard]] double bandwidth_share() const {
    return static_cast<double>(sample_bytes + mesh_bytes) / read_bandwidth / extract.median;
  }
};

/// The processor, as /proc/cpuinfo names it.
std::string processor_name();
/// Three digits, or all before the point: "4.77", "83.1", "1870".
std::string three_digits(double value);
nlohmann::ordered_json json_of(const Timing& timing);

/// Machine, program and method: what a figure is worth nothing without.
std::string bench_head_text(const BenchPlan& plan);
std::string to_text(const std::vector<Bandwidth>& bandwidths);
std::string to_text(const std::vector<DemoResult>& results);
/// The head of the fields' table, and its lines.
std::string field_head_text();
std::string to_text(const FieldResult& result);

std::string to_json(const BenchPlan& plan, const std::vector<Bandwidth>& bandwidths,
                    const std::vector<DemoResult>& demo, const std::vector<FieldResult>& fields);

}  // namespace mc::cli
