// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "source/image/open_image.hpp"
#include "support/fuzz_volumes.hpp"

// What the fuzzers of pictures run, shared with the tests that replay the corpus.

namespace mc::test {

/// Opens the bytes as a picture and decodes every channel of every part that is not large. True:
/// all of it was readable. Anything but an Error of kind input or limit comes out.
inline bool open_and_decode(source::ImageKind kind, std::span<const std::byte> bytes) {
  constexpr std::int64_t kMostPixels = 1 << 20;
  if (bytes.empty()) return false;
  const MemoryFile memory(bytes);
  try {
    const source::MappedFile file(memory.path());
    const auto image = source::open_image(kind, file);
    for (std::size_t p = 0; p < image->parts().size(); ++p) {
      const source::ImagePart& part = image->parts()[p];
      if (std::int64_t{part.width} * part.height > kMostPixels) continue;
      for (std::size_t c = 0; c < part.channels.size(); ++c) {
        const std::size_t row =
            static_cast<std::size_t>(part.width) * sample_size(part.channels[c].type);
        Buffer<std::byte> out(row * static_cast<std::size_t>(part.height));
        image->read(p, c, out.data() + (out.size() - row), -static_cast<std::ptrdiff_t>(row));
      }
    }
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::limit) throw;
    return false;
  }
}

}  // namespace mc::test
