// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "mc/field.hpp"
#include "mc/graph.hpp"

namespace mc::source {

/// A whole mc-volume document, checked.
struct SpecDocument {
  Volume volume;
  Vec3 origin{};
  Vec3 spacing{};
  GraphField field;
};

/// Errors: usage, with every fault of the document.
SpecDocument load_spec(const std::string& place, std::string_view text);

}  // namespace mc::source
