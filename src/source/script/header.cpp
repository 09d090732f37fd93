// SPDX-License-Identifier: MIT
#include "source/script/header.hpp"

#include <cmath>
#include <filesystem>
#include <limits>

#include "source/script/record_reader.hpp"
#include "source/spec/nodes.hpp"

// What holds for all records of a script.

namespace mc::source {

namespace {

/// "clamp": two numbers, or null where a side is open.
std::array<double, 2> read_clamp(const JsonDocument& document, ObjectReader& keys) {
  std::array<double, 2> clamp = ScriptHeader{}.clamp;
  const JsonValue* found = keys.optional("clamp");
  if (found == nullptr) return clamp;
  if (found->kind != JsonKind::array || found->items.size() != 2) {
    document.fault(*found, "expected the least and the greatest value, each a number or null");
    return clamp;
  }
  for (std::size_t n = 0; n < 2; ++n) {
    const JsonValue& item = found->items[n];
    if (item.kind == JsonKind::number) {
      clamp[n] = item.number;
    } else if (item.kind != JsonKind::null) {
      document.fault(item, as_found(item) + ": expected a number or null");
    }
  }
  if (!(clamp[0] <= clamp[1])) {
    document.fault(*found, "holds no value: expected the least value first");
    return ScriptHeader{}.clamp;
  }
  return clamp;
}

bool read_flag(const JsonDocument& document, ObjectReader& keys, const char* key) {
  const JsonValue* found = keys.optional(key);
  if (found == nullptr) return false;
  if (found->kind != JsonKind::boolean) {
    document.fault(*found, as_found(*found) + ": expected true or false");
  }
  return found->boolean;
}

}  // namespace

void read_header(const JsonDocument& document, ObjectReader& keys, ScriptContext& context) {
  constexpr NumberRange kSeconds{0, 3600, true, "a number above 0, at most 3600 (seconds)"};
  keys.choice("format", std::nullopt, {"mc-edits"});
  keys.integer("version", std::nullopt, 1, 1);
  ScriptHeader& header = context.header;
  header.index_space = keys.choice("space", 0, {"world", "index"}) == 1;
  header.dt = keys.number("dt", 0.02, kSeconds);
  header.clamp = read_clamp(document, keys);
  header.journal = read_flag(document, keys, "journal");
  keys.text("folder", true);
  context.seed = static_cast<std::uint32_t>(keys.integer("seed", 0, 0, 0xFFFFFFFFLL));
  context.nodes = keys.optional("nodes");
  if (context.nodes != nullptr) {
    const GraphSettings settings{.seed = context.seed};
    NodeLoader nodes(document, context.nodes, settings, context.files);
    nodes.load_unused();
  }
  if (const JsonValue* defaults = keys.optional("defaults")) {
    RecordReader(document, context).check_defaults(*defaults);
    context.defaults = defaults->kind == JsonKind::object ? defaults : nullptr;
  }
}

std::string base_of(const JsonValue& root, const std::string& place) {
  namespace fs = std::filesystem;
  std::string own = place == "<stdin>" ? "script" : place;
  const JsonValue* folder = root.find("folder");
  if (folder == nullptr || folder->kind != JsonKind::string) return own;
  return ((fs::path(own).parent_path() / folder->text) / fs::path(own).filename()).string();
}

}  // namespace mc::source
