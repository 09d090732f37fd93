// SPDX-License-Identifier: MIT
#include "field/attributes.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

// Names of vertex attributes. They become properties of PLY and, in capitals, attributes of glTF.

namespace mc {

namespace field {

namespace {

constexpr std::size_t kMaxLength = 64;
constexpr std::array<std::string_view, 6> kPositionAndNormal{"x", "y", "z", "nx", "ny", "nz"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string in_lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

bool is_identifier(std::string_view name) {
  return !name.empty() && name.size() <= kMaxLength && is_letter(name.front()) &&
         std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

/// All names that it has in some format, in lower case.
std::vector<std::string> names_of(const AttributeInfo& attribute) {
  std::vector<std::string> names{in_lower_case(attribute.name)};
  for (std::size_t c = 0; attribute.n_components > 1 && c < attribute.n_components; ++c) {
    names.push_back(in_lower_case(component_name(attribute, c)));
  }
  return names;
}

bool share_a_name(const AttributeInfo& a, const AttributeInfo& b) {
  const std::vector<std::string> names = names_of(a);
  return std::ranges::any_of(names_of(b), [&](const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  });
}

}  // namespace

std::string component_name(const AttributeInfo& attribute, std::size_t component) {
  if (attribute.n_components == 1) return attribute.name;
  return attribute.name + '_' + "xyzw"[component];
}

std::string attribute_fault(const AttributeInfo& attribute, std::span<const AttributeInfo> before) {
  if (!is_identifier(attribute.name)) {
    return "cannot name a vertex attribute: expected a letter, then letters, digits and "
           "underscores, at most " +
           std::to_string(kMaxLength) + " in all";
  }
  const std::string name = in_lower_case(attribute.name);
  if (std::ranges::find(kPositionAndNormal, name) != kPositionAndNormal.end()) {
    return "names part of a vertex's position or normal: expected another name";
  }
  if (name == material_attribute().name && attribute != material_attribute()) {
    return "names the index of a vertex's material: expected another name";
  }
  if (attribute.n_components < 1 || attribute.n_components > 4) {
    return "has " + std::to_string(attribute.n_components) + " components: expected 1 to 4";
  }
  const auto other = std::ranges::find_if(
      before, [&](const AttributeInfo& known) { return share_a_name(attribute, known); });
  if (other == before.end()) return {};
  return "cannot be told apart from \"" + other->name + "\" in every format: expected another name";
}

}  // namespace field

const AttributeInfo& material_attribute() {
  static const AttributeInfo material{.name = "material", .type = SampleType::u16};
  return material;
}

void check_attributes(std::span<const AttributeInfo> attributes) {
  for (std::size_t n = 0; n < attributes.size(); ++n) {
    const std::string fault = field::attribute_fault(attributes[n], attributes.first(n));
    if (!fault.empty()) {
      throw Error(ErrorKind::usage, "attribute \"" + attributes[n].name + "\"", fault);
    }
  }
}

const AttributeReader* find_attribute(AttributeReaders readers, const AttributeInfo& info) {
  const auto found = std::ranges::find_if(
      readers, [&](const AttributeReader* reader) { return reader->info() == info; });
  return found == readers.end() ? nullptr : *found;
}

}  // namespace mc
