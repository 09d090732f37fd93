// SPDX-License-Identifier: MIT
#include "sink/attribute_columns.hpp"

#include <cmath>
#include <cstring>
#include <type_traits>

#include "field/visit_type.hpp"
#include "sink/text.hpp"

namespace mc::sink {

namespace {

/// A vertex's bytes are copied by an instruction or two where their number is usual.
template <std::size_t kBytes>
void copy_column(const std::byte* from, std::size_t n, std::byte* to, std::size_t stride) {
  for (std::size_t v = 0; v < n; ++v) {
    std::memcpy(to + v * stride, from + v * kBytes, kBytes);
  }
}

void copy_attribute(const VertexAttribute& attribute, const VertexRange& vertices, std::byte* to,
                    std::size_t stride) {
  const std::size_t n_bytes = attribute.info.bytes();
  const std::byte* from = attribute.values.data() + vertices.first * n_bytes;
  const std::size_t n = vertices.last - vertices.first;
  switch (n_bytes) {
    case 2:
      return copy_column<2>(from, n, to, stride);
    case 4:
      return copy_column<4>(from, n, to, stride);
    default:
      for (std::size_t v = 0; v < n; ++v) {
        std::memcpy(to + v * stride, from + v * n_bytes, n_bytes);
      }
  }
}

}  // namespace

void put_attribute(const VertexAttribute& attribute, const VertexRange& vertices, bool as_floats,
                   std::byte* to, std::size_t stride) {
  if (!as_floats) return copy_attribute(attribute, vertices, to, stride);
  const std::size_t n_components = attribute.info.n_components;
  field::visit_type(attribute.info.type, [&]<class T>(field::TypeTag<T>) {
    const T* from = attribute.values_as<T>().data();
    for (std::size_t v = vertices.first; v < vertices.last; ++v, to += stride) {
      for (std::size_t c = 0; c < n_components; ++c) {
        const auto number = static_cast<float>(field::number(from[v * n_components + c]));
        std::memcpy(to + c * sizeof number, &number, sizeof number);
      }
    }
  });
}

std::uint64_t zero_not_finite(std::size_t n_vertices, std::size_t n_components, std::byte* to,
                              std::size_t stride) {
  std::uint64_t n_found = 0;
  for (std::size_t v = 0; v < n_vertices; ++v) {
    for (std::size_t c = 0; c < n_components; ++c) {
      float number = 0;
      std::byte* at = to + v * stride + c * sizeof number;
      std::memcpy(&number, at, sizeof number);
      if (std::isfinite(number)) continue;
      std::memset(at, 0, sizeof number);
      ++n_found;
    }
  }
  return n_found;
}

char* print_attribute(char* at, const VertexAttribute& attribute, std::size_t vertex) {
  const std::size_t n_components = attribute.info.n_components;
  field::visit_type(attribute.info.type, [&]<class T>(field::TypeTag<T>) {
    const T* numbers = attribute.values_as<T>().data() + vertex * n_components;
    for (std::size_t c = 0; c < n_components; ++c) {
      *at++ = ' ';
      const auto number = field::number(numbers[c]);
      if constexpr (std::is_floating_point_v<decltype(number)>) {
        at = print_number(at, number);
      } else if constexpr (std::is_unsigned_v<decltype(number)>) {
        at = print_number(at, std::uint64_t{number});
      } else {
        at = print_number(at, std::int64_t{number});
      }
    }
  });
  return at;
}

}  // namespace mc::sink
