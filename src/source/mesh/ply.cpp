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
#include "source/mesh/ply_header.hpp"
#include "source/mesh/text_cursor.hpp"

// PLY: a header that declares elements and their properties, then their values in that order, as
// text or as numbers of either byte order. One loop reads both, over a body that knows how a value
// is stored. Every count is held against the bytes that are left before anything is reserved.

namespace mc::source {

namespace {

/// Values as text.
class TextBody {
 public:
  TextBody(const MeshInput& input, const PlyHeader& header)
      : cursor_(input, TextCursor::Words::across_lines, header.size) {}

  double real(PlyType type) {
    switch (type) {
      case PlyType::f32:
        return double{cursor_.number<float>(kValue)};
      case PlyType::f64:
        return cursor_.number<double>(kValue);
      default:
        return static_cast<double>(cursor_.number<std::int64_t>(kValue));
    }
  }

  /// Negative numbers come out past 2^63.
  std::uint64_t integer(PlyType type) {
    return type == PlyType::u64 ? cursor_.number<std::uint64_t>(kValue)
                                : static_cast<std::uint64_t>(cursor_.number<std::int64_t>(kValue));
  }

  void skip(PlyType /*type*/) {
    if (cursor_.word().empty()) {
      cursor_.fail(kValue);
    }
  }

  [[noreturn]] void fail(std::string_view fault) const { cursor_.fail(fault); }
  [[nodiscard]] std::size_t bytes_left() const { return cursor_.bytes_left(); }
  static std::size_t least_size(PlyType /*type*/) { return 1; }

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
  BinaryBody(const MeshInput& input, const PlyHeader& header)
      : input_(input), order_(header.order), at_(header.size) {}

  double real(PlyType type) { return as<double>(type); }

  std::uint64_t integer(PlyType type) { return as<std::uint64_t>(type); }

  void skip(PlyType type) { take(size_of(type)); }

  [[noreturn]] void fail(std::string_view fault) const { fault_at_byte(input_, at_, fault); }
  [[nodiscard]] std::size_t bytes_left() const { return input_.bytes.size() - at_; }
  static std::size_t least_size(PlyType type) { return size_of(type); }

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
  To as(PlyType type) {
    const std::byte* const value = take(size_of(type));
    switch (type) {
      case PlyType::i8:
        return static_cast<To>(load<std::int8_t>(value, order_));
      case PlyType::u8:
        return static_cast<To>(load<std::uint8_t>(value, order_));
      case PlyType::i16:
        return static_cast<To>(load<std::int16_t>(value, order_));
      case PlyType::u16:
        return static_cast<To>(load<std::uint16_t>(value, order_));
      case PlyType::i32:
        return static_cast<To>(load<std::int32_t>(value, order_));
      case PlyType::u32:
        return static_cast<To>(load<std::uint32_t>(value, order_));
      case PlyType::i64:
        return static_cast<To>(load<std::int64_t>(value, order_));
      case PlyType::u64:
        return static_cast<To>(load<std::uint64_t>(value, order_));
      case PlyType::f32:
        return static_cast<To>(load<float>(value, order_));
      case PlyType::f64:
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

std::size_t slot_of(const PlyProperty& property) {
  const auto* const found = std::ranges::find(kVertexNames, property.name);
  return property.count ? kNowhere : static_cast<std::size_t>(found - kVertexNames.begin());
}

/// Whether x, y and z are all single precision.
bool has_single_positions(const PlyElement& vertex) {
  return std::ranges::all_of(vertex.properties, [](const PlyProperty& property) {
    return slot_of(property) > 2 || property.type == PlyType::f32;
  });
}

bool is_face_list(const PlyProperty& property) {
  return property.count && !is_real(property.type) &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

template <class Body>
class BodyReader {
 public:
  BodyReader(const MeshInput& input, const PlyHeader& header) : body_(input, header) {}

  Mesh read(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
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
    return std::move(mesh_);
  }

 private:
  /// Refuses a count that the rest of the file cannot hold.
  void expect_room(const PlyElement& element) {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties) {
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

  void read_vertices(const PlyElement& element) {
    std::array<bool, kNowhere + 1> has{};
    std::vector<std::size_t> slots;
    for (const PlyProperty& property : element.properties) {
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
    mesh_.normals.reserve(normals ? element.n : 0);
    if (has_single_positions(element)) {
      read_vertices(element, slots, normals, mesh_.positions);
    } else {
      read_vertices(element, slots, normals, mesh_.positions_f64);
    }
  }

  template <class T>
  void read_vertices(const PlyElement& element, const std::vector<std::size_t>& slots, bool normals,
                     Buffer<std::array<T, 3>>& positions) {
    positions.reserve(element.n);
    std::array<double, kNowhere + 1> values{};
    for (std::uint64_t v = 0; v < element.n; ++v) {
      for (std::size_t p = 0; p < slots.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (slots[p] == kNowhere) {
          skip(property);
        } else {
          values[slots[p]] = body_.real(property.type);
        }
      }
      positions.push_back(
          {static_cast<T>(values[0]), static_cast<T>(values[1]), static_cast<T>(values[2])});
      if (normals) {
        mesh_.normals.push_back({static_cast<float>(values[3]), static_cast<float>(values[4]),
                                 static_cast<float>(values[5])});
      }
    }
  }

  void read_faces(const PlyElement& element) {
    const auto list = std::ranges::find_if(element.properties, is_face_list);
    if (list == element.properties.end()) {
      if (element.n > 0) {
        body_.fail("faces without vertices: expected a list vertex_indices of whole numbers");
      }
      return;
    }
    mesh_.triangles.reserve(element.n);
    for (std::uint64_t f = 0; f < element.n; ++f) {
      for (const PlyProperty& property : element.properties) {
        if (&property == &*list) {
          read_face(property);
        } else {
          skip(property);
        }
      }
    }
  }

  void read_face(const PlyProperty& property) {
    const std::uint64_t n_corners = body_.integer(*property.count);
    if (n_corners < 3) {
      body_.fail("a face of " + std::to_string(n_corners) + " vertices: expected three or more");
    }
    Fan fan(mesh_);
    for (std::uint64_t c = 0; c < n_corners; ++c) {
      fan.add(body_.integer(property.type));
    }
  }

  void skip(const PlyProperty& property) {
    const std::uint64_t n = property.count ? body_.integer(*property.count) : 1;
    for (std::uint64_t value = 0; value < n; ++value) {
      body_.skip(property.type);
    }
  }

  void skip(const PlyElement& element) {
    const std::uint64_t n = element.properties.empty() ? 0 : element.n;
    for (std::uint64_t e = 0; e < n; ++e) {
      for (const PlyProperty& property : element.properties) {
        skip(property);
      }
    }
  }

  Body body_;
  Mesh mesh_;
};

}  // namespace

Mesh read_ply(const MeshInput& input) {
  const PlyHeader header = read_ply_header(input);
  return header.text ? BodyReader<TextBody>(input, header).read(header)
                     : BodyReader<BinaryBody>(input, header).read(header);
}

}  // namespace mc::source
