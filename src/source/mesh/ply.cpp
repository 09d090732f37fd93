// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/checked.hpp"
#include "source/mesh/mesh_input.hpp"
#include "source/mesh/text_cursor.hpp"

// PLY: a header that declares elements and their properties, then their values in that order, as
// text or as numbers of either byte order. One loop reads both, over a body that knows how a value
// is stored. Every count is held against the bytes that are left before anything is reserved.

namespace mc::source {

namespace {

constexpr std::size_t kMostElements = 256;  // no real file comes near

enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::optional<Scalar> scalar_named(std::string_view name) {
  struct Entry {
    std::string_view name;
    Scalar type;
  };
  constexpr std::array kNames = {
      Entry{"char", Scalar::i8},     Entry{"int8", Scalar::i8},    Entry{"uchar", Scalar::u8},
      Entry{"uint8", Scalar::u8},    Entry{"short", Scalar::i16},  Entry{"int16", Scalar::i16},
      Entry{"ushort", Scalar::u16},  Entry{"uint16", Scalar::u16}, Entry{"int", Scalar::i32},
      Entry{"int32", Scalar::i32},   Entry{"uint", Scalar::u32},   Entry{"uint32", Scalar::u32},
      Entry{"int64", Scalar::i64},   Entry{"uint64", Scalar::u64}, Entry{"float", Scalar::f32},
      Entry{"float32", Scalar::f32}, Entry{"double", Scalar::f64}, Entry{"float64", Scalar::f64}};
  const auto* const found = std::ranges::find(kNames, name, &Entry::name);
  return found == kNames.end() ? std::nullopt : std::optional(found->type);
}

constexpr bool is_real(Scalar type) { return type == Scalar::f32 || type == Scalar::f64; }

constexpr std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string_view name;
  Scalar type{};
  std::optional<Scalar> count;  // of a list
};

struct Element {
  std::string_view name;
  std::uint64_t n = 0;
  std::vector<Property> properties;
};

struct Header {
  bool text = false;
  std::endian order = std::endian::little;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes, to the first of the body
};

class HeaderReader {
 public:
  explicit HeaderReader(const MeshInput& input) : cursor_(input, TextCursor::Words::within_line) {}

