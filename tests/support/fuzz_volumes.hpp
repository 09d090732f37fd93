// SPDX-License-Identifier: MIT
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "mc/source.hpp"

// What the fuzzers of volume files run, shared with the tests that replay the corpus.

namespace mc::test {

/// A file in memory with a path of its own.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : fd_(::memfd_create("fuzz", 0)) {
    if (::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      throw std::runtime_error("cannot write a file in memory");
    }
  }
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// The kind of a raw volume is not in its bytes: the first three say it.
inline SourceOptions raw_options(std::span<const std::byte> bytes) {
  SourceOptions options;
  const auto byte = [&](std::size_t n) {
    return n < bytes.size() ? std::to_integer<unsigned>(bytes[n]) : 0U;
  };
  options.dims = {byte(0) % 8, byte(1) % 8};
  options.type = static_cast<SampleType>(byte(2) % 10);
  options.skip_bytes = 3;
  return options;
}

inline void read_all(const SlabReader& reader) {
  const Index3 dims = reader.volume().lattice.dims();
  const std::size_t row = static_cast<std::size_t>(dims[0]) * sample_size(reader.volume().type);
  Slab slab;
  volatile unsigned sum = 0;
  reader.read(0, dims[2], slab);
  for (const std::byte* plane : slab.planes) {
    const std::byte* last = plane + static_cast<std::size_t>(dims[1] - 1) * slab.row_stride_bytes;
    sum = sum + std::to_integer<unsigned>(plane[0]) + std::to_integer<unsigned>(last[row - 1]);
  }
}

inline void read_all(const LeafReader& reader) {
  alignas(8) std::array<std::byte, LeafReader::kLeafSamples * 8> scratch{};
  volatile unsigned sum = 0;
  const std::size_t size = LeafReader::kLeafSamples * sample_size(reader.volume().type);
  for (std::size_t n = 0; n < reader.leaves().size(); ++n) {
    const std::byte* values = reader.leaf_values(n, scratch.data());
    for (std::size_t i = 0; i < size; ++i) {
      sum = sum + std::to_integer<unsigned>(values[i]);
    }
    sum = sum + static_cast<unsigned>(reader.leaf_active(n)[7]);
  }
}

/// What a reader may say of any bytes. Everything else is a finding.
inline bool is_refusal(const Error& error) {
  return error.kind() == ErrorKind::usage || error.kind() == ErrorKind::input ||
         error.kind() == ErrorKind::limit;
}

/// Opens the bytes as an input of kind `from` ("nrrd", "vdb", "raw") and reads all that a run would
/// read of it. True: it was readable. Anything but an Error of kind usage, input or limit comes
/// out.
inline bool open_and_read(const std::string& from, std::span<const std::byte> bytes) {
  const MemoryFile file(bytes);
  SourceOptions options = from == "raw" ? raw_options(bytes) : SourceOptions{};
  options.from = from;
  const std::array<std::string, 1> inputs{file.path()};
  try {
    describe_source(inputs, options, silent_progress());
    const Source source = open_source(inputs, options, silent_progress());
    if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&source.reader)) {
      read_all(**dense);
    } else {
      read_all(*std::get<std::unique_ptr<LeafReader>>(source.reader));
    }
    return true;
  } catch (const Error& error) {
    if (!is_refusal(error)) throw;
    return false;
  }
}

}  // namespace mc::test
