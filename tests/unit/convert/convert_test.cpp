// SPDX-License-Identifier: MIT
#include "mc/convert.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/parallel.hpp"
#include "support/mesh_stages.hpp"
#include "support/packed_bytes.hpp"
#include "support/source_files.hpp"

namespace mc {
namespace {

using test::Folder;

/// Writes a 5x5x5 raw file of bytes with one sample of 200 in the middle; returns its path.
std::string write_dot(const Folder& folder) {
  std::string samples(125, '\0');
  samples[62] = static_cast<char>(200);
  return folder.file("dot.raw", samples);
}

ConvertOptions dot_options() {
  ConvertOptions options;
  options.source.dims = {5, 5, 5};
  options.source.type = SampleType::u8;
  options.surface.isos = {{.value = 100}};
  return options;
}

class Notes final : public Progress {
 public:
  void begin(std::string_view, std::uint64_t, std::string_view) override {}
  void advance(std::uint64_t) override {}
  void note(std::string_view text) override { notes.emplace_back(text); }
  void note_remedy(std::string_view text, Remedy remedy) override {
    note(text);
    remedies.push_back(remedy);
  }
  void warn(std::string_view) override {}
  void detail(std::string_view text) override { details.emplace_back(text); }
  std::vector<std::string> notes;
  std::vector<std::string> details;
  std::vector<Remedy> remedies;
};

TEST(Convert, AMeshOfAnOctahedron) {
  const Folder folder;
  const std::string output = folder.path("dot.ply");
  const ConvertReport report = convert(write_dot(folder), output, dot_options());
  EXPECT_EQ(report.format, "ply");
  ASSERT_TRUE(report.volume);
  EXPECT_EQ(report.volume->lattice.dims(), (Index3{5, 5, 5}));
  ASSERT_TRUE(report.surface);
  EXPECT_EQ(report.surface->inside, Inside::above);
  ASSERT_EQ(report.totals.size(), 1U);
  EXPECT_EQ(report.totals[0].n_vertices, 6U);
  EXPECT_EQ(report.totals[0].n_triangles, 8U);
  EXPECT_EQ(read_mesh(output).normals.size(), 6U);
}

TEST(Convert, AttributesOfOtherVolumes) {
  const Folder folder;
  const Source heat = test::open({folder.file(
      "heat.json", R"({"format":"mc-volume","version":1,"field":"x","grid":{"cells":[2,1,1],)"
                   R"("spacing":2,"origin":[0,0,0]}})")});
  ConvertOptions options = dot_options();
  options.sink.ascii = true;
  options.normals = Normals::none;
  options.attributes = {{"heat", &heat.reader}};
  const std::string output = folder.path("dot.ply");
  convert(write_dot(folder), output, options);
  const std::string text = test::read_bytes(output);
  EXPECT_NE(text.find("property float z\nproperty float heat\nelement face"), std::string::npos);
  EXPECT_NE(text.find("\n2 2 1.5 2\n"), std::string::npos);  // vertices on both sides along z
  EXPECT_NE(text.find("\n1.5 2 2 1.5\n"), std::string::npos);
  EXPECT_NE(text.find("\n2.5 2 2 2.5\n"), std::string::npos);

  Notes notes;
  convert(std::vector{write_dot(folder)}, folder.path("dot.obj"), options, notes, {});
  EXPECT_EQ(notes.notes.front(),
            "obj cannot hold the vertex attribute heat, so it is left out; write ply, glb or gltf");
  options.attributes = {{"heat", &heat.reader}, {"nx", &heat.reader}};
  EXPECT_THROW(convert(write_dot(folder), folder.path("other.ply"), options), Error);
}

TEST(Convert, NormalsByWhatTheFormatHolds) {
  const Folder folder;
  const std::string input = write_dot(folder);
  ConvertOptions options = dot_options();
  options.normals = Normals::none;
  const std::string output = folder.path("bare.ply");
  convert(input, output, options);
  EXPECT_TRUE(read_mesh(output).normals.empty());
  convert(input, folder.path("dot.stl"), dot_options());
  EXPECT_EQ(std::filesystem::file_size(folder.path("dot.stl")), 84U + 8 * 50);
}

TEST(Convert, AVolumeByTheOutputsFormat) {
  const Folder folder;
  const std::string output = folder.path("dot.nrrd");
  ConvertOptions options = dot_options();
  options.extract.region = IndexBox{{1, 1, 1}, {3, 3, 3}};
  const ConvertReport report = convert(write_dot(folder), output, options);
  EXPECT_EQ(report.format, "nrrd");
  EXPECT_TRUE(report.totals.empty());
  const Source back = test::open({output});
  EXPECT_EQ(volume_of(back.reader).lattice.dims(), (Index3{3, 3, 3}));
}

TEST(Convert, VolumesAreTheSameForAnyThreadsAndMemory) {
  const Folder folder;
  const std::string input = folder.file(
      "noise.json", R"({"format":"mc-volume","version":1,"convention":"density",)"
                    R"("grid":{"cells":[40,30,60],"spacing":0.1},)"
                    R"("field":{"type":"fbm","octaves":3,"source":{"type":"perlin"}}})");
  const std::string output = folder.path("noise.nrrd");
  ConvertOptions options;
  options.sink.force = true;
  std::string expected;
  for (const int n_threads : {1, 2, 7}) {
    const base::ThreadLimit limit(n_threads);
    for (const std::uint64_t planes : {2, 5, 1000}) {
      options.memory_bytes = planes * 41 * 31 * sizeof(float);
      convert(input, output, options);
      const std::string bytes = test::read_bytes(output);
      if (expected.empty()) expected = bytes;
      EXPECT_GT(bytes.size(), 41U * 31 * 61 * sizeof(float));
      EXPECT_EQ(bytes == expected, true) << n_threads << " threads, " << planes << " planes";
    }
  }
}

TEST(Convert, ADryRunWritesNothing) {
  const Folder folder;
  const std::string output = folder.path("dot.ply");
  ConvertOptions options = dot_options();
  options.dry_run = true;
  const ConvertReport report = convert(write_dot(folder), output, options);
  ASSERT_TRUE(report.memory);
  EXPECT_GT(report.memory->expected, 0U);
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(Convert, StatesFactsAndLeavesOptionsToItsCaller) {
  const Folder folder;
  const std::string input = write_dot(folder);
  const std::string output = folder.path("dot.ply");
  ConvertOptions options = dot_options();
  options.surface.isos = {{.value = 201}};
  ConvertReport report;
  try {
    convert({&input, 1}, output, options, silent_progress(), {}, report);
    FAIL() << "there is no surface";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::empty);
    EXPECT_EQ(error.remedy(), Remedy::choose_iso);
    EXPECT_EQ(error.what(), input + ": no surface at iso 201: the data lie in [0, 200]");
  }
  EXPECT_EQ(report.input, input);
  EXPECT_TRUE(report.totals.empty());
  EXPECT_FALSE(std::filesystem::exists(output));

  options = dot_options();
  options.memory_bytes = 1;
  try {
    convert(input, output, options);
    FAIL() << "one byte is not enough";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::limit);
    EXPECT_EQ(error.remedy(), Remedy::more_memory);
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos);
  }
}

