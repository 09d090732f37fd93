// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "mc/convert.hpp"
#include "support/source_files.hpp"

// Attributes of vertices as they are in files: each is the field's value where the vertex is, in
// any number of threads and with the least memory.

namespace mc::test {
namespace {

/// heat is x exactly, cold is 3 - 2 y + z.
constexpr const char* kDocument = R"({"format": "mc-volume", "version": 1,
  "grid": {"cells": [40, 24, 33], "spacing": 0.5, "origin": [-9, -5, -8]}, "border": "closed",
  "field": {"type": "add", "inputs": [{"type": "perlin", "frequency": 0.3}, {"type": "mul", "inputs": [-0.1, "y"]}]},
  "attributes": {"heat": "x",
                 "cold": {"type": "add", "inputs": [3, {"type": "mul", "inputs": [-2, "y"]}, "z"]}}})";

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Holds x, y, z, heat and cold of each vertex against the fields, cut from records.
void expect_fields(const std::string& bytes, std::size_t first, std::size_t stride,
                   std::size_t n_vertices) {
  ASSERT_GT(n_vertices, 1000U);
  for (std::size_t v = 0; v < n_vertices; ++v) {
    const std::size_t record = first + v * stride;
    const auto number = [&](std::size_t n) { return double{at<float>(bytes, record + 4 * n)}; };
    ASSERT_NEAR(number(3), number(0), 1e-5) << v;
    ASSERT_NEAR(number(4), 3 - 2 * number(1) + number(2), 1e-4) << v;
  }
}

ConvertOptions options_of(std::uint64_t memory_bytes) {
  ConvertOptions options;
  options.normals = Normals::none;
  options.sink.force = true;
  options.memory_bytes = memory_bytes;
  return options;
}

TEST(Attributes, InFilesAreTheFieldsValues) {
  const Folder folder;
  const std::string input = folder.file("a.json", kDocument);
  ConvertOptions dry = options_of(std::uint64_t{1} << 30);
  dry.dry_run = true;
  for (const char* name : {"a.ply", "a.glb"}) {
    SCOPED_TRACE(name);
    const std::string output = folder.path(name);
    const std::uint64_t least = convert(input, output, dry).memory.value().least;
    std::string expected;
    for (const int n_threads : {1, 2, 7}) {
      const base::ThreadLimit limit(n_threads);
      for (const std::uint64_t memory_bytes : {std::uint64_t{1} << 30, least}) {
        const ConvertReport report = convert(input, output, options_of(memory_bytes));
        const std::string bytes = read_bytes(output);
        if (expected.empty()) {
          expected = bytes;
          const bool is_ply = std::string(name) == "a.ply";
          const std::size_t first =
              is_ply ? bytes.find("end_header\n") + 11 : 20 + at<std::uint32_t>(bytes, 12) + 8;
          expect_fields(bytes, first, 20, report.totals[0].n_vertices);
        }
        EXPECT_TRUE(bytes == expected) << n_threads << " threads, " << memory_bytes << " bytes";
      }
    }
  }
}

}  // namespace
}  // namespace mc::test
