// SPDX-License-Identifier: MIT
#include "cli/bench/bench_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <vector>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"
#include "mc/graph.hpp"

// Graphs of the benchmark's fields, and their samples in any type.

namespace mc::cli {

namespace {

/// Short forms of the nodes that the fields are made of.
class FieldGraph {
 public:
  explicit FieldGraph(Convention convention) : graph_({.seed = 1337, .convention = convention}) {}

  NodeId leaf(NodeType type) { return graph_.add({.type = type}); }
  NodeId number(double value) {
    return graph_.add({.type = NodeType::constant, .numbers = {static_cast<float>(value)}});
  }
  NodeId op(NodeType type, std::vector<NodeId> inputs) {
    return graph_.add({.type = type, .inputs = std::move(inputs)});
  }
  NodeId scaled(NodeId a, double factor) { return op(NodeType::mul, {a, number(factor)}); }
  NodeId fractal(Dims dims, double frequency, std::uint32_t octaves) {
    const NodeId source =
        graph_.add({.type = NodeType::perlin, .numbers = {static_cast<float>(frequency)}});
    return graph_.add({.type = NodeType::fbm,
                       .inputs = {source},
                       .numbers = {2, 0.5F, 0},
                       .octaves = octaves,
                       .dims = dims});
  }
  NodeId add(Node node) { return graph_.add(std::move(node)); }
  [[nodiscard]] GraphField compile(NodeId root) const { return graph_.compile(root); }

 private:
  Graph graph_;
};

GraphField sphere() {
  FieldGraph g(Convention::density);
  return g.compile(
      g.add({.type = NodeType::sphere, .numbers = {0, 0, 0, static_cast<float>(kSphereRadius)}}));
}

/// (sin x cos y + sin y cos z + sin z cos x) / 2, which stays within [-1, 1].
GraphField gyroid(double periods) {
  FieldGraph g(Convention::density);
  const NodeId quarter = g.number(std::numbers::pi / 2);
  std::vector<NodeId> sines;
  std::vector<NodeId> cosines;
  for (const NodeType axis : {NodeType::x, NodeType::y, NodeType::z}) {
    const NodeId angle = g.scaled(g.leaf(axis), periods * std::numbers::pi);
    sines.push_back(g.op(NodeType::sin, {angle}));
    cosines.push_back(g.op(NodeType::sin, {g.op(NodeType::add, {angle, quarter})}));
  }
  std::vector<NodeId> products;
  for (std::size_t a = 0; a < 3; ++a) {
    products.push_back(g.op(NodeType::mul, {sines[a], cosines[(a + 1) % 3]}));
  }
  return g.compile(g.scaled(g.op(NodeType::add, products), 0.5));
}

GraphField noise() {
  FieldGraph g(Convention::density);
  return g.compile(g.fractal(Dims::xyz, 4, 4));
}

GraphField demo() {
  FieldGraph g(Convention::sdf);
  const NodeId y = g.leaf(NodeType::y);
  const NodeId hills = g.add({.type = NodeType::unity_perlin2d, .numbers = {1}});
  return g.compile(g.op(NodeType::add, {g.scaled(y, 0.25), g.op(NodeType::mul, {hills, y})}));
}

GraphField field_named(std::string_view name, double periods) {
  if (name == "sphere") return sphere();
  if (name == "terrain") return make_terrain_field(Dims::xz, 3);
  if (name == "gyroid") return gyroid(periods);
  assert(name == "noise");
  return noise();
}

/// A value of [-1, 1] in the type's range; what lies outside goes to its ends.
template <class T>
T quantised(float value) {
  if constexpr (std::is_same_v<T, Half>) {
    return to_half(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return T{value};
  } else {
    constexpr auto top = static_cast<double>(std::numeric_limits<T>::max());
    const double v = std::clamp(static_cast<double>(value), -1.0, 1.0);
    const double wanted = std::is_signed_v<T> ? v * top : (v + 1) / 2 * top;
    // The largest i64 is no double: what rounds up to 2^63 is held below it.
    return wanted >= top ? std::numeric_limits<T>::max() : static_cast<T>(std::floor(wanted + 0.5));
  }
}

template <class T>
double middle() {
  if constexpr (std::is_unsigned_v<T>) {
    return static_cast<double>(std::numeric_limits<T>::max()) / 2;
  } else {
    return 0;
  }
}

/// Computes the planes of a cube in f32 and stores them as T.
template <class T>
void fill(const GraphField& field, double origin, double spacing, BenchVolume& volume) {
  const auto n = static_cast<std::size_t>(volume.n);
  auto* out = reinterpret_cast<T*>(volume.samples.data());
  base::for_ranges(n, 1, [&](std::size_t k0, std::size_t k1) {
    Buffer<float> plane(n * n);
    for (std::size_t k = k0; k < k1; ++k) {
      field.sample({origin, origin, origin}, {spacing, spacing, spacing},
                   {0, 0, static_cast<std::int32_t>(k)},
                   View3<float>(plane.data(), {volume.n, volume.n, 1}));
      std::transform(plane.begin(), plane.end(), out + k * n * n, quantised<T>);
    }
  });
}

}  // namespace

BenchVolume make_bench_volume(std::string_view name, std::int32_t n, SampleType type,
                              double periods) {
  const auto samples = static_cast<std::size_t>(n);
  BenchVolume volume{type, n, BenchArray(samples * samples * samples * sample_size(type))};
  const GraphField field = field_named(name, periods);
  field::visit_type(type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    volume.iso = middle<T>();
    fill<T>(field, -1, 2.0 / (n - 1), volume);
  });
  return volume;
}

GraphField make_fractal_field() {
  FieldGraph g(Convention::density);
  return g.compile(g.fractal(Dims::xyz, 1, 6));
}

GraphField make_terrain_field(Dims dims, double frequency) {
  FieldGraph g(Convention::density);
  const NodeId height = g.scaled(g.fractal(dims, frequency, 6), 0.5);
  return g.compile(g.op(NodeType::sub, {height, g.leaf(NodeType::y)}));
}

BenchVolume make_demo_volume(std::int32_t n_cells) {
  const auto samples = static_cast<std::size_t>(n_cells) + 1;
  BenchVolume volume{SampleType::f32, n_cells + 1,
                     BenchArray(samples * samples * samples * sizeof(float)), 0.5, Inside::below};
  fill<float>(demo(), 0, 3.0 / n_cells, volume);
  return volume;
}

}  // namespace mc::cli
