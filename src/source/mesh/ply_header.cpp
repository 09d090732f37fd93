// SPDX-License-Identifier: MIT
#include "source/mesh/ply_header.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "source/mesh/text_cursor.hpp"

namespace mc::source {

namespace {

constexpr std::size_t kMostElements = 256;  // no real file comes near

std::optional<PlyType> scalar_named(std::string_view name) {
  struct Entry {
    std::string_view name;
    PlyType type;
  };
  constexpr std::array kNames = {Entry{"char", PlyType::i8},    Entry{"int8", PlyType::i8},
                                 Entry{"uchar", PlyType::u8},   Entry{"uint8", PlyType::u8},
                                 Entry{"short", PlyType::i16},  Entry{"int16", PlyType::i16},
                                 Entry{"ushort", PlyType::u16}, Entry{"uint16", PlyType::u16},
                                 Entry{"int", PlyType::i32},    Entry{"int32", PlyType::i32},
                                 Entry{"uint", PlyType::u32},   Entry{"uint32", PlyType::u32},
                                 Entry{"int64", PlyType::i64},  Entry{"uint64", PlyType::u64},
                                 Entry{"float", PlyType::f32},  Entry{"float32", PlyType::f32},
                                 Entry{"double", PlyType::f64}, Entry{"float64", PlyType::f64}};
  const auto* const found = std::ranges::find(kNames, name, &Entry::name);
  return found == kNames.end() ? std::nullopt : std::optional(found->type);
}

class HeaderReader {
 public:
  explicit HeaderReader(const MeshInput& input) : cursor_(input, TextCursor::Words::within_line) {}

  PlyHeader read() {
    cursor_.skip_line();  // "ply"
    bool has_format = false;
    for (;;) {
      const std::string_view keyword = cursor_.word();
      if (keyword == "end_header") {
        break;
      }
      if (keyword == "format") {
        read_format();
        has_format = true;
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else if (keyword != "comment" && keyword != "obj_info") {
        cursor_.fail("expected a line of a ply header: element, property or end_header");
      }
      cursor_.skip_line();
    }
    if (!has_format) {
      cursor_.fail("expected a line 'format' before it");
    }
    if (!cursor_.skip_line()) {
      cursor_.fail("expected a line's end and the data behind it");
    }
    header_.size = cursor_.offset();
    return std::move(header_);
  }

 private:
  void read_format() {
    const std::string_view format = cursor_.word();
    if (format == "ascii") {
      header_.text = true;
    } else if (format == "binary_big_endian") {
      header_.order = std::endian::big;
    } else if (format != "binary_little_endian") {
      cursor_.fail("expected ascii, binary_little_endian or binary_big_endian");
    }
    if (cursor_.word() != "1.0") {
      cursor_.fail("expected version 1.0");
    }
  }

  void read_element() {
    PlyElement element;
    element.name = cursor_.word();
    if (std::ranges::find(header_.elements, element.name, &PlyElement::name) !=
        header_.elements.end()) {
      cursor_.fail("expected an element that was not declared yet");
    }
    if (header_.elements.size() == kMostElements) {
      cursor_.fail("expected at most " + std::to_string(kMostElements) + " elements");
    }
    element.n = cursor_.number<std::uint64_t>("the count of an element");
    if (element.name == "tristrips" && element.n > 0) {
      cursor_.fail("triangle strips are not read: expected faces");
    }
    header_.elements.push_back(std::move(element));
  }

  PlyType read_type(std::string_view word) {
    const std::optional<PlyType> type = scalar_named(word);
    if (!type) {
      cursor_.fail("expected a type such as float, double, uchar or int");
    }
    return *type;
  }

  void read_property() {
    if (header_.elements.empty()) {
      cursor_.fail("expected an element before its properties");
    }
    PlyProperty property;
    std::string_view word = cursor_.word();
    if (word == "list") {
      property.count = read_type(cursor_.word());
      if (is_real(*property.count)) {
        cursor_.fail("expected a whole-number type for the length of a list");
      }
      word = cursor_.word();
    }
    property.type = read_type(word);
    property.name = cursor_.word();
    if (property.name.empty()) {
      cursor_.fail("expected the name of a property");
    }
    header_.elements.back().properties.push_back(property);
  }

  TextCursor cursor_;
  PlyHeader header_;
};

}  // namespace

PlyHeader read_ply_header(const MeshInput& input) { return HeaderReader(input).read(); }

}  // namespace mc::source
