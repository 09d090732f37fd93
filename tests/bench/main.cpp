// SPDX-License-Identifier: MIT
#include "kernel_bench.hpp"

int main(int argc, char** argv) {
  mc::bench::add_classification();
  mc::bench::add_cells();
  mc::bench::add_vertices();
  mc::bench::add_noises();
  mc::bench::add_chunks();
  mc::bench::add_edits();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
