// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>

#include "fuzz/replay_script.hpp"

// libFuzzer harness of the mc-edits reader. data/corpus/script holds its seeds: good-* are taken,
// the others refused.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::tests::replay_script({reinterpret_cast<const char*>(data), size});
  return 0;
}
