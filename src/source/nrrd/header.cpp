// SPDX-License-Identifier: MIT
#include "source/nrrd/header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/text.hpp"
#include "source/nrrd/fields.hpp"
#include "source/placement.hpp"
#include "source/text.hpp"

// Lines become fields first; then the fields that must hold are looked at in the order in which a
// person would ask: how many samples of what, in which files, and where in the world.

namespace mc::source {

namespace {

/// One axis of size 1 may lead (a scalar "component" axis); everything else has three.
std::size_t leading_axes(const NrrdFields& fields, const std::vector<std::int64_t>& sizes) {
  if (sizes.size() == 3) {
    return 0;
  }
  if (sizes.size() == 4 && sizes.front() == 1) {
    return 1;
  }
  fields.fail("dimension", fmt::format("{} axes ({}), but a volume of three was expected",
                                       sizes.size(), fmt::join(sizes, " ")));
}

std::vector<std::int64_t> parse_sizes(const NrrdFields& fields) {
  const auto dimension = parse_integers(fields.required("dimension"));
  if (!dimension || dimension->size() != 1 || dimension->front() < 1 || dimension->front() > 16) {
    fields.fail("dimension", "a number from 1 to 16 was expected");
  }
  const auto sizes = parse_integers(fields.required("sizes"));
  if (!sizes || std::cmp_not_equal(sizes->size(), dimension->front())) {
    fields.fail("sizes", fmt::format("{} whole numbers were expected", dimension->front()));
  }
  return *sizes;
}

void set_dims(const NrrdFields& fields, NrrdHeader& header) {
  const std::vector<std::int64_t> sizes = parse_sizes(fields);
  const std::size_t lead = leading_axes(fields, sizes);
  header.leading_axis = lead == 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t n = sizes[lead + axis];
    if (n < 2 || n > std::numeric_limits<std::int32_t>::max()) {
      fields.fail("sizes", fmt::format("{} samples along an axis, but 2 to {} were expected", n,
                                       std::numeric_limits<std::int32_t>::max()));
    }
    header.dims[axis] = static_cast<std::int32_t>(n);
  }
}

/// A first axis that holds the components of a vector or a colour is no axis of a volume.
void check_kinds(const NrrdFields& fields, const NrrdHeader& header) {
  const std::optional<std::string> kinds = fields.find("kinds");
  if (!kinds) {
    return;
  }
  std::vector<std::string> words = split_words(*kinds);
  if (header.leading_axis && !words.empty()) {
    words.erase(words.begin());
  }
  for (const std::string& kind : words) {
    for (const char* refused : {"vector", "color", "matrix", "complex", "quaternion", "normal",
                                "gradient", "covariant", "tensor"}) {
      if (kind.find(refused) != std::string::npos) {
        fields.fail("kinds",
                    fmt::format("an axis of kind {}, but only scalar volumes can be read", kind));
      }
    }
  }
}

std::optional<SampleType> type_named(const std::string& name) {
  using enum SampleType;
  static const std::map<std::string, SampleType, std::less<>> kTypes{{"signed char", i8},
                                                                     {"int8", i8},
                                                                     {"int8_t", i8},
                                                                     {"uchar", u8},
                                                                     {"unsigned char", u8},
                                                                     {"uint8", u8},
                                                                     {"uint8_t", u8},
                                                                     {"short", i16},
                                                                     {"short int", i16},
                                                                     {"signed short", i16},
                                                                     {"signed short int", i16},
                                                                     {"int16", i16},
                                                                     {"int16_t", i16},
                                                                     {"ushort", u16},
                                                                     {"unsigned short", u16},
                                                                     {"unsigned short int", u16},
                                                                     {"uint16", u16},
                                                                     {"uint16_t", u16},
                                                                     {"int", i32},
                                                                     {"signed int", i32},
                                                                     {"int32", i32},
                                                                     {"int32_t", i32},
                                                                     {"uint", u32},
                                                                     {"unsigned int", u32},
                                                                     {"uint32", u32},
                                                                     {"uint32_t", u32},
                                                                     {"longlong", i64},
                                                                     {"long long", i64},
                                                                     {"long long int", i64},
                                                                     {"signed long long", i64},
                                                                     {"signed long long int", i64},
                                                                     {"int64", i64},
                                                                     {"int64_t", i64},
                                                                     {"half", f16},
                                                                     {"float16", f16},
                                                                     {"float", f32},
                                                                     {"float32", f32},
                                                                     {"double", f64},
                                                                     {"float64", f64}};
  const auto at = kTypes.find(name);
  return at == kTypes.end() ? std::nullopt : std::optional(at->second);
}

void set_type(const NrrdFields& fields, NrrdHeader& header) {
  const std::string name = base::lower_case(fields.required("type"));
  header.type = type_named(name);
  if (!header.type) {
    fields.fail("type", fmt::format("samples of type {} cannot be read: 8- to 64-bit integers "
                                    "(not unsigned 64-bit), float and double can",
                                    quoted_text(name)));
  }
  if (const auto endian = fields.find("endian")) {
    const std::string order = base::lower_case(*endian);
    if (order != "little" && order != "big") {
      fields.fail("endian", "little or big was expected");
    }
    header.endian = order == "little" ? std::endian::little : std::endian::big;
  } else if (sample_size(*header.type) > 1) {
    fields.fail("endian", fmt::format("missing, but {} has more than one byte", name));
  }
}

void set_encoding(const NrrdFields& fields, NrrdHeader& header) {
  const std::string encoding = base::lower_case(fields.required("encoding"));
  header.gzipped = encoding == "gzip" || encoding == "gz";
  if (!header.gzipped && encoding != "raw") {
    fields.fail("encoding",
                fmt::format("{} samples are not supported by this version, only raw and gzip",
                            quoted_text(encoding)),
                "convert the file, for example with: unu save -f nrrd -e raw -i IN -o OUT");
  }
}

std::int64_t whole_number(const NrrdFields& fields, std::string_view name, std::int64_t least) {
  const std::optional<std::string> text = fields.find(name);
  if (!text) {
    return 0;
  }
  const auto number = parse_integers(*text);
  if (!number || number->size() != 1 || number->front() < least) {
    fields.fail(name, fmt::format("a whole number, at least {}, was expected", least));
  }
  return number->front();
}

/// "NAME", "LIST [subdim]" (names follow line by line) or "PATTERN MIN MAX STEP [subdim]".
void set_data_files(const NrrdFields& fields, NrrdHeader& header) {
  const std::optional<std::string> text = fields.find("data file");
  if (!text) {
    return;
  }
  NrrdDataFiles files;
  const std::vector<std::string> words = split_words(*text);
  if (words.empty()) {
    fields.fail("data file", "a name was expected");
  }
  const auto numbers =
      parse_integers(text->substr(text->find(words.front()) + words.front().size()));
  if (words.front() == "LIST") {
    if (words.size() > 2 || !numbers) {
      fields.fail("data file", "LIST, or LIST and a number of axes, was expected");
    }
    files.names = fields.list_after_data_file();
    if (words.size() == 2) {
      files.axes_per_file = numbers->front();
    }
  } else if (numbers && (numbers->size() == 3 || numbers->size() == 4)) {
    files.pattern = words.front();
    files.first = (*numbers)[0];
    files.last = (*numbers)[1];
    files.step = (*numbers)[2];
    if (numbers->size() == 4) {
      files.axes_per_file = (*numbers)[3];
    }
  } else {
    files.names = {*text};
  }
  header.data_files = std::move(files);
}

}  // namespace

