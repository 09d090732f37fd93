// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include "mc/field.hpp"

namespace mc::field {

/// What is wrong with an attribute beside those that come before it, as check_attributes() says;
/// empty: nothing.
[[nodiscard]] std::string attribute_fault(const AttributeInfo& attribute,
                                          std::span<const AttributeInfo> before);

/// The name of one of an attribute's numbers: the attribute's own if it is the only one, else with
/// _x, _y, _z or _w.
[[nodiscard]] std::string component_name(const AttributeInfo& attribute, std::size_t component);

}  // namespace mc::field
