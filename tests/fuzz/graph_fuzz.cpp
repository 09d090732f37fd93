// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/hash.hpp"
#include "fuzz/replay_graph.hpp"

// libFuzzer harness over valid mc-volume documents: bytes choose from the grammar of all nodes, so
// that every input gets past the loader. What differs between SIMD targets is a finding. A campaign
// compares two targets an input, which its bytes choose; the program that replays takes all of
// them.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::string> all = mc::base::simd_targets();
#ifdef MC_FUZZ
  const std::uint64_t hash = mc::base::hash_on(size, std::as_bytes(std::span(data, size)));
  const std::size_t first = hash % all.size();
  const std::size_t between = hash / all.size() % std::max<std::size_t>(all.size() - 1, 1);
  const std::vector<std::string> targets{all[first], all[(first + 1 + between) % all.size()]};
#else
  const std::vector<std::string>& targets = all;
#endif
  mc::tests::replay_graph({data, size}, targets);
  return 0;
}
