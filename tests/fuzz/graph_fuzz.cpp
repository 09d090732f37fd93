// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>

#include "fuzz/replay_graph.hpp"

// libFuzzer harness over valid mc-volume documents: bytes choose from the grammar of all nodes, so
// that every input gets past the loader. What differs between SIMD targets is a finding.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::tests::replay_graph({data, size});
  return 0;
}
