// SPDX-License-Identifier: MIT
#include <utility>

#include "mc/base.hpp"
#include "source/spec/nodes.hpp"

// Nodes that read files. What is wrong with a file is a fault of the document, at the key that
// names it.

namespace mc::source {

void NodeLoader::fill_heightmap(Node& node, ObjectReader& keys) {
  const auto number = [](double v) { return static_cast<float>(v); };
  const std::optional<std::string> path = keys.text("path", false);
  const std::optional<std::string> channel = keys.text("channel", true);
  const auto origin = keys.numbers<2>("origin", std::array<double, 2>{0, 0}, kAnyFloat);
  const auto size = keys.numbers<2>("size", std::nullopt, kPositiveFloat, true);
  node.numbers = {number(origin[0]), number(origin[1]), number(size[0]), number(size[1]),
                  number(keys.number("height", 1, kAnyFloat))};
  node.wrap = Wrap(keys.choice("wrap", 0, {"clamp", "repeat", "mirror"}));
  node.filter = Filter(keys.choice("filter", 1, {"nearest", "linear", "cubic"}));
  if (keys.value().find("dims") != nullptr) {
    node.dims = Dims(keys.choice("dims", std::nullopt, {"xy", "xz", "yz"}) + 1);
  } else {
    keys.optional("dims");
  }
  if (!path) return;
  try {
    node.raster = files_.picture(*path, channel);
  } catch (const Error& error) {
    document_.fault(*keys.value().find("path"), std::string("cannot be read: ") + error.what());
  }
}

}  // namespace mc::source
