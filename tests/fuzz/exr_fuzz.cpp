// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <span>

#include "support/fuzz_images.hpp"

// libFuzzer's way into the reader of OpenEXR pictures.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mc::test::open_and_decode(mc::source::ImageKind::exr, std::as_bytes(std::span(data, size)));
  return 0;
}
