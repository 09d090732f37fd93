// SPDX-License-Identifier: MIT
#include "mc/components.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/vectors.hpp"
#include "mc/mesh.hpp"

// Which components remain, and the components of a mesh by its triangles alone.
//
//       +-----------------+     A closed shell whose volume is negative bounds a cavity. From its
//       |  solid          |     point of largest x a ray along +x starts in the solid around the
//       |    +--------+   |     cavity, and the first shell that it hits bounds the same solid:
//       |    | cavity *------>  its outer shell, or another cavity of it, which reaches further
//       |    +--------+   |     along x; so following the hits always ends at the outer shell.
//       +-----------------+

namespace mc {

namespace {

constexpr std::uint32_t kNone = MeshComponents::kNone;

/// Rounds to 20 significant bits.
double rounded(double size) {
  constexpr std::uint64_t kDropped = (std::uint64_t{1} << 33U) - 1;  // of 53
  const auto bits = std::bit_cast<std::uint64_t>(size) + (kDropped + 1) / 2;
  return std::bit_cast<double>(bits & ~kDropped);
}

/// What is known of one shell.
struct Shell {
  double volume = 0, area = 0;
  Vec3 border_sum{};  ///< of the starts of its border's edges
  std::size_t n_border = 0;
  std::uint32_t last = kNone;  ///< its vertex of the largest x, the first of several
};

struct BorderEdge {
  std::uint32_t from, to;
};

/// The sides of triangles that no other triangle runs along the other way.
std::vector<BorderEdge> border_edges(const Mesh& mesh) {
  std::vector<BorderEdge> sides;
  sides.reserve(3 * mesh.n_triangles());
  for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
    const auto ids = mesh.triangle(t);
    for (std::size_t n = 0; n < 3; ++n) {
      sides.push_back(
          {static_cast<std::uint32_t>(ids[n]), static_cast<std::uint32_t>(ids[(n + 1) % 3])});
    }
  }
  const auto key = [](const BorderEdge& e) {
    return std::pair(std::min(e.from, e.to), std::max(e.from, e.to));
  };
  std::ranges::sort(sides,
                    [&](const BorderEdge& a, const BorderEdge& b) { return key(a) < key(b); });
  std::vector<BorderEdge> border;
  for (std::size_t n = 0; n < sides.size();) {
    std::size_t end = n;
    while (end < sides.size() && key(sides[end]) == key(sides[n])) ++end;
    if (end - n == 1) border.push_back(sides[n]);
    n = end;
  }
  return border;
}

/// Finds what a ray along +x hits, by tiles of the plane of y and z.
class RayTiles {
 public:
  explicit RayTiles(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t v = 0; v < mesh.n_vertices(); ++v) bounds_.include(mesh.position(v));
    const auto n = static_cast<double>(std::max<std::size_t>(mesh.n_triangles(), 1));
    side_ = static_cast<std::size_t>(std::clamp(std::sqrt(n / 16), 1.0, 4096.0));
    first_.assign(side_ * side_ + 1, 0);
    for_each_entry([this](std::size_t tile, std::size_t /*t*/) { ++first_[tile + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each_entry([&](std::size_t tile, std::size_t t) {
      entries_[next[tile]++] = static_cast<std::uint32_t>(t);
    });
  }

  /// The nearest triangle that a ray from `start` hits and `wanted` accepts.
  template <class F>
  [[nodiscard]] std::optional<std::size_t> first_hit(const Vec3& start, F&& wanted) const {
    const std::size_t tile = tile_of(start[2], 2) * side_ + tile_of(start[1], 1);
    std::optional<std::size_t> nearest;
    double nearest_x = 0;
    for (std::size_t e = first_[tile]; e < first_[tile + 1]; ++e) {
      const std::size_t t = entries_[e];
      if (!wanted(t)) continue;
      const std::optional<double> x = hit(t, start);
      if (!x || *x < start[0] || (nearest && *x >= nearest_x)) continue;
      nearest = t;
      nearest_x = *x;
    }
    return nearest;
  }

 private:
  [[nodiscard]] std::size_t tile_of(double at, std::size_t axis) const {
    const double extent = bounds_.hi[axis] - bounds_.lo[axis];
    if (!(extent > 0)) return 0;
    const double place = (at - bounds_.lo[axis]) / extent * static_cast<double>(side_);
    return std::min(side_ - 1, static_cast<std::size_t>(std::max(place, 0.0)));
  }
  template <class F>
  void for_each_entry(F&& f) const {
    for (std::size_t t = 0; t < mesh_.n_triangles(); ++t) {
      Bounds box;
      for (const std::uint64_t v : mesh_.triangle(t)) box.include(mesh_.position(v));
      for (std::size_t z = tile_of(box.lo[2], 2); z <= tile_of(box.hi[2], 2); ++z) {
        for (std::size_t y = tile_of(box.lo[1], 1); y <= tile_of(box.hi[1], 1); ++y) {
          f(z * side_ + y, t);
        }
      }
    }
  }
  /// On which side of the line from a to b in the plane of y and z `p` lies. A point on the line
  /// counts as moved by a step along y and a much smaller one along z, so that a ray through an
  /// edge hits one triangle of the two.
  static bool is_left(const Vec3& a, const Vec3& b, const Vec3& p) {
    const double y = b[1] - a[1], z = b[2] - a[2];
    const double side = y * (p[2] - a[2]) - z * (p[1] - a[1]);
    return side != 0 ? side > 0 : z != 0 ? z < 0 : y > 0;
  }
  /// The x at which a line along x through `p` meets a triangle.
  [[nodiscard]] std::optional<double> hit(std::size_t t, const Vec3& p) const {
    const auto ids = mesh_.triangle(t);
    const Vec3 a = mesh_.position(ids[0]), b = mesh_.position(ids[1]), c = mesh_.position(ids[2]);
    const bool left = is_left(a, b, p);
    if (is_left(b, c, p) != left || is_left(c, a, p) != left) return std::nullopt;
    const Vec3 n = cross(minus(b, a), minus(c, a));
    if (n[0] == 0) return std::nullopt;
    return a[0] - (n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2])) / n[0];
  }

