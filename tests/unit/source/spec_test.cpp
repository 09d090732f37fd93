// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "fuzz/replay_spec.hpp"
#include "source/mapped_file.hpp"
#include "source/spec/spec.hpp"
#include "support/places.hpp"

// The mc-volume loader: what its documents mean, and the full text of every fault.

namespace mc::tests {
namespace {

using source::open_spec_text;
using testing::ElementsAre;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> faults_of(const std::string& text) {
  try {
    open_spec_text("v.json", text);
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.lines();
  }
}

/// A document on one line, with `rest` from column 77 on.
std::string document(const std::string& rest) {
  return R"({"format": "mc-volume", "version": 1, "grid": {"cells": [2, 2, 2]}, "x-": 0, )" + rest +
         "}";
}

std::vector<float> samples_of(const SlabReader& reader) {
  const Index3 dims = reader.volume().lattice.dims();
  Slab slab;
  reader.read(0, dims[2], slab);
  std::vector<float> out(slab.storage.size() / sizeof(float));
  std::memcpy(out.data(), slab.storage.data(), slab.storage.size());
  return out;
}

std::unique_ptr<SlabReader> open_spec(const std::string& path) {
  const source::MappedFile file(path);
  return source::open_spec_text(file.place(), file.text());
}

std::filesystem::path data_folder() { return test::source_file("data"); }

TEST(Spec, MaterialIsTheNearestIndex) {
  const auto reader = open_spec_text(
      "v.json",
      document(
          R"("field": "x", "material": {"type": "add", "inputs": ["x", {"type": "div", "a": "y", "b": "z"}]})"));
  ASSERT_EQ(reader->attributes().size(), 1U);
  EXPECT_EQ(reader->attributes()[0]->info(), material_attribute());
  const std::vector<Vec3> places{{2.4, 0, 1}, {2.6, 0, 1},   {65535.4, 0, 1}, {-0.4, 0, 1},
                                 {-1, 0, 1},  {70000, 0, 1}, {3, 0, 0},       {3, 1, 0}};
  std::vector<std::uint16_t> out(places.size());
  EXPECT_EQ(reader->attributes()[0]->values_at(places, reinterpret_cast<std::byte*>(out.data())),
            4U);
  EXPECT_THAT(out, ElementsAre(2, 3, 65535, 0, 0, 65535, 0, 65535));
  EXPECT_TRUE(open_spec_text("v.json", document(R"("field": "x")"))->attributes().empty());
}

TEST(Spec, MaterialSeesTheWorld) {
  const auto reader = open_spec_text(
      "v.json", R"({"format": "mc-volume", "version": 1, "field": "x", "material": "y",
                    "grid": {"cells": [2, 2, 2], "spacing": [1, 2, 1], "origin": [0, 10, 0]}})");
  std::vector<std::uint16_t> out(1);
  reader->attributes()[0]->values_at(std::vector<Vec3>{{0, 1.5, 0}},
                                     reinterpret_cast<std::byte*>(out.data()));
  EXPECT_EQ(out[0], 13);
}

TEST(Spec, DemoTerrainHasTheKnownCounts) {
  const auto reader = open_spec((data_folder() / "specs/demo-terrain.json").string());
  const Volume& volume = reader->volume();
  EXPECT_EQ(volume.lattice.dims(), (Index3{21, 11, 21}));
  EXPECT_EQ(volume.cls, VolumeClass::sdf_spec);
  EXPECT_EQ(volume.iso, 0.5);
  EXPECT_EQ(volume.border, Border::open);
  const auto values = samples_of(*reader);
  const auto inside = [&](std::size_t i, std::size_t j, std::size_t k) {
    return values[(k * 11 + j) * 21 + i] < 0.5F;
  };
  EXPECT_EQ(std::count_if(values.begin(), values.end(), [](float v) { return v < 0.5F; }), 1285);
  int n_active = 0;
  double lowest = 99;
  double highest = 0;
  for (std::size_t k = 0; k < 21; ++k) {
    for (std::size_t i = 0; i < 21; ++i) {
      for (std::size_t j = 0; j < 10; ++j) {
        if (inside(i, j, k) && !inside(i, j + 1, k)) {
          const float a = values[(k * 11 + j) * 21 + i];
          const float b = values[(k * 11 + j + 1) * 21 + i];
          const double height = static_cast<double>(j) + (0.5 - a) / (b - a);
          lowest = std::min(lowest, height);
          highest = std::max(highest, height);
        }
        int n = 0;
        for (std::size_t c = 0; c < 8 && i < 20 && k < 20; ++c) {
          n += inside(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2)) ? 1 : 0;
        }
        n_active += n % 8 != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(n_active, 578);
  EXPECT_NEAR(lowest, 1.507, 5e-4);
  EXPECT_NEAR(highest, 4.402, 5e-4);
}

TEST(Spec, EveryShippedDocumentLoads) {
  int n_documents = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "specs")) {
    if (entry.path().extension() != ".json") {
      continue;
    }
    ++n_documents;
    if (!MC_WITH_PNG && entry.path().stem() == "heightmap") {
      std::cout << "[          ] heightmap.json is left out: built without PNG\n";
      continue;
    }
    const auto reader = open_spec(entry.path().string());
    Slab slab;
    const std::int32_t middle = reader->volume().lattice.dims()[2] / 2;
    reader->read(middle, middle + 1, slab);
    const auto* first = reinterpret_cast<const float*>(slab.planes.front());
    const std::size_t n = slab.storage.size() / sizeof(float);
    const double iso = *reader->volume().iso;
    const auto above = std::count_if(first, first + n, [&](float v) { return v >= iso; });
    EXPECT_GT(above, 0) << entry.path();
    EXPECT_LT(above, static_cast<std::ptrdiff_t>(n)) << entry.path();
  }
  EXPECT_GE(n_documents, 14);
}

TEST(Spec, TheExampleOfTheManPageLoads) {
  const std::string page = text_of(test::source_file("man/mc-volume.5.md"));
  const std::string fence = "```json\n";
  const std::size_t begin = page.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = page.find("```", begin + fence.size());
  const auto reader =
      open_spec_text("page", page.substr(begin + fence.size(), end - begin - fence.size()));
  EXPECT_EQ(reader->volume().lattice.dims(), (Index3{257, 129, 257}));
  EXPECT_EQ(reader->volume().border, Border::closed);
  Slab slab;
  reader->read(128, 129, slab);
  float middle = 0;  // the sphere's centre: carved out of the ground
  std::memcpy(&middle, slab.planes[0] + 64 * slab.row_stride_bytes + 128 * sizeof(float), 4);
  EXPECT_LT(middle, 0.0F);
  std::memcpy(&middle, slab.planes[0] + 128 * sizeof(float), 4);  // the floor is solid
  EXPECT_GT(middle, 0.0F);
}

TEST(Spec, SlabsAgreeWithTheWhole) {
  const auto reader = open_spec((data_folder() / "specs/torus.json").string());
  const auto whole = samples_of(*reader);
  Slab slab;
  reader->read(5, 7, slab);
  EXPECT_EQ(slab.k0, 5);
  ASSERT_EQ(slab.planes.size(), 2U);
  EXPECT_EQ(std::memcmp(slab.planes[1], &whole[6 * 97 * 97], 97 * 97 * sizeof(float)), 0);
}

TEST(Spec, GridGoesIntoTheLattice) {
  const auto reader = open_spec_text("v.json", R"({"format": "mc-volume", "version": 1, "grid":
      {"samples": [2, 3, 4], "spacing": [1, 2, 3], "origin": [10, 20, 30]}, "field": "y"})");
  const Volume& volume = reader->volume();
  EXPECT_EQ(volume.lattice.dims(), (Index3{2, 3, 4}));
  EXPECT_EQ(volume.lattice.to_world, Affine::scale_translate({1, 2, 3}, {10, 20, 30}));
  EXPECT_EQ(volume.cls, VolumeClass::density_spec);
  EXPECT_EQ(volume.iso, 0.0);
  EXPECT_EQ(volume.border, std::nullopt);
  EXPECT_EQ(volume.units, Units::m);
  EXPECT_EQ(samples_of(*reader)[2 * 2], 24.0F);
}

