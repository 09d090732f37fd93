// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "mc/pipe.hpp"
#include "sink/gltf/gltf_sink.hpp"
#include "sink/ply/ply_sink.hpp"
#include "sink/stl/stl_sink.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "unit/sink/sink_support.hpp"

// What formats cannot hold, with limits of some thousands instead of thousands of millions: nothing
// else knows them. A limit is found in the counts, where there are any, and nothing is made then;
// else in the chunk that is too much.

namespace mc::test {
namespace {

constexpr Index3 kDims{24, 20, 40};

VolumeReader noise() {
  return owned(std::make_unique<MemorySlabs>(random_field<float>(kDims, Noise::white, 7), kDims));
}

/// The stages of a run.
class Stages final : public Progress {
 public:
  void begin(std::string_view stage, std::uint64_t /*total*/, std::string_view /*unit*/) override {
    all.emplace_back(stage);
  }
  void advance(std::uint64_t /*done*/) override {}
  void note(std::string_view /*text*/) override {}
  void warn(std::string_view /*text*/) override {}
  std::vector<std::string> all;
};

SinkOptions forced() {
  SinkOptions options;
  options.force = true;
  return options;
}

using Open = std::function<std::unique_ptr<MeshSink>(const std::string& path)>;

MeshTotals write(const Open& open, const std::string& path, CountFirst count_first,
                 Progress& progress = silent_progress()) {
  RunOptions options;
  options.extract.iso = test_iso<float>();
  options.extract.normals = Normals::none;
  options.slab_layers = 2;
  options.count_first = count_first;
  const std::unique_ptr<MeshSink> sink = open(path);
  const MeshTotals totals = run(noise(), options, false, *sink, progress, {});
  sink->finish();
  return totals;
}

/// A format with a limit in numbers of something; `size` is what the noise has of it.
struct Limited {
  std::string name, remedy;
  std::uint64_t size;
  std::function<std::unique_ptr<MeshSink>(const std::string&, std::uint64_t)> open;

  [[nodiscard]] Open within(std::uint64_t most) const {
    return [this, most](const std::string& path) { return open(path, most); };
  }
};

std::vector<Limited> all_limited() {
  const TemporaryFolder folder;
  const MeshTotals mesh = write([](const std::string& path) { return sink::open_ply(path, {}); },
                                folder / "m.ply", CountFirst::no);
  std::vector<Limited> all{
      {"m.ply", "; write .obj, or one --region at a time", mesh.n_vertices,
       [](const std::string& path, std::uint64_t most) {
         return sink::open_ply_of(path, forced(),
                                  {.most_vertices = most, .most_int_vertices = most});
       }},
      {"m.stl", "; write .ply or .obj, or one --region at a time", mesh.n_triangles,
       [](const std::string& path, std::uint64_t most) {
         return sink::open_stl_of(path, forced(), most);
       }}};
#if MC_WITH_GLTF
  write([](const std::string& path) { return sink::open_glb(path, {}); }, folder / "m.glb",
        CountFirst::no);
  all.push_back({"m.glb", "; write .gltf or .ply", read_all(folder / "m.glb").size(),
                 [](const std::string& path, std::uint64_t most) {
                   return sink::open_glb_of(path, forced(), most);
                 }});
#endif
  return all;
}

TEST(FormatLimits, AreFoundInTheCountsBeforeTheWork) {
  for (const Limited& format : all_limited()) {
    const TemporaryFolder folder;
    Stages stages;
    const std::string text = error_text(
        [&] {
          write(format.within(format.size - 1), folder / format.name, CountFirst::yes, stages);
        },
        ErrorKind::limit);
    EXPECT_TRUE(text.starts_with(folder / format.name)) << text;
    EXPECT_TRUE(text.ends_with(format.remedy)) << text;
    EXPECT_EQ(stages.all, std::vector<std::string>{"count"}) << format.name;
    EXPECT_EQ(folder.n_entries(), 0U) << format.name;
  }
}

TEST(FormatLimits, AreFoundWhenTheyAreReached) {
  for (const Limited& format : all_limited()) {
    for (const std::uint64_t most : {format.size / 2, format.size - 1}) {
      const TemporaryFolder folder;
      Stages stages;
      const std::string text = error_text(
          [&] { write(format.within(most), folder / format.name, CountFirst::no, stages); },
          ErrorKind::limit);
      EXPECT_TRUE(text.starts_with(folder / format.name)) << text;
      EXPECT_TRUE(text.ends_with(format.remedy)) << text;
      EXPECT_EQ(stages.all, std::vector<std::string>{"extract"}) << format.name;
      EXPECT_EQ(folder.n_entries(), 0U) << format.name;
    }
  }
}

TEST(FormatLimits, HoldWhatTheyAllow) {
  for (const Limited& format : all_limited()) {
    for (const CountFirst count_first : {CountFirst::no, CountFirst::yes}) {
      const TemporaryFolder folder;
      write(format.within(format.size), folder / format.name, count_first);
      EXPECT_EQ(folder.n_entries(), 1U) << format.name;
    }
  }
}

TEST(FormatLimits, LeaveAnOldFileAlone) {
  for (const Limited& format : all_limited()) {
    for (const CountFirst count_first : {CountFirst::no, CountFirst::yes}) {
      const TemporaryFolder folder;
      write_all(folder / format.name, "old");
      const Open open = format.within(format.size / 2);
      EXPECT_TRUE(
          error_text([&] { write(open, folder / format.name, count_first); }, ErrorKind::limit)
              .ends_with(format.remedy));
      EXPECT_EQ(read_all(folder / format.name), "old");
      EXPECT_EQ(folder.n_entries(), 1U) << format.name;
    }
  }
}

TEST(FormatLimits, OfIntIndicesMakeThemUnsigned) {
  const TemporaryFolder folder;
  const auto written_with = [&](std::uint64_t most_int_vertices) {
    const auto open = [&](const std::string& path) {
      return sink::open_ply_of(path, forced(), {.most_int_vertices = most_int_vertices});
    };
    const MeshTotals totals = write(open, folder / "m.ply", CountFirst::no);
    return std::pair(read_all(folder / "m.ply"), totals.n_vertices);
  };
  const auto [whole, n] = written_with(std::uint64_t{1} << 31U);
  EXPECT_NE(whole.find("property list uchar int vertex_indices"), std::string::npos);
  EXPECT_EQ(written_with(n).first, whole);
  const std::string wide = written_with(n - 1).first;
  EXPECT_NE(wide.find("property list uchar uint vertex_indices"), std::string::npos);
  const auto body = [](const std::string& ply) { return ply.substr(ply.find("end_header")); };
  EXPECT_EQ(body(wide), body(whole));
}

}  // namespace
}  // namespace mc::test