  const Mesh& mesh_;
  Bounds bounds_;
  std::size_t side_ = 1;  ///< tiles along each axis
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> entries_;
};

/// Works out the shells of a mesh, and which of them bound one solid.
class Shells {
 public:
  explicit Shells(const Mesh& mesh) : mesh_(mesh), parent_(mesh.n_vertices()) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
      const auto ids = mesh.triangle(t);
      for (const std::uint64_t v : ids) {
        assert(v < mesh.n_vertices());
        base::unite_sets(parent_, static_cast<std::uint32_t>(ids[0]),
                         static_cast<std::uint32_t>(v));
      }
    }
    number();
    measure();
    join_cavities();
  }
  [[nodiscard]] MeshComponents components() const;

 private:
  void number();
  void measure();
  void join_cavities();
  [[nodiscard]] std::uint32_t shell_of(std::size_t triangle) const {
    return shell_[mesh_.triangle(triangle)[0]];
  }
  void add_cone(Shell& shell, const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 n = cross(minus(b, a), minus(c, a));
    shell.volume += dot(minus(a, middle_), n) / 6;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> parent_;  ///< sets of connected vertices
  Vec3 middle_{};
  std::vector<std::uint32_t> shell_;  ///< of each vertex
  std::vector<Shell> shells_;         ///< in the order of their first vertices
  std::vector<std::uint32_t> solid_;  ///< of each shell: the shell that names it
};

void Shells::number() {
  shell_.assign(mesh_.n_vertices(), kNone);
  std::vector<bool> used(mesh_.n_vertices());
  for (std::size_t t = 0; t < mesh_.n_triangles(); ++t) {
    for (const std::uint64_t v : mesh_.triangle(t)) used[v] = true;
  }
  for (std::uint32_t v = 0; v < shell_.size(); ++v) {
    if (!used[v]) continue;
    const std::uint32_t root = base::find_set(parent_, v);
    if (root == v) {
      shell_[v] = static_cast<std::uint32_t>(shells_.size());
      shells_.emplace_back();
    }
    shell_[v] = shell_[root];
    Shell& shell = shells_[shell_[v]];
    const bool further =
        shell.last == kNone || mesh_.position(v)[0] > mesh_.position(shell.last)[0];
    if (further) shell.last = v;
  }
}

void Shells::measure() {
  Bounds bounds;
  for (std::size_t v = 0; v < mesh_.n_vertices(); ++v) bounds.include(mesh_.position(v));
  for (std::size_t a = 0; a < 3; ++a) middle_[a] = (bounds.lo[a] + bounds.hi[a]) / 2;
  for (std::size_t t = 0; t < mesh_.n_triangles(); ++t) {
    const auto ids = mesh_.triangle(t);
    const Vec3 a = mesh_.position(ids[0]), b = mesh_.position(ids[1]), c = mesh_.position(ids[2]);
    Shell& shell = shells_[shell_of(t)];
    const Vec3 n = cross(minus(b, a), minus(c, a));
    shell.area += length(n) / 2;
    add_cone(shell, a, b, c);
  }
  const std::vector<BorderEdge> border = border_edges(mesh_);
  for (const BorderEdge& edge : border) {
    Shell& shell = shells_[shell_[edge.from]];
    const Vec3 p = mesh_.position(edge.from);
    for (std::size_t a = 0; a < 3; ++a) shell.border_sum[a] += p[a];
    ++shell.n_border;
  }
  for (const BorderEdge& edge : border) {
    Shell& shell = shells_[shell_[edge.from]];
    Vec3 middle = shell.border_sum;
    for (double& x : middle) x /= static_cast<double>(shell.n_border);
    add_cone(shell, middle, mesh_.position(edge.to), mesh_.position(edge.from));
  }
  for (Shell& shell : shells_) {
    if (shell.n_border != 0) shell.volume = std::abs(shell.volume);
  }
}

