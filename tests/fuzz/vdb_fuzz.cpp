// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <span>

#include "support/fuzz_volumes.hpp"

// libFuzzer's way into the vdb reader.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::test::open_and_read("vdb", std::as_bytes(std::span(data, size)));
  return 0;
}