TEST(Spec, ContentIsRecognised) {
  EXPECT_TRUE(source::looks_like_spec(" \n{ \"format\": \"mc-volume\""));
  EXPECT_TRUE(source::looks_like_spec("\xEF\xBB\xBF{\"format\":\"mc-volume\""));
  EXPECT_FALSE(source::looks_like_spec("{\"format\": \"mc-edits\"}"));
  EXPECT_FALSE(source::looks_like_spec("mc-volume"));
  EXPECT_FALSE(source::looks_like_spec(""));
}

TEST(SpecFaults, AllAreReportedAtOnceInTheOrderOfTheText) {
  EXPECT_THAT(faults_of("{\n \"format\": \"mc-volume\", \"version\": 2,\n \"seed\": -1,\n"
                        " \"grid\": {\"cells\": [0, 4, 4], \"spacing\": 0},\n \"feild\": 3}"),
              ElementsAre("v.json:1:1: has no \"field\": an mc-volume document needs it",
                          "v.json:2:36: /version: is 2: expected 1",
                          "v.json:3:10: /seed: is -1: expected an integer from 0 to 4294967295",
                          "v.json:4:21: /grid/cells/0: is 0: expected an integer from 1 to "
                          "2147483646",
                          "v.json:4:42: /grid/spacing: is 0: expected a number above 0",
                          "v.json:5:2: /feild: unknown key of an mc-volume document; did you mean "
                          "\"field\"?"));
}

