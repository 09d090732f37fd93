// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"

// The text header of a NRRD file, as data: what a header may say is told apart here, whether its
// samples are there is told by the reader. Format: "Definition of NRRD File Format", versions 1-5,
// of the Teem library.

namespace mc::source {

/// `data file: LIST`, `data file: quarter.%d 1 93 1`, or one name.
struct NrrdDataFiles {
  std::vector<std::string> names;  ///< a single name or LIST's lines
  std::string pattern;             ///< printf-like, with one %d; else empty
  std::int64_t first = 0, last = 0, step = 1;
  std::optional<std::int64_t> axes_per_file;  ///< the trailing "subdim"
};

struct NrrdHeader {
  std::size_t size_bytes = 0;  ///< of the header; attached samples begin here
  std::optional<SampleType> type;
  Index3 dims{};
  bool leading_axis = false;  ///< a fourth, leading axis of one sample was dropped
  std::optional<std::endian> endian;
  bool gzipped = false;         ///< encoding: gzip; byte skip then counts unpacked bytes
  std::int64_t skip_bytes = 0;  ///< -1: the samples are the last bytes of the file
  std::int64_t skip_lines = 0;
  std::optional<NrrdDataFiles> data_files;  ///< set: the header is detached
  Affine to_world;
  Frame frame = Frame::none;
  Units units = Units::unknown;
  std::map<std::string, std::string, std::less<>> pairs;  ///< "key:=value"
  std::vector<std::string> unknown_fields;
};

/// Parses the header at the front of `text`, all of it refused by name where it cannot be read
/// right: encodings other than raw and gzip, 64-bit unsigned and block types, vectors, planes or
/// movies. Errors   input, as "PLACE:LINE: ...".
NrrdHeader parse_nrrd_header(std::string_view text, const std::string& place);

/// A pattern as printf takes it, with one conversion %d, %i or %u with optional zero, width and
/// minus.
class NrrdPattern {
 public:
  /// nullopt: it is none.
  static std::optional<NrrdPattern> parse(std::string_view text);
  [[nodiscard]] std::string name(std::int64_t n) const;

 private:
  std::string before_, after_;
  std::size_t width_ = 0;
  bool zeros_ = false, left_ = false;
};

}  // namespace mc::source
