// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <ios>
#include <map>
#include <optional>
#include <span>
#include <streambuf>
#include <string>
#include <vector>

#include "sink/output_file.hpp"

namespace mc::sink {

/// A seekable std::streambuf over an output file, also where that is a pipe: bytes that overwrite
/// earlier ones are kept and put in place by finish(). A pipe is spooled for it.
class RewritableStream final : public std::streambuf {
 public:
  explicit RewritableStream(OutputFile& file);

  /// 128 bits of everything written, bytes [skip_begin, skip_end) left out, as the text of a UUID
  /// of version 8 (RFC 9562: made by a rule of one's own).
  [[nodiscard]] std::string content_uuid() const;
  void overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Puts all overwritten bytes in place; the file may then be committed.
  void finish();

  /// Bytes that content_uuid() does not see. Set before anything is written.
  std::uint64_t skip_begin = 0;
  std::uint64_t skip_end = 0;

 protected:
  std::streamsize xsputn(const char* text, std::streamsize n) override;
  int_type overflow(int_type c) override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                   std::ios_base::openmode which) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override;

 private:
  void append(std::span<const std::byte> bytes);

  OutputFile& file_;
  std::optional<SpoolFile> spool_;
  std::uint64_t position_ = 0;
  std::uint64_t end_ = 0;
  std::uint64_t low_ = 0xCBF29CE484222325U;   // FNV-1a's offset basis
  std::uint64_t high_ = 0x9AE16A3B2F90404FU;  // another start for the second half
  std::map<std::uint64_t, std::vector<std::byte>> overwritten_;
};

}  // namespace mc::sink