void Shells::join_cavities() {
  solid_.resize(shells_.size());
  std::iota(solid_.begin(), solid_.end(), std::uint32_t{0});
  const auto is_cavity = [](const Shell& s) { return s.n_border == 0 && s.volume < 0; };
  if (std::ranges::none_of(shells_, is_cavity)) return;
  const RayTiles rays(mesh_);
  std::vector<std::uint32_t> hit(shells_.size(), kNone);
  for (std::uint32_t s = 0; s < shells_.size(); ++s) {
    if (!is_cavity(shells_[s])) continue;
    const auto triangle = rays.first_hit(mesh_.position(shells_[s].last),
                                         [&](std::size_t t) { return shell_of(t) != s; });
    if (triangle) hit[s] = shell_of(*triangle);
  }
  for (std::uint32_t s = 0; s < shells_.size(); ++s) {
    // Hits lead ever further along x; a mesh that crosses itself may have a circle of them.
    std::size_t n = 0;
    while (hit[solid_[s]] != kNone && n++ < shells_.size()) solid_[s] = hit[solid_[s]];
  }
}

MeshComponents Shells::components() const {
  MeshComponents out;
  std::vector<std::uint32_t> component(shells_.size(), kNone);  // of each solid
  for (std::uint32_t s = 0; s < shells_.size(); ++s) {
    std::uint32_t& c = component[solid_[s]];
    if (c == kNone) {
      c = static_cast<std::uint32_t>(out.volumes.size());
      out.volumes.push_back(0);
      out.areas.push_back(0);
    }
    out.volumes[c] += shells_[s].volume;
    out.areas[c] += shells_[s].area;
  }
  for (const std::uint32_t s : shell_) {
    out.of_vertex.push_back(s == kNone ? kNone : component[solid_[s]]);
  }
  return out;
}

}  // namespace

std::vector<std::uint8_t> select_components(std::span<const double> sizes, const KeepRule& rule) {
  std::vector<std::uint8_t> kept(sizes.size(), 0);
  if (rule.by != KeepRule::By::count) {
    std::ranges::transform(sizes, kept.begin(), [&](double size) {
      return static_cast<std::uint8_t>(size >= rule.min_size ? 1 : 0);
    });
    return kept;
  }
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto n = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(rule.n, sizes.size()));
  const auto is_larger = [&](std::size_t a, std::size_t b) {
    const double x = rounded(sizes[a]), y = rounded(sizes[b]);
    return x > y || (x == y && a < b);
  };
  std::nth_element(order.begin(), order.begin() + n, order.end(), is_larger);
  for (auto at = order.begin(); at != order.begin() + n; ++at) kept[*at] = 1;
  return kept;
}

MeshComponents find_components(const Mesh& mesh) { return Shells(mesh).components(); }

ComponentCounts keep_components(Mesh& mesh, const KeepRule& rule) {
  const MeshComponents components = find_components(mesh);
  const bool by_area = rule.by == KeepRule::By::area;
  const std::vector<std::uint8_t> kept =
      select_components(by_area ? components.areas : components.volumes, rule);
  std::vector<std::uint64_t> id(mesh.n_vertices());
  std::uint64_t n = 0;
  const auto remains = [&](std::size_t v) {
    return components.of_vertex[v] != kNone && kept[components.of_vertex[v]] != 0;
  };
  for (std::size_t v = 0; v < id.size(); ++v) id[v] = remains(v) ? n++ : n;
  Mesh out;
  const auto take = [&](const auto& from, auto& to) {
    for (std::size_t v = 0; v < from.size(); ++v) {
      if (remains(v)) to.push_back(from[v]);
    }
  };
  take(mesh.positions, out.positions);
  take(mesh.positions_f64, out.positions_f64);
  take(mesh.normals, out.normals);
  for (const VertexAttribute& attribute : mesh.attributes) {
    VertexAttribute& kept_values = out.attributes.emplace_back();
    kept_values.info = attribute.info;
    const std::size_t bytes = attribute.info.bytes();
    for (std::size_t v = 0; v < id.size(); ++v) {
      const auto* first = attribute.values.data() + v * bytes;
      if (remains(v)) kept_values.values.insert(kept_values.values.end(), first, first + bytes);
    }
  }
  for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
    const auto ids = mesh.triangle(t);
    if (remains(ids[0])) out.add_triangle({id[ids[0]], id[ids[1]], id[ids[2]]});
  }
  mesh = std::move(out);
  return {kept.size(), static_cast<std::uint64_t>(std::ranges::count(kept, 1))};
}

}  // namespace mc
