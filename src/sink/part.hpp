// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"

// What outputs are made of: parts (all vertices, all faces), each made of one piece a chunk.

namespace mc::sink {

/// What one chunk becomes in one part.
struct Piece {
  Buffer<std::byte> made;            ///< kept from chunk to chunk; empty where nothing must be made
  std::span<const std::byte> bytes;  ///< `made`, or memory of the chunk's
  std::uint64_t at = 0;              ///< in the file, once it is placed

  /// Takes bytes that lie ready in the chunk.
  template <class T>
  void take(const Buffer<T>& ready) {
    bytes = std::as_bytes(std::span(ready));
  }
  void take_made() { bytes = made; }
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
    end_ += piece.bytes.size();
    if (!to_->has_offsets()) to_->append(piece.bytes);
  }
  /// Writes a piece that has its place. Any thread.
  void write(const Piece& piece) const {
    if (to_->has_offsets()) to_->put_at(piece.at, piece.bytes);
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
