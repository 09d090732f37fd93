// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "support/mesh_collector.hpp"

// Collected meshes put together and compared.

namespace mc::test {

template <class Row>
void expect_same_bytes(const Row& got, const Row& want) {
  ASSERT_EQ(got.size(), want.size());
  ASSERT_TRUE(got.empty() || std::memcmp(got.data(), want.data(), got.size() * sizeof got[0]) == 0);
}

inline void expect_same_mesh(const Collected& got, const Collected& want) {
  expect_same_bytes(got.mesh.positions, want.mesh.positions);
  expect_same_bytes(got.mesh.positions_f64, want.mesh.positions_f64);
  expect_same_bytes(got.mesh.normals, want.mesh.normals);
  expect_same_bytes(got.mesh.triangles, want.mesh.triangles);
  ASSERT_EQ(got.totals.n_vertices, want.totals.n_vertices);
  ASSERT_EQ(got.totals.n_triangles, want.totals.n_triangles);
}

/// Puts a part's mesh behind those before it, and adds up the counts.
inline void append_mesh(const Collected& part, Collected& all) {
  const auto first = static_cast<std::uint32_t>(all.totals.n_vertices);
  const auto add = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(part.mesh.positions, all.mesh.positions);
  add(part.mesh.positions_f64, all.mesh.positions_f64);
  add(part.mesh.normals, all.mesh.normals);
  for (const auto& t : part.mesh.triangles) {
    all.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  all.totals.n_vertices += part.totals.n_vertices;
  all.totals.n_triangles += part.totals.n_triangles;
}

}  // namespace mc::test
