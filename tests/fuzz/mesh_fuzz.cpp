// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <span>

#include "fuzz/mesh_input.hpp"

// libFuzzer's way into the mesh readers and the mesh check.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::test::read_and_check_mesh(std::as_bytes(std::span(data, size)));
  return 0;
}
