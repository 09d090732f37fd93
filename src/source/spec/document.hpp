// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

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
  std::vector<std::unique_ptr<AttributeReader>> attributes{};  ///< of its vertices
  std::uint64_t data_bytes = 0;  ///< of pictures and volumes that nodes read
};

/// Errors   usage, with every fault of the document; those of SpecFiles.
SpecDocument load_spec(const std::string& place, std::string_view text, const SpecNesting& within);

}  // namespace mc::source