std::optional<NrrdPattern> NrrdPattern::parse(std::string_view text) {
  const std::size_t percent = text.find('%');
  if (percent == std::string_view::npos) {
    return std::nullopt;
  }
  NrrdPattern out;
  std::size_t at = percent + 1;
  for (; at < text.size() && (text[at] == '0' || text[at] == '-'); ++at) {
    out.zeros_ = out.zeros_ || text[at] == '0';
    out.left_ = out.left_ || text[at] == '-';
  }
  for (; at < text.size() && text[at] >= '0' && text[at] <= '9' && out.width_ < 100; ++at) {
    out.width_ = 10 * out.width_ + static_cast<std::size_t>(text[at] - '0');
  }
  const bool conversion =
      at < text.size() && std::string_view("diu").find(text[at]) != std::string_view::npos;
  if (!conversion || out.width_ > 99 || text.find('%', at) != std::string_view::npos) {
    return std::nullopt;
  }
  out.before_ = text.substr(0, percent);
  out.after_ = text.substr(at + 1);
  return out;
}

std::string NrrdPattern::name(std::int64_t n) const {
  const std::string number = left_    ? fmt::format("{:<{}}", n, width_)
                             : zeros_ ? fmt::format("{:0{}}", n, width_)
                                      : fmt::format("{:{}}", n, width_);
  return before_ + number + after_;
}

NrrdHeader parse_nrrd_header(std::string_view text, const std::string& place) {
  const NrrdFields fields(text, place);
  NrrdHeader header;
  header.size_bytes = fields.size_bytes();
  header.unknown_fields = fields.unknown();
  header.pairs = fields.pairs();
  set_dims(fields, header);
  check_kinds(fields, header);
  set_type(fields, header);
  set_encoding(fields, header);
  header.skip_lines = whole_number(fields, "line skip", 0);
  header.skip_bytes = whole_number(fields, "byte skip", header.gzipped ? 0 : -1);
  set_data_files(fields, header);
  set_nrrd_placement(fields, header);
  return header;
}

}  // namespace mc::source
