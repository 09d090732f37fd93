// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "mc/base.hpp"
#include "source/nrrd/header.hpp"
#include "source/stream/byte_stream.hpp"
#include "source/stream/streamed_planes.hpp"

// The samples of NRRD files that pass by: of one after another, unpacked where the header says so.

namespace mc::source {

/// One data file, or what follows an attached header.
struct NrrdPart {
  std::string place;
  std::unique_ptr<ByteStream> bytes;  ///< from the end of its header on
};

class NrrdSamples final : public SampleStream {
 public:
  using OpenPart = std::function<NrrdPart(std::size_t n)>;

  /// Parts 0 to n_parts - 1 hold `part_bytes` of samples each.
  NrrdSamples(NrrdHeader header, std::size_t n_parts, std::uint64_t part_bytes, OpenPart open,
              Progress& progress);

  void read(std::span<std::byte> out) override;
  void finish() override;
  [[nodiscard]] const std::string& place() const override { return part_.place; }

 private:
  void begin_part();
  void end_part();
  [[noreturn]] void cut_off() const;

  NrrdHeader header_;
  std::size_t n_parts_;
  std::uint64_t part_bytes_;
  OpenPart open_;
  Progress& progress_;
  NrrdPart part_;
  std::size_t next_part_ = 0;
  std::uint64_t n_read_ = 0;  ///< of the part
};

/// "head.raw: 7 bytes of samples, but 2x2x2 u8 needs 8 in this file".
[[nodiscard]] Error nrrd_cut_off(const NrrdHeader& header, const std::string& place,
                                 std::uint64_t found, std::uint64_t needed);

}  // namespace mc::source
