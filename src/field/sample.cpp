// SPDX-License-Identifier: MIT
#include <array>
#include <bit>
#include <string_view>

#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Sample types: their names and sizes, and the arithmetic of binary16.

namespace mc {

namespace {

struct TypeRow {
  SampleType type;
  const char* name;
};
constexpr std::array<TypeRow, 10> kTypes{{{SampleType::u8, "u8"},
                                          {SampleType::i8, "i8"},
                                          {SampleType::u16, "u16"},
                                          {SampleType::i16, "i16"},
                                          {SampleType::u32, "u32"},
                                          {SampleType::i32, "i32"},
                                          {SampleType::i64, "i64"},
                                          {SampleType::f16, "f16"},
                                          {SampleType::f32, "f32"},
                                          {SampleType::f64, "f64"}}};

}  // namespace

std::size_t sample_size(SampleType type) {
  return field::visit_type(type, []<class T>(field::TypeTag<T>) { return sizeof(T); });
}

const char* sample_name(SampleType type) { return kTypes[static_cast<std::size_t>(type)].name; }

std::optional<SampleType> sample_type_named(std::string_view name) {
  for (const TypeRow& row : kTypes) {
    if (row.name == name) {
      return row.type;
    }
  }
  return std::nullopt;
}

double to_double(Scalar s, SampleType type) {
  return field::visit_type(type, [&]<class T>(field::TypeTag<T>) {
    return static_cast<double>(field::number(s.as<T>()));
  });
}

float to_float(Half h) noexcept {
  const std::uint32_t sign = (h.bits & 0x8000U) << 16U;
  const std::uint32_t exponent = (h.bits >> 10U) & 0x1FU;
  const std::uint32_t fraction = h.bits & 0x3FFU;
  if (exponent == 0) {  // zero and subnormals: fraction * 2^-24, exact in float
    const float magnitude = static_cast<float>(fraction) * 0x1p-24F;
    return sign != 0 ? -magnitude : magnitude;
  }
  if (exponent == 31) {
    return std::bit_cast<float>(sign | 0x7F800000U | (fraction << 13U));
  }
  return std::bit_cast<float>(sign | ((exponent + 112U) << 23U) | (fraction << 13U));
}

Half to_half(float f) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(f);
  const auto sign = static_cast<std::uint16_t>((bits >> 16U) & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  if (magnitude > 0x7F800000U) {
    return {static_cast<std::uint16_t>(sign | 0x7E00U)};
  }
  if (magnitude >= 0x477FF000U) {  // rounds past the largest half, 65504
    return {static_cast<std::uint16_t>(sign | 0x7C00U)};
  }
  if (magnitude < 0x38800000U) {  // below the smallest normal half: the addition rounds for us
    const float shifted = std::bit_cast<float>(magnitude) + 0.5F;
    const std::uint32_t rounded = std::bit_cast<std::uint32_t>(shifted) - 0x3F000000U;
    return {static_cast<std::uint16_t>(sign | rounded)};
  }
  const std::uint32_t odd = (magnitude >> 13U) & 1U;
  const std::uint32_t rounded = magnitude + 0xFFFU + odd - 0x38000000U;
  return {static_cast<std::uint16_t>(sign | (rounded >> 13U))};
}

}  // namespace mc
