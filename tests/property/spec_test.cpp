// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/replay_graph.hpp"
#include "graph/node_types.hpp"

// Random valid documents: the loader takes them, and their bits depend on nothing but the text.

namespace mc::tests {
namespace {

std::vector<std::uint8_t> random_bytes(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(50 + random() % 300);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(random());
  }
  return bytes;
}

/// How many to try: what the environment says in MC_TEST_DOCUMENTS, for a long run by itself.
std::uint32_t n_documents() {
  const char* wanted = std::getenv("MC_TEST_DOCUMENTS");
  return wanted == nullptr ? 1500 : static_cast<std::uint32_t>(std::stoul(wanted));
}

TEST(RandomSpecs, LoadAndGiveTheSameBitsOnEveryTarget) {
  const std::vector<std::string> targets = base::simd_targets();
  const std::uint32_t n = n_documents();
  std::uint32_t n_sampled = 0;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    SCOPED_TRACE(seed);
    n_sampled += replay_graph(random_bytes(seed), targets) ? 1 : 0;
  }
  EXPECT_GT(n_sampled, n / 15 * 14);
}

TEST(RandomSpecs, UseEveryTypeThatTheLoaderKnows) {
  std::set<std::string_view> known;
  for (const graph::NodeRow* row : graph::node_rows()) known.insert(row->name);
  known.erase("heightmap");  // needs a picture
  known.erase("volume");     // needs a file
  std::set<std::string_view> used;
  for (const RandomSpec::Grammar& grammar : RandomSpec::grammars()) {
    used.insert(grammar.type);
  }
  EXPECT_GT(known.size(), 50U);
  EXPECT_EQ(used, known);
}

}  // namespace
}  // namespace mc::tests
