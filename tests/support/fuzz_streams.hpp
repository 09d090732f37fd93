// SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "mc/source.hpp"
#include "support/fuzz_volumes.hpp"

// What the fuzzer of piped inputs runs, shared with the tests that replay the corpus.

namespace mc::test {

/// A pipe that holds the bytes and then ends; its path can be read once.
class FullPipe {
 public:
  static constexpr std::size_t kMostBytes = 65'536;  ///< what a pipe of Linux takes unread

  explicit FullPipe(std::span<const std::byte> bytes) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    read_end_ = ends[0];
    const ssize_t n = ::write(ends[1], bytes.data(), bytes.size());
    ::close(ends[1]);
    if (n != static_cast<ssize_t>(bytes.size())) throw std::runtime_error("cannot fill a pipe");
  }
  ~FullPipe() { ::close(read_end_); }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(read_end_); }

 private:
  int read_end_ = -1;
};

/// Reads a dense volume as one pass over it would, unless it is large. Streams are read whatever
/// their number of planes, since they end with their bytes; documents compute what they are asked
/// for.
inline void read_in_one_pass(VolumeReader& reader) {
  constexpr std::int64_t kMaxSamples = 1 << 20;
  if (!is_dense(reader)) return;
  const Index3 dims = volume_of(reader).lattice.dims();
  const std::int64_t plane = std::int64_t{dims[0]} * dims[1];
  if (plane > kMaxSamples) {
    spool_stream(reader, silent_progress());
    return;
  }
  if (!is_stream(reader) && plane * dims[2] > kMaxSamples) return;
  Slab slab;
  volatile unsigned sum = 0;
  const auto read_all = [&](auto& planes) {
    for (std::int32_t k = 0; k < dims[2]; ++k) {
      planes.read(k, k + 1, slab);
      sum = sum + std::to_integer<unsigned>(slab.planes.front()[0]);
    }
  };
  if (const auto* stream = std::get_if<std::unique_ptr<PlaneStream>>(&reader)) {
    read_all(**stream);
  } else {
    read_all(*std::get<std::unique_ptr<SlabReader>>(reader));
  }
}

/// Opens the bytes as they come down a pipe: by their content, and as raw samples. True: the
/// content was readable to its end. Anything but an Error of kind usage, input or limit comes out.
inline bool stream_and_read(std::span<const std::byte> bytes) {
  if (bytes.size() > FullPipe::kMostBytes) return false;
  const auto readable = [&](SourceOptions options) {
    options.streams = true;
    const FullPipe pipe(bytes);
    const std::array<std::string, 1> inputs{pipe.path()};
    try {
      Source source = open_source(inputs, options, silent_progress());
      read_in_one_pass(source.reader);
      return true;
    } catch (const Error& error) {
      if (!is_refusal(error)) throw;
      return false;
    }
  };
  SourceOptions raw;
  raw.from = "raw";
  raw.dims = {3, 2, 4};
  raw.type = SampleType::i16;
  readable(raw);
  return readable({});
}

}  // namespace mc::test
