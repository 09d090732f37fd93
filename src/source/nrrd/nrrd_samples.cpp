// SPDX-License-Identifier: MIT
#include "source/nrrd/nrrd_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "source/stream/unpack.hpp"

namespace mc::source {

namespace {

/// Passes over lines. Returns how many there were.
std::int64_t pass_over_lines(ByteStream& stream, std::int64_t n_lines) {
  std::byte next{};
  std::int64_t n = 0;
  while (n < n_lines && stream.read({&next, 1}) == 1) {
    n += next == std::byte{'\n'} ? 1 : 0;
  }
  return n;
}

}  // namespace

Error nrrd_cut_off(const NrrdHeader& header, const std::string& place, std::uint64_t found,
                   std::uint64_t needed) {
  const Index3& d = header.dims;
  return {ErrorKind::input, place,
          fmt::format("{} bytes of samples, but {}x{}x{} {} needs {} in this file", found, d[0],
                      d[1], d[2], sample_name(*header.type), needed),
          "the file is cut off or the header's sizes and type are wrong"};
}

NrrdSamples::NrrdSamples(NrrdHeader header, std::size_t n_parts, std::uint64_t part_bytes,
                         OpenPart open, Progress& progress)
    : header_(std::move(header)),
      n_parts_(n_parts),
      part_bytes_(part_bytes),
      open_(std::move(open)),
      progress_(progress) {
  begin_part();
}

void NrrdSamples::cut_off() const {
  throw nrrd_cut_off(header_, part_.place, n_read_, part_bytes_);
}

void NrrdSamples::begin_part() {
  part_ = open_(next_part_++);
  n_read_ = 0;
  if (header_.skip_lines > 0) {
    // One byte at a time: from a buffer.
    part_.bytes = std::make_unique<PeekStream>(std::move(part_.bytes));
    const std::int64_t n = pass_over_lines(*part_.bytes, header_.skip_lines);
    if (n < header_.skip_lines) {
      throw Error(ErrorKind::input, part_.place,
                  fmt::format("{} lines to skip, but it has only {}", header_.skip_lines, n));
    }
  }
  if (header_.gzipped) {
    part_.bytes = unpacked(std::move(part_.bytes), Packing::gzip, part_.place);
  }
  const auto skip = static_cast<std::uint64_t>(header_.skip_bytes);
  if (pass_over(*part_.bytes, skip) < skip) cut_off();
}

void NrrdSamples::end_part() {
  std::byte more{};
  if (part_.bytes->read({&more, 1}) != 0) {
    progress_.warn(fmt::format("{}: what follows the samples is ignored", part_.place));
  }
}

void NrrdSamples::read(std::span<std::byte> out) {
  while (!out.empty()) {
    if (n_read_ == part_bytes_ && next_part_ < n_parts_) {
      end_part();
      begin_part();
    }
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), part_bytes_ - n_read_));
    const std::size_t n = part_.bytes->read(out.first(wanted));
    n_read_ += n;
    if (n < wanted || wanted == 0) cut_off();
    out = out.subspan(n);
  }
}

void NrrdSamples::finish() { end_part(); }

}  // namespace mc::source
