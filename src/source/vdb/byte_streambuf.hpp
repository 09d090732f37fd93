// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <ios>
#include <span>
#include <streambuf>

// A file's bytes as what std::istream reads from.

namespace mc::source {

/// A seekable stream over bytes that are someone else's.
class ByteStreambuf final : public std::streambuf {
 public:
  explicit ByteStreambuf(std::span<const std::byte> bytes) {
    // The get area of a streambuf is char*, but nothing here writes to it.
    char* first = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    setg(first, first, first + bytes.size());
  }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir way,
                   std::ios_base::openmode which) override {
    const off_type from = way == std::ios_base::beg   ? 0
                          : way == std::ios_base::cur ? gptr() - eback()
                                                      : egptr() - eback();
    off_type to = 0;
    if (__builtin_add_overflow(from, offset, &to)) {
      return pos_type(off_type{-1});
    }
    return seekpos(pos_type(to), which);
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode /*which*/) override {
    const off_type to = position;
    if (to < 0 || to > egptr() - eback()) {
      return pos_type(off_type{-1});
    }
    setg(eback(), eback() + to, egptr());
    return position;
  }
};

}  // namespace mc::source
