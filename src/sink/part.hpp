// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"
#include "sink/records.hpp"

// What outputs are made of: parts (all vertices, all faces), each made of one piece a chunk. The
// bytes of a piece lie ready in the chunk, or are made at once, or, if they are records whose size
// is known before, are made block by block while they are written: a block stays in the cache.

namespace mc::sink {

/// What one chunk becomes in one part.
struct Piece {
  Buffer<std::byte> made;            ///< memory that is used again: all bytes, or one block
  std::span<const std::byte> bytes;  ///< `made` or memory of the chunk; empty if not made yet
  std::uint64_t n_bytes = 0;
  std::uint64_t at = 0;  ///< in the file, once it is placed

  /// Takes bytes that lie ready in the chunk.
  template <class T>
  void take(const Buffer<T>& ready) {
    bytes = std::as_bytes(std::span(ready));
    n_bytes = bytes.size();
  }
  void take_made() { take(made); }
  /// Says how many bytes there will be.
  void announce(std::uint64_t n) {
    bytes = {};
    n_bytes = n;
  }
};

/// A part of a file that can seek, to be filled from any thread; or of a stream, filled in order.
class Part {
 public:
  /// From `offset` of `to` on. A stream goes on where it is.
  Part(FileWriter& to, std::uint64_t offset) : to_(&to), begin_(offset), end_(offset) {
    to.flush();
  }

  [[nodiscard]] std::uint64_t size() const { return end_ - begin_; }
  /// Puts `piece` behind those before it; a stream gets its bytes now. One at a time, in order.
  void place(Piece& piece) {
    piece.at = end_;
    end_ += piece.n_bytes;
    if (!to_->has_offsets()) to_->append(piece.bytes);
  }
  /// Writes a piece that has its place. Any thread.
  void write(const Piece& piece) const {
    if (to_->has_offsets()) to_->put_at(piece.at, piece.bytes);
  }

  /// Makes n records of `stride` bytes for a stream; to a file, where write_records() makes them,
  /// announces them. `encode` is that of make_records(), and the same in both calls. Any thread.
  template <class Encode>
  void format_records(std::size_t n, std::size_t stride, Piece& piece, Encode encode) const {
    if (to_->has_offsets()) return piece.announce(std::uint64_t{n} * stride);
    make_records(0, n, stride, piece.made, encode);
    piece.take_made();
  }
  /// Makes and writes the records of a piece that has its place. Any thread.
  template <class Encode>
  void write_records(std::size_t n, std::size_t stride, Piece& piece, Encode encode) const {
    if (!to_->has_offsets()) return;
    const std::size_t n_at_once = kBlockBytes / stride;
    for (std::size_t first = 0; first < n; first += n_at_once) {
      make_records(first, std::min(n, first + n_at_once), stride, piece.made, encode);
      to_->put_at(piece.at + std::uint64_t{first} * stride, piece.made);
    }
  }
  /// Ends the part: the file goes on behind it. All is written.
  void end() {
    if (to_->has_offsets()) to_->skip(size());
  }

 private:
  FileWriter* to_;
  std::uint64_t begin_, end_;
};

}  // namespace mc::sink
