// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

// Plain walks over memory, compiled for every SIMD target. One thread each.

namespace mc::cli {

/// Bytes that read_eight_streams() takes at a time: eight pages.
inline constexpr std::size_t kStreamBlock = 8 * 4096;

/// Each returns a value that depends on all it read. n_bytes is a multiple of kStreamBlock, `data`
/// of the alignment of a cache line.
std::uint64_t read_one_stream(const std::byte* data, std::size_t n_bytes);
/// A line of each of eight neighbouring pages in turn.
std::uint64_t read_eight_streams(const std::byte* data, std::size_t n_bytes);
/// Non-temporal stores where the target has them.
void write_past_cache(std::byte* data, std::size_t n_bytes);

}  // namespace mc::cli
