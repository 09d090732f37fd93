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

/// Reads a dense volume as one pass over it would. Documents compute what they are asked for, so
/// that they are read where they are small.
inline void pass_by(SlabReader& reader) {
  constexpr std::int64_t kMostSamples = 1 << 20;
  const Index3 dims = reader.volume().lattice.dims();
  const std::int64_t plane = std::int64_t{dims[0]} * dims[1];
  if (reader.reads_once() && plane > kMostSamples) reader.keep_planes(silent_progress());
  if (plane > kMostSamples || (!reader.reads_once() && plane * dims[2] > kMostSamples)) return;
  Slab slab;
  volatile unsigned sum = 0;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    reader.read(k, k + 1, slab);
    sum = sum + std::to_integer<unsigned>(slab.planes.front()[0]);
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
      if (auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&source.reader)) pass_by(**dense);
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
