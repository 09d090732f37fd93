// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

// Moves what chunks are made of to where a mesh keeps it; compiled for every SIMD target.

namespace mc::mesh {

/// How words are stored: by way of the caches, or past them, which is faster where nobody reads
/// them soon, and leaves the caches to who can use them.
enum class Stores : std::uint8_t { cached, streamed };

/// to[i] = from[i] + add for n words of 32 bits (add 0 moves floats). Aligned as words are. What
/// was streamed is visible to who sees a later release of this thread.
void move_words(const void* from, std::size_t n, std::uint32_t add, void* to, Stores stores);

}  // namespace mc::mesh
