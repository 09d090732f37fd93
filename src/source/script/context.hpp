// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/graph.hpp"
#include "source/json/object_reader.hpp"
#include "source/script/script.hpp"
#include "source/spec/spec_files.hpp"

// What the records of a script are read with.

namespace mc::source {

/// Numbers of a script: places and lengths in the script's space.
inline constexpr double kMostLength = 1e15;
inline constexpr NumberRange kPlace{-kMostLength, kMostLength, false, "a number within +-1e15"};
inline constexpr NumberRange kLength{0, kMostLength, true, "a number above 0, at most 1e15"};
inline constexpr NumberRange kLengthOrZero{0, kMostLength, false, "a number from 0 to 1e15"};
inline constexpr NumberRange kPart{0, 1, false, "a number from 0 to 1"};

/// What the header says and keeps for all records.
struct ScriptContext {
  ScriptContext(const std::string& base, const SpecNesting& within) : files(base, within) {}

  ScriptHeader header{};
  const JsonValue* nodes = nullptr;  ///< "nodes" and "defaults" of the header; null without
  const JsonValue* defaults = nullptr;
  std::uint32_t seed = 0;
  SpecFiles files;
};

/// Compiles a node; null where it has faults, which are noted.
[[nodiscard]] std::shared_ptr<const GraphField> read_node(const JsonDocument& document,
                                                          ScriptContext& context,
                                                          const JsonValue& value);

}  // namespace mc::source
