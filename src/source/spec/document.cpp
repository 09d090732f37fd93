// SPDX-License-Identifier: MIT
#include "source/spec/document.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/checked.hpp"
#include "field/attributes.hpp"
#include "source/json/object_reader.hpp"
#include "source/spec/nodes.hpp"
#include "source/spec/spec.hpp"
#include "source/spec/spec_attributes.hpp"

// The frame of an mc-volume document: header, grid, convention; the nodes are nodes.cpp's.

namespace mc::source {

namespace {

struct Grid {
  Index3 samples{2, 2, 2};
  Vec3 spacing{1, 1, 1};
  Vec3 origin{0, 0, 0};
};

constexpr double kMostSamples = std::numeric_limits<std::int32_t>::max();

/// Counts of cells or samples, as samples.
Index3 read_counts(const JsonDocument& document, const JsonValue& counts, bool are_cells) {
  Index3 samples{2, 2, 2};
  if (counts.kind != JsonKind::array || counts.items.size() != 3) {
    document.fault(counts, as_found(counts) + ": expected an array of 3 integers");
    return samples;
  }
  const double least = are_cells ? 1 : 2;
  const double most = are_cells ? kMostSamples - 1 : kMostSamples;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const JsonValue& item = counts.items[axis];
    const double v = item.number;
    if (item.kind != JsonKind::number || std::floor(v) != v || v < least || v > most) {
      document.fault(item, as_found(item) + ": expected an integer from " +
                               std::to_string(static_cast<std::int64_t>(least)) + " to " +
                               std::to_string(static_cast<std::int64_t>(most)));
    } else {
      samples[axis] = static_cast<std::int32_t>(v) + (are_cells ? 1 : 0);
    }
  }
  const auto n = [&](std::size_t axis) { return static_cast<std::uint64_t>(samples[axis]); };
  if (!base::checked_mul(n(0), n(1), n(2), std::uint64_t{sizeof(float)})) {
    document.fault(counts, "makes more bytes of samples than 64 bits can count");
  }
  return samples;
}

/// World coordinates are float32 in the formulas: the grid must lie within their range.
void check_extent(const JsonDocument& document, const JsonValue& at, const Grid& grid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double last = grid.origin[axis] + (grid.samples[axis] - 1.0) * grid.spacing[axis];
    if (!(std::abs(last) <= kAnyFloat.hi) || !(std::abs(grid.origin[axis]) <= kAnyFloat.hi)) {
      document.fault(at, "reaches past world coordinates of +-3.4e38: expected a smaller grid");
      return;
    }
  }
}

Grid read_grid(const JsonDocument& document, const JsonValue& value) {
  constexpr NumberRange kSpacing{0, 3.4028234663852886e38, true, "a number above 0"};
  Grid grid;
  ObjectReader keys(document, value, "the grid");
  const JsonValue* cells = keys.optional("cells");
  const JsonValue* samples = keys.optional("samples");
  if (keys.is_object() && (cells == nullptr) == (samples == nullptr)) {
    document.fault(value, cells == nullptr ? R"(has neither "cells" nor "samples": expected one)"
                                           : R"(has both "cells" and "samples": expected one)");
  } else if (cells != nullptr) {
    grid.samples = read_counts(document, *cells, true);
  } else if (samples != nullptr) {
    grid.samples = read_counts(document, *samples, false);
  }
  grid.spacing = keys.numbers<3>("spacing", Vec3{1, 1, 1}, kSpacing, true);
  grid.origin = keys.numbers<3>("origin", Vec3{0, 0, 0}, kAnyFloat);
  keys.finish();
  check_extent(document, value, grid);
  return grid;
}

void read_header(ObjectReader& keys) {
  keys.choice("format", std::nullopt, {"mc-volume"});
  keys.integer("version", std::nullopt, 1, 1);
}

Volume volume_of_grid(const Grid& grid) {
  Volume volume;
  volume.format = kSpecFormat.name;
  volume.lattice.box.hi = {grid.samples[0] - 1, grid.samples[1] - 1, grid.samples[2] - 1};
  volume.lattice.to_world = Affine::scale_translate(grid.spacing, grid.origin);
  volume.type = SampleType::f32;
  volume.endian = std::endian::native;
  volume.units = Units::m;
  return volume;
}

