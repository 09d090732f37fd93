// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "unit/sink/sink_support.hpp"

namespace mc::test {
namespace {

SinkOptions to(const std::string& format) {
  return {.to = format, .precision = {}, .provenance = {}};
}

TEST(MeshRegistry, FormatIsNamedOrTheExtension) {
  EXPECT_EQ(output_format("a/b.c/d.PLY", {}).name, "ply");
  EXPECT_EQ(output_format("d.nrrd", {}).name, "nrrd");
  EXPECT_EQ(output_format("d.ply", to("stl")).name, "stl");
  EXPECT_EQ(output_format("-", to("glb")).name, "glb");
}

TEST(MeshRegistry, UnknownFormatsListTheKnown) {
  const std::string list = "expected ply, obj, stl, glb, gltf, vdb, nrrd, raw, exr or png";
  const auto fault = [](const std::string& path, const SinkOptions& options) {
    return error_text([&] { output_format(path, options); }, ErrorKind::usage);
  };
  EXPECT_EQ(fault("a.ply", to("exe")), "--to: unknown format \"exe\": " + list);
  EXPECT_EQ(fault("a.nhdr", {}),
            "a.nhdr: unknown output format \"nhdr\": " + list + "; change it, or add --to FORMAT");
  EXPECT_EQ(fault("a.b/mesh", {}),
            "a.b/mesh: no extension that names a format: " + list + "; add one, or --to FORMAT");
  EXPECT_EQ(fault("-", {}), "<stdout>: no format given: " + list + "; add --to FORMAT");
}

TEST(MeshRegistry, KnowsWhatFormatsHold) {
  for (const char* name : {"ply", "obj", "stl", "glb", "gltf"}) {
    EXPECT_NE(find_sink_format(name)->open_mesh, nullptr) << name;
  }
  EXPECT_EQ(find_sink_format("exe"), nullptr);
  for (const char* name : {"vdb", "nrrd", "raw"}) {
    EXPECT_EQ(find_sink_format(name)->open_mesh, nullptr) << name;
    EXPECT_FALSE(find_sink_format(name)->several_objects) << name;
  }
  EXPECT_FALSE(find_sink_format("ply")->several_objects);
  EXPECT_FALSE(find_sink_format("stl")->several_objects);
  EXPECT_TRUE(find_sink_format("obj")->several_objects);
  EXPECT_TRUE(find_sink_format("glb")->several_objects);
  EXPECT_TRUE(find_sink_format("gltf")->y_up_metres);
  EXPECT_FALSE(find_sink_format("gltf")->one_file);
  EXPECT_FALSE(find_sink_format("stl")->has_normals);
}

TEST(MeshRegistry, PositionsComeAsTheFormatWants) {
  const auto needs = [](const char* format, bool moves, std::optional<Precision> asked = {}) {
    const MeshNeeds made =
        find_sink_format(format)->needs({.to = {}, .precision = asked, .provenance = {}}, moves);
    return std::pair(made.precision, made.relative_origin);
  };
  for (const char* format : {"ply", "obj", "stl", "glb", "gltf"}) {
    EXPECT_EQ(needs(format, false), std::pair(Precision::f32, false)) << format;
  }
  EXPECT_EQ(needs("ply", true), std::pair(Precision::f64, false));
  EXPECT_EQ(needs("ply", true, Precision::f32), std::pair(Precision::f32, false));
  EXPECT_EQ(needs("ply", false, Precision::f64), std::pair(Precision::f64, false));
  EXPECT_EQ(needs("obj", true), std::pair(Precision::f64, false));
  EXPECT_EQ(needs("stl", true), std::pair(Precision::f32, false));
  EXPECT_EQ(needs("glb", true), std::pair(Precision::f32, true));
  EXPECT_EQ(needs("gltf", true), std::pair(Precision::f32, true));
}

TEST(MeshRegistry, OptionsThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  const auto fault = [&](const std::string& name, const SinkOptions& options) {
    return error_text([&] { open_mesh_sink(folder / name, options); }, ErrorKind::usage);
  };
  EXPECT_EQ(fault("a.glb", {.to = {}, .ascii = true, .precision = {}, .provenance = {}}),
            "--ascii: glb has no text form; write ply, stl or obj");
  EXPECT_EQ(fault("a.stl", {.to = {}, .precision = Precision::f64, .provenance = {}}),
            "--precision: stl has one precision only; leave it out, or write ply");
  EXPECT_EQ(fault("a.vdb", {}), folder /
                                    "a.vdb: vdb holds volumes, but this is a mesh; write ply, "
                                    "obj, stl, glb or gltf");
  EXPECT_EQ(folder.n_entries(), 0U);
}

TEST(MeshRegistry, EverySinkLeavesNothingUnfinished) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.obj", "a.stl", "a.glb", "a.gltf"}) {
    const auto sink = open_mesh_sink(folder / name, {});
    const Tetrahedron mesh;
    sink->begin_object(mesh.object(false));
    sink->put(mesh.chunks(0)[0]);
    EXPECT_GE(folder.n_entries(), 1U) << name;
  }
  EXPECT_EQ(folder.n_entries(), 0U);
}

}  // namespace
}  // namespace mc::test
