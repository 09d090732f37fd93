// SPDX-License-Identifier: MIT
#include <utility>

#include "mc/base.hpp"
#include "source/spec/nodes.hpp"

// Nodes that read files. What is wrong with a file is a fault of the document, at the key that
// names it.

namespace mc::source {

namespace {

/// Runs `read`, which may throw an Error of the file that `at` names.
template <class F>
void read_file(const JsonDocument& document, const JsonValue& at, F&& read) {
  try {
    read();
  } catch (const Error& error) {
    const bool limit = error.kind() == ErrorKind::limit;
    document.fault(at, std::string("cannot be read: ") + error.what(),
                   limit ? error.kind() : ErrorKind::usage);
  }
}

}  // namespace

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
  read_file(document_, *keys.value().find("path"),
            [&] { node.raster = files_.picture(*path, channel); });
}

void NodeLoader::fill_volume(Node& node, ObjectReader& keys) {
  const std::optional<std::string> path = keys.text("path", false);
  const std::optional<std::string> grid = keys.text("grid", true);
  const double outside = keys.number("outside", 0, kAnyFloat);
  if (keys.value().find("outside") != nullptr) {
    node.outside = static_cast<float>(outside);
  }
  node.filter = Filter(keys.choice("filter", 1, {"nearest", "linear"}));
  if (!path) return;
  read_file(document_, *keys.value().find("path"),
            [&] { node.volume = files_.volume(*path, grid); });
}

}  // namespace mc::source