/// Compiles; an expansion past the limit becomes a fault of the field.
GraphField compile(const JsonDocument& document, const Graph& graph, NodeId root,
                   const JsonValue& at) {
  try {
    return graph.compile(root);
  } catch (const Error& error) {
    document.fault(at, error.what());
    document.faults.throw_if_any();
    throw;
  }
}

/// A node whose value vertices carry.
struct AttributeNode {
  AttributeInfo info;
  NodeId node;
  const JsonValue* at;
};

void load_attributes(const JsonDocument& document, const JsonValue& named, NodeLoader& nodes,
                     std::vector<AttributeNode>& out) {
  if (named.kind != JsonKind::object) {
    document.fault(named, as_found(named) + ": expected an object of named nodes");
    return;
  }
  std::vector<AttributeInfo> before;
  for (const JsonMember& member : named.members) {
    if (is_ignored_key(member.key)) continue;
    const AttributeInfo info{.name = member.key};
    const std::string fault = field::attribute_fault(info, before);
    if (!fault.empty()) document.fault(member.value, fault);
    before.push_back(info);
    out.push_back({info, nodes.load(member.value), &member.value});
  }
}

/// The keys "material" and "attributes". The material comes last, as readers hand attributes out.
std::vector<AttributeNode> read_attributes(const JsonDocument& document, ObjectReader& keys,
                                           NodeLoader& nodes) {
  std::vector<AttributeNode> out;
  const JsonValue* material = keys.optional("material");
  const NodeId material_node = material == nullptr ? NodeId{} : nodes.load(*material);
  if (const JsonValue* named = keys.optional("attributes")) {
    load_attributes(document, *named, nodes, out);
  }
  if (material != nullptr) out.push_back({material_attribute(), material_node, material});
  return out;
}

}  // namespace

SpecDocument load_spec(const std::string& place, std::string_view text, const SpecNesting& within) {
  Faults faults(place, text);
  const std::optional<JsonValue> root = parse_json(faults);
  if (!root) {
    faults.throw_if_any();
    throw Error(ErrorKind::internal, place, "was not parsed, and nothing says why");
  }
  const JsonDocument document{*root, faults};
  ObjectReader keys(document, *root, "an mc-volume document");
  read_header(keys);
  GraphSettings settings;
  settings.seed = static_cast<std::uint32_t>(keys.integer("seed", 0, 0, 0xFFFFFFFFLL));
  settings.convention = Convention(keys.choice("convention", 0, {"density", "sdf"}));
  const double iso = keys.number("iso", 0, kAnyFloat);
  settings.iso = static_cast<float>(iso);
  const bool has_border = root->find("border") != nullptr;
  const auto border = Border(keys.choice("border", 0, {"open", "closed", "solid"}));
  const JsonValue* grid_value = keys.required("grid");
  const Grid grid = grid_value == nullptr ? Grid{} : read_grid(document, *grid_value);
  SpecFiles files(place, within);
  NodeLoader nodes(document, keys.optional("nodes"), settings, files);
  const JsonValue* field = keys.required("field");
  const NodeId top = field == nullptr ? NodeId{} : nodes.load(*field);
  const std::vector<AttributeNode> attributes = read_attributes(document, keys, nodes);
  nodes.load_unused();
  keys.finish();
  faults.throw_if_any();

  SpecDocument spec{volume_of_grid(grid), grid.origin, grid.spacing,
                    compile(document, nodes.graph(), top, *field)};
  for (const AttributeNode& attribute : attributes) {
    spec.attributes.push_back(field_attribute(
        attribute.info, compile(document, nodes.graph(), attribute.node, *attribute.at),
        grid.origin, grid.spacing));
  }
  spec.volume.cls = settings.convention == Convention::density ? VolumeClass::density_spec
                                                               : VolumeClass::sdf_spec;
  spec.volume.iso = iso;
  spec.data_bytes = files.bytes();
  if (has_border) {
    spec.volume.border = border;
  }
  return spec;
}

}  // namespace mc::source
