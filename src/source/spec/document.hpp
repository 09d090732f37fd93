// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "mc/field.hpp"
#include "mc/graph.hpp"
#include "source/spec/spec_files.hpp"

namespace mc::source {

/// A whole mc-volume document, checked.
struct SpecDocument {
  Volume volume;
  Vec3 origin{};
  Vec3 spacing{};
  GraphField field;
  std::optional<GraphField> material;  ///< its value is an index
  std::uint64_t data_bytes = 0;        ///< of pictures and volumes that nodes read
};

/// Errors   usage, with every fault of the document; those of SpecFiles.
SpecDocument load_spec(const std::string& place, std::string_view text, const SpecNesting& within);

}  // namespace mc::source
