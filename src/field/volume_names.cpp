// SPDX-License-Identifier: MIT
#include "field/volume_names.hpp"

#include <array>
#include <utility>

namespace mc::field {

namespace {

constexpr std::array<std::pair<VolumeClass, const char*>, 6> kClasses{
    {{VolumeClass::unknown, ""},
     {VolumeClass::level_set, "level_set"},
     {VolumeClass::fog, "fog"},
     {VolumeClass::mask, "mask"},
     {VolumeClass::density_spec, "density_spec"},
     {VolumeClass::sdf_spec, "sdf_spec"}}};
constexpr std::array<std::pair<Border, const char*>, 3> kBorders{
    {{Border::open, "open"}, {Border::closed, "closed"}, {Border::solid, "solid"}}};

template <class Names, class Value>
const char* name_in(const Names& names, Value value) {
  for (const auto& [known, name] : names) {
    if (known == value) {
      return name;
    }
  }
  __builtin_unreachable();
}

template <class Value, class Names>
std::optional<Value> value_in(const Names& names, std::string_view name) {
  for (const auto& [known, known_name] : names) {
    if (known_name == name) {
      return known;
    }
  }
  return std::nullopt;
}

}  // namespace

const char* class_name(VolumeClass cls) { return name_in(kClasses, cls); }
const char* border_name(Border border) { return name_in(kBorders, border); }

std::optional<VolumeClass> class_named(std::string_view name) {
  return value_in<VolumeClass>(kClasses, name);
}

std::optional<Border> border_named(std::string_view name) {
  return value_in<Border>(kBorders, name);
}

}  // namespace mc::field