TEST(SpecFaults, TwentyAtMost) {
  std::string many;
  for (int n = 0; n < 30; ++n) {
    many += "\"k" + std::to_string(n) + "\": 0, ";
  }
  const auto lines = faults_of(document(many + "\"field\": 1"));
  ASSERT_EQ(lines.size(), 20U);
  EXPECT_EQ(lines.back(), "v.json: 11 more faults; correct those above first");
}

struct Case {
  const char* rest;
  const char* fault;
};

TEST(SpecFaults, HaveTheseTexts) {
  const Case cases[] = {
#include "unit/source/spec_faults.inc"
  };
  for (const Case& c : cases) {
    EXPECT_THAT(faults_of(document(c.rest)), ElementsAre(c.fault)) << c.rest;
  }
}

TEST(SpecFaults, ColumnsCountCharacters) {
  EXPECT_THAT(faults_of("{\"x-ä\": \"日本\", \"?\": 1, " + document("\"field\": 1").substr(1)),
              ElementsAre(testing::StartsWith("v.json:1:15: /?: unknown key")));
}

TEST(SpecFaults, ManyNodesAndLongChainsAreRefused) {
  std::string inputs = "0";
  for (int n = 0; n < 10001; ++n) {
    inputs += ",0";
  }
  EXPECT_THAT(
      faults_of(document(R"("field": {"type": "add", "inputs": [)" + inputs + "]}")),
      ElementsAre(testing::EndsWith("is one node more than the 10000 that a document may hold")));
  EXPECT_THAT(faults_of(text_of(data_folder() / "corpus/spec/long-chain.json")),
              ElementsAre(testing::EndsWith("nodes nest deeper than 256 levels here")));
}

TEST(SpecFaults, CorpusIsReplayed) {
  int n_texts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / "corpus/spec")) {
    const std::string name = entry.path().filename().string();
    const bool expected = name.starts_with("good-") || name == "byte-order-mark.json";
    EXPECT_EQ(replay_spec(text_of(entry.path())), expected) << name;
    ++n_texts;
  }
  EXPECT_GT(n_texts, 40);
}

TEST(SpecFaults, EveryCutAndManyDamagesOfAGoodDocumentEndWell) {
  const std::string good = text_of(data_folder() / "corpus/spec/good-everything.json");
  const std::size_t end = good.rfind('}');
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_EQ(replay_spec(good.substr(0, n)), n > end);
    std::string damaged = good;
    damaged[n] = static_cast<char>(damaged[n] ^ (1 << (n % 8)));
    replay_spec(damaged);
  }
}

TEST(Spec, MissingFileIsAnInputError) {
  try {
    open_spec("/nowhere/v.json");
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(), "/nowhere/v.json: cannot open: No such file or directory");
  }
}

}  // namespace
}  // namespace mc::tests
