// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <span>

#include "support/fuzz_streams.hpp"

// libFuzzer's way into what tells a pipe's kind, unpacks it and reads it once.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::test::stream_and_read(std::as_bytes(std::span(data, size)));
  return 0;
}
