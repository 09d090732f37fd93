// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/replay_spec.hpp"

// libFuzzer harness of the mc-volume loader. data/corpus/spec holds its seeds; a unit test replays
// them through the same function.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::tests::replay_spec({reinterpret_cast<const char*>(data), size});
  return 0;
}