  Header read() {
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
    Element element;
    element.name = cursor_.word();
    if (std::ranges::find(header_.elements, element.name, &Element::name) !=
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

  Scalar read_type(std::string_view word) {
    const std::optional<Scalar> type = scalar_named(word);
    if (!type) {
      cursor_.fail("expected a type such as float, double, uchar or int");
    }
    return *type;
  }

  void read_property() {
    if (header_.elements.empty()) {
      cursor_.fail("expected an element before its properties");
    }
    Property property;
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
  Header header_;
};

/// Values as text.
class TextBody {
 public:
  TextBody(const MeshInput& input, const Header& header)
      : cursor_(input, TextCursor::Words::across_lines, header.size) {}

  double real(Scalar type) {
    switch (type) {
      case Scalar::f32:
        return double{cursor_.number<float>(kValue)};
      case Scalar::f64:
        return cursor_.number<double>(kValue);
      default:
        return static_cast<double>(cursor_.number<std::int64_t>(kValue));
    }
  }

  /// Negative numbers come out past 2^63.
  std::uint64_t integer(Scalar type) {
    return type == Scalar::u64 ? cursor_.number<std::uint64_t>(kValue)
                               : static_cast<std::uint64_t>(cursor_.number<std::int64_t>(kValue));
  }

  void skip(Scalar /*type*/) {
    if (cursor_.word().empty()) {
      cursor_.fail(kValue);
    }
  }

  [[noreturn]] void fail(std::string_view fault) const { cursor_.fail(fault); }
  [[nodiscard]] std::size_t bytes_left() const { return cursor_.bytes_left(); }
  static std::size_t least_size(Scalar /*type*/) { return 1; }

  void finish() {
    if (!cursor_.at_end()) {
      cursor_.fail("expected nothing after the last element");
    }
  }

 private:
  static constexpr std::string_view kValue = "the value of a property";
  TextCursor cursor_;
};

/// Values as the machine has them.
class BinaryBody {
 public:
  BinaryBody(const MeshInput& input, const Header& header)
      : input_(input), order_(header.order), at_(header.size) {}

  double real(Scalar type) { return as<double>(type); }

  std::uint64_t integer(Scalar type) { return as<std::uint64_t>(type); }

  void skip(Scalar type) { take(size_of(type)); }

  [[noreturn]] void fail(std::string_view fault) const { fault_at_byte(input_, at_, fault); }
  [[nodiscard]] std::size_t bytes_left() const { return input_.bytes.size() - at_; }
  static std::size_t least_size(Scalar type) { return size_of(type); }

  void finish() const {
    if (bytes_left() > 0) {
      fail(std::to_string(bytes_left()) + " bytes more than the header declares");
    }
  }

 private:
  const std::byte* take(std::size_t n_bytes) {
    if (bytes_left() < n_bytes) {
      fail("the file ends early: expected the value of a property");
    }
    const std::byte* const value = input_.bytes.data() + at_;
    at_ += n_bytes;
    return value;
  }

  template <class To>
  To as(Scalar type) {
    const std::byte* const value = take(size_of(type));
    switch (type) {
      case Scalar::i8:
        return static_cast<To>(load<std::int8_t>(value, order_));
      case Scalar::u8:
        return static_cast<To>(load<std::uint8_t>(value, order_));
      case Scalar::i16:
        return static_cast<To>(load<std::int16_t>(value, order_));
      case Scalar::u16:
        return static_cast<To>(load<std::uint16_t>(value, order_));
      case Scalar::i32:
        return static_cast<To>(load<std::int32_t>(value, order_));
      case Scalar::u32:
        return static_cast<To>(load<std::uint32_t>(value, order_));
      case Scalar::i64:
        return static_cast<To>(load<std::int64_t>(value, order_));
      case Scalar::u64:
        return static_cast<To>(load<std::uint64_t>(value, order_));
      case Scalar::f32:
        return static_cast<To>(load<float>(value, order_));
      case Scalar::f64:
        break;
    }
    return static_cast<To>(load<double>(value, order_));
  }

  const MeshInput& input_;
  std::endian order_;
  std::size_t at_;
};

/// Where the value of a vertex property goes: x, y, z, nx, ny, nz, or nowhere.
constexpr std::array<std::string_view, 6> kVertexNames = {"x", "y", "z", "nx", "ny", "nz"};
constexpr std::size_t kNowhere = kVertexNames.size();

std::size_t slot_of(const Property& property) {
  const auto* const found = std::ranges::find(kVertexNames, property.name);
  return property.count ? kNowhere : static_cast<std::size_t>(found - kVertexNames.begin());
}

bool is_face_list(const Property& property) {
  return property.count && !is_real(property.type) &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

template <class Body>
class BodyReader {
 public:
  BodyReader(const MeshInput& input, const Header& header) : body_(input, header) {}

  MeshSoup read(const Header& header) {
    for (const Element& element : header.elements) {
      expect_room(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else {
        skip(element);
      }
    }
    body_.finish();
    return std::move(soup_);
  }

 private:
  /// Refuses a count that the rest of the file cannot hold.
  void expect_room(const Element& element) {
    std::uint64_t least = 0;
    for (const Property& property : element.properties) {
      least += Body::least_size(property.count.value_or(property.type));
    }
    const std::optional<std::uint64_t> needed = base::checked_mul(element.n, least);
    if (!needed || *needed > body_.bytes_left()) {
      body_.fail("the file ends early: " + std::to_string(element.n) + " elements '" +
                 std::string(element.name.substr(0, 24)) + "' of " + std::to_string(least) +
                 " bytes or more are declared, but " + std::to_string(body_.bytes_left()) +
                 " bytes are left");
    }
  }

  void read_vertices(const Element& element) {
    std::array<bool, kNowhere + 1> has{};
    std::vector<std::size_t> slots;
    for (const Property& property : element.properties) {
      slots.push_back(slot_of(property));
      has[slots.back()] = true;
    }
    if (!(has[0] && has[1] && has[2])) {
      if (element.n > 0) {
        body_.fail("vertices without coordinates: expected properties x, y and z");
      }
      return;
    }
    const bool normals = has[3] && has[4] && has[5];
    soup_.positions.reserve(element.n);
    soup_.normals.reserve(normals ? element.n : 0);
    std::array<double, kNowhere + 1> values{};
    for (std::uint64_t v = 0; v < element.n; ++v) {
      for (std::size_t p = 0; p < slots.size(); ++p) {
        const Property& property = element.properties[p];
        if (slots[p] == kNowhere) {
          skip(property);
        } else {
          values[slots[p]] = body_.real(property.type);
        }
      }
      soup_.positions.push_back({values[0], values[1], values[2]});
      if (normals) {
        soup_.normals.push_back({static_cast<float>(values[3]), static_cast<float>(values[4]),
                                 static_cast<float>(values[5])});
      }
    }
  }

  void read_faces(const Element& element) {
    const auto list = std::ranges::find_if(element.properties, is_face_list);
    if (list == element.properties.end()) {
      if (element.n > 0) {
        body_.fail("faces without vertices: expected a list vertex_indices of whole numbers");
      }
      return;
    }
    soup_.triangles.reserve(element.n);
    for (std::uint64_t f = 0; f < element.n; ++f) {
      for (const Property& property : element.properties) {
        if (&property == &*list) {
          read_face(property);
        } else {
          skip(property);
        }
      }
    }
  }

  void read_face(const Property& property) {
    const std::uint64_t n_corners = body_.integer(*property.count);
    if (n_corners < 3) {
      body_.fail("a face of " + std::to_string(n_corners) + " vertices: expected three or more");
    }
    Fan fan(soup_);
    for (std::uint64_t c = 0; c < n_corners; ++c) {
      fan.add(body_.integer(property.type));
    }
  }

  void skip(const Property& property) {
    const std::uint64_t n = property.count ? body_.integer(*property.count) : 1;
    for (std::uint64_t value = 0; value < n; ++value) {
      body_.skip(property.type);
    }
  }

  void skip(const Element& element) {
    const std::uint64_t n = element.properties.empty() ? 0 : element.n;
    for (std::uint64_t e = 0; e < n; ++e) {
      for (const Property& property : element.properties) {
        skip(property);
      }
    }
  }

  Body body_;
  MeshSoup soup_;
};

}  // namespace

MeshSoup read_ply(const MeshInput& input) {
  const Header header = HeaderReader(input).read();
  return header.text ? BodyReader<TextBody>(input, header).read(header)
                     : BodyReader<BinaryBody>(input, header).read(header);
}

}  // namespace mc::source
