// SPDX-License-Identifier: MIT
#include "support/mesh_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace mc::test {

namespace {

bool finite(const Vec3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// Twice the vector area, in the widest type at hand.
std::array<long double, 3> vector_area(const Vec3& p, const Vec3& q, const Vec3& r) {
  std::array<long double, 3> a{};
  std::array<long double, 3> b{};
  for (std::size_t n = 0; n < 3; ++n) {
    a[n] = static_cast<long double>(q[n]) - static_cast<long double>(p[n]);
    b[n] = static_cast<long double>(r[n]) - static_cast<long double>(p[n]);
  }
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Groups of items that links join, found by flooding.
template <class Item>
std::uint64_t count_groups(const std::map<Item, std::set<Item>>& links) {
  std::set<Item> seen;
  std::uint64_t n = 0;
  for (const auto& [start, ignored] : links) {
    if (seen.contains(start)) {
      continue;
    }
    ++n;
    std::vector<Item> ahead{start};
    while (!ahead.empty()) {
      const Item item = ahead.back();
      ahead.pop_back();
      if (seen.insert(item).second) {
        ahead.insert(ahead.end(), links.at(item).begin(), links.at(item).end());
      }
    }
  }
  return n;
}

}  // namespace

MeshOracle::MeshOracle(const Mesh& mesh) {
  report_.n_vertices = mesh.n_vertices();
  report_.n_triangles = mesh.n_triangles();
  look_at_vertices(mesh);
  sort_out_triangles(mesh);
  measure(mesh);
  count_edges();
  count_fans();
  count_components();
}

void MeshOracle::look_at_vertices(const Mesh& mesh) {
  std::set<Vec3> known;
  for (std::size_t v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 p = mesh.position(v);
    bool good = finite(p);
    if (good) {
      report_.bounds.include(p);
      report_.duplicate_vertices += known.insert(p).second ? 0 : 1;
    }
    for (std::size_t n = 0; !mesh.normals.empty() && n < 3; ++n) {
      good = good && std::isfinite(mesh.normals[v][n]);
    }
    report_.not_finite += good ? 0 : 1;
  }
}

void MeshOracle::sort_out_triangles(const Mesh& mesh) {
  std::set<Triangle> known;
  for (std::size_t n = 0; n < mesh.n_triangles(); ++n) {
    const Triangle t = mesh.triangle(n);
    if (*std::ranges::max_element(t) >= mesh.n_vertices()) {
      ++report_.out_of_range;
      continue;
    }
    Triangle sorted = t;
    std::ranges::sort(sorted);
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) {
      ++report_.degenerate;
      continue;
    }
    report_.duplicate += known.insert(sorted).second ? 0 : 1;
    proper_.push_back(t);
    for (const std::uint64_t v : t) {
      around_[v].push_back(t);
    }
  }
  report_.unreferenced_vertices = mesh.n_vertices() - around_.size();
}

void MeshOracle::measure(const Mesh& mesh) {
  long double area = 0;
  long double volume = 0;
  for (const Triangle& t : proper_) {
    const Vec3 p = mesh.position(t[0]);
    const Vec3 q = mesh.position(t[1]);
    const Vec3 r = mesh.position(t[2]);
    if (!finite(p) || !finite(q) || !finite(r)) {
      continue;
    }
    const auto n = vector_area(p, q, r);
    const long double twice = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    report_.degenerate += twice == 0 ? 1 : 0;
    area += twice / 2;
    for (std::size_t a = 0; a < 3; ++a) {
      volume += (static_cast<long double>(p[a]) -
                 static_cast<long double>(report_.bounds.lo[a] + report_.bounds.hi[a]) / 2) *
                n[a] / 6;
    }
  }
  report_.area = static_cast<double>(area);
  report_.volume = static_cast<double>(volume);
}

void MeshOracle::count_edges() {
  std::map<std::pair<std::uint64_t, std::uint64_t>, int> directed;
  std::set<std::pair<std::uint64_t, std::uint64_t>> edges;
  for (const Triangle& t : proper_) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint64_t a = t[c];
      const std::uint64_t b = t[(c + 1) % 3];
      ++directed[{a, b}];
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  for (const auto& [a, b] : edges) {
    const int there = directed[{a, b}];
    const int back = directed[{b, a}];
    report_.boundary_edges += there + back == 1 ? 1 : 0;
    report_.nonmanifold_edges += there + back > 2 ? 1 : 0;
    report_.misoriented_edges += there + back == 2 && there != back ? 1 : 0;
  }
  report_.euler = static_cast<std::int64_t>(around_.size()) -
                  static_cast<std::int64_t>(edges.size()) +
                  static_cast<std::int64_t>(proper_.size());
}

void MeshOracle::count_fans() {
  for (const auto& [v, triangles] : around_) {
    // Every triangle joins its other two vertices; what is joined is one fan.
    std::map<std::uint64_t, std::set<std::uint64_t>> links;
    for (const Triangle& t : triangles) {
      for (const std::uint64_t a : t) {
        for (const std::uint64_t b : t) {
          if (a != v && b != v) {
            links[a].insert(b);
          }
        }
      }
    }
    report_.nonmanifold_vertices += count_groups(links) > 1 ? 1 : 0;
  }
}

void MeshOracle::count_components() {
  std::map<std::uint64_t, std::set<std::uint64_t>> links;
  for (const Triangle& t : proper_) {
    for (const std::uint64_t a : t) {
      links[a].insert(t.begin(), t.end());
    }
  }
  report_.components = count_groups(links);
}

}  // namespace mc::test
