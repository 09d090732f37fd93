// SPDX-License-Identifier: MIT
#include "sink/vdb/rewritable_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

// Writers of VDB files go back to fill in where grids begin and end, a few dozen bytes a file.
// Those are kept in memory, so that everything else flows to the file in one pass, hashed on its
// way. The hash needs to be the same everywhere and to tell contents apart, not to withstand
// anyone.

namespace mc::sink {

namespace {

constexpr std::uint64_t kPrime = 0x100000001B3U;  // FNV-1a's

void mix(std::uint64_t& low, std::uint64_t& high, std::byte b) {
  low = (low ^ std::to_integer<std::uint64_t>(b)) * kPrime;
  high = (high ^ std::to_integer<std::uint64_t>(b)) * 0x9E3779B97F4A7C15U;
  high ^= high >> 29U;
}

}  // namespace

RewritableStream::RewritableStream(OutputFile& file) : file_(file) {
  if (!file.seekable()) spool_.emplace(file);
}

std::string RewritableStream::content_uuid() const {
  std::uint64_t low = low_;
  std::uint64_t high = high_;
  for (const auto& [offset, bytes] : overwritten_) {
    for (unsigned shift = 0; shift < 64; shift += 8) {
      mix(low, high, static_cast<std::byte>(offset >> shift));
    }
    for (const std::byte b : bytes) mix(low, high, b);
  }
  return fmt::format("{:08x}-{:04x}-8{:03x}-{:x}{:03x}-{:012x}", low >> 32U, low >> 16U & 0xFFFFU,
                     low & 0xFFFU, 8U + (low >> 12U & 3U), high >> 48U & 0xFFFU,
                     high & 0xFFFFFFFFFFFFU);
}

void RewritableStream::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
  overwritten_[offset].assign(bytes.begin(), bytes.end());
}

void RewritableStream::append(std::span<const std::byte> bytes) {
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const std::uint64_t at = end_ + n;
    if (at < skip_begin || at >= skip_end) mix(low_, high_, bytes[n]);
  }
  if (spool_) {
    spool_->append(bytes);
  } else {
    file_.append(bytes);
  }
  end_ += bytes.size();
}

std::streamsize RewritableStream::xsputn(const char* text, std::streamsize n) {
  std::span<const std::byte> bytes = std::as_bytes(std::span(text, static_cast<std::size_t>(n)));
  const auto n_old =
      static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), end_ - position_));
  if (n_old > 0) overwrite(position_, bytes.first(n_old));
  append(bytes.subspan(n_old));
  position_ += bytes.size();
  return n;
}

RewritableStream::int_type RewritableStream::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char text = traits_type::to_char_type(c);
  xsputn(&text, 1);
  return c;
}

RewritableStream::pos_type RewritableStream::seekoff(off_type offset, std::ios_base::seekdir from,
                                                     std::ios_base::openmode which) {
  const std::uint64_t start = from == std::ios_base::beg   ? 0
                              : from == std::ios_base::cur ? position_
                                                           : end_;
  return seekpos(static_cast<off_type>(start) + offset, which);
}

RewritableStream::pos_type RewritableStream::seekpos(pos_type position,
                                                     std::ios_base::openmode /*which*/) {
  const off_type at = position;
  if (at < 0 || static_cast<std::uint64_t>(at) > end_) return pos_type(off_type(-1));
  position_ = static_cast<std::uint64_t>(at);
  return position;
}

void RewritableStream::finish() {
  if (!spool_) {
    for (const auto& [offset, bytes] : overwritten_) file_.write_at(offset, bytes);
    return;
  }
  const std::span<const std::byte> spooled = spool_->map();
  std::size_t done = 0;
  for (const auto& [offset, bytes] : overwritten_) {
    assert(offset >= done);  // the writer fills in each place once
    file_.append(spooled.subspan(done, offset - done));
    file_.append(std::span<const std::byte>(bytes));
    done = offset + bytes.size();
  }
  file_.append(spooled.subspan(done));
}

}  // namespace mc::sink