TEST(Convert, NotesAnOpenBorder) {
  const Folder folder;
  std::string samples(27, '\0');
  samples[4] = static_cast<char>(200);  // in the lowest plane
  const std::string input = folder.file("edge.raw", samples);
  ConvertOptions options = dot_options();
  options.source.dims = {3, 3, 3};
  Notes notes;
  convert(input, folder.path("open.ply"), options, notes);
  EXPECT_EQ(notes.remedies, std::vector{Remedy::close_border});
  EXPECT_EQ(notes.notes.back(), "the mesh is open at the volume's border: 4 boundary edges");
  options.surface.border = Border::closed;
  Notes none;
  convert(input, folder.path("closed.ply"), options, none);
  EXPECT_TRUE(none.remedies.empty());
}

/// Smoothing halves the octahedron about its centre.
TEST(Convert, AppliesStagesToTheMesh) {
  const Folder folder;
  const test::Smooth smooth(1);
  const std::array<const MeshStage*, 1> stages{&smooth};
  ConvertOptions options = dot_options();
  options.stages = stages;
  options.extract.measure = true;
  for (const char* name : {"small.ply", "small.glb", "small.obj"}) {
    SCOPED_TRACE(name);
    Notes notes;
    const std::string output = folder.path(name);
    const ConvertReport report = convert(write_dot(folder), output, options, notes);
    EXPECT_EQ(std::ranges::count(notes.details, "stages: smooth"), 1);
    EXPECT_NEAR(report.totals.at(0).volume.value(), 4.0 / 3 / 64, 1e-12);
    EXPECT_EQ(report.totals.at(0).bounds.lo, (Vec3{1.75, 1.75, 1.75}));
    const auto mesh = read_mesh(output);
    ASSERT_EQ(mesh.n_vertices(), 6U);
    ASSERT_EQ(mesh.n_triangles(), 8U);
    for (std::size_t v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 p = mesh.position(v);
      EXPECT_EQ(std::abs(p[0] - 2) + std::abs(p[1] - 2) + std::abs(p[2] - 2), 0.25);
    }
  }
}

TEST(Convert, SpoolsAStreamForStagesThatReadItTwice) {
  const Folder folder;
  const std::string input = write_dot(folder);
  const std::string packed = folder.file("dot.raw.gz", test::gzip_bytes(test::read_bytes(input)));
  const test::Smooth smooth(1);
  const test::Bend bend;
  const std::array<const MeshStage*, 1> window{&smooth};
  const std::array<const MeshStage*, 1> chunks{&bend};
  ConvertOptions options = dot_options();
  for (const MeshStages stages : {MeshStages(window), MeshStages(chunks)}) {
    options.sink.force = true;
    options.stages = stages;
    convert(input, folder.path("mapped.ply"), options);
    const ConvertReport report = convert(packed, folder.path("streamed.ply"), options);
    EXPECT_EQ(test::read_bytes(folder.path("streamed.ply")),
              test::read_bytes(folder.path("mapped.ply")));
    const auto is_spool = [](const StageTime& stage) { return stage.name == "spool"; };
    EXPECT_EQ(std::ranges::any_of(report.stages, is_spool), stages[0] == &smooth);
  }
}

TEST(Convert, BlamesTheStagesIfTheyLeaveNothing) {
  const Folder folder;
  const test::DropAll none;
  const std::array<const MeshStage*, 1> stages{&none};
  ConvertOptions options = dot_options();
  options.stages = stages;
  try {
    convert(write_dot(folder), folder.path("none.ply"), options);
    FAIL() << "nothing is left";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::empty);
    EXPECT_EQ(std::string(error.what()), "drop_all: no surface is left at this iso");
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path("none.ply")));
}

class Records final : public ScriptObserver {
 public:
  void record(const RecordReport& report) override { ops.push_back(report.op); }
  void output(const std::string& /*path*/, const ConvertReport& report) override {
    totals = report.totals;
  }
  std::vector<std::string> ops;
  std::vector<MeshTotals> totals;
};

TEST(Convert, AppliesAScript) {
  const Folder folder;
  const std::string input = write_dot(folder);
  const std::string script = folder.file(
      "edits.jsonl",
      "{\"format\":\"mc-edits\",\"version\":1}\n"
      "{\"op\":\"add\",\"shape\":{\"type\":\"sphere\",\"center\":[2,2,2],\"radius\":1.5},"
      "\"strength\":20000}\n");
  ScriptOptions options;
  options.base = dot_options();
  options.outputs.push_back({folder.path("edited.ply"), dot_options()});
  options.outputs.push_back({folder.path("edited.nrrd"), dot_options()});
  Records records;
  ScriptReport report;
  apply_script({&input, 1}, script, options, records, silent_progress(), {}, report);
  EXPECT_EQ(records.ops, std::vector<std::string>{"add"});
  EXPECT_EQ(report.n_edits, 1U);
  EXPECT_GT(report.n_changed, 0U);
  ASSERT_EQ(records.totals.size(), 1U);
  EXPECT_GT(records.totals[0].n_triangles, 8U);
  EXPECT_TRUE(std::filesystem::exists(folder.path("edited.nrrd")));
}

}  // namespace
}  // namespace mc
