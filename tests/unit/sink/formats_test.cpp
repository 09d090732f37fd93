// SPDX-License-Identifier: MIT
#include "sink/formats.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <sstream>

#include "base/text.hpp"
#include "unit/sink/sink_support.hpp"

// The rows of formats that are written, those of the library and one of an embedder.

namespace mc::test {
namespace {

TEST(SinkFormats, RowsAreUniqueAndComplete) {
  std::set<std::string> names, extensions;
  for (const SinkFormat* format : sink_formats()) {
    EXPECT_TRUE(names.emplace(format->name).second) << format->name;
    EXPECT_TRUE(base::has_word(format->extensions, format->name)) << format->name;
    std::istringstream words{std::string(format->extensions)};
    for (std::string word; words >> word;) EXPECT_TRUE(extensions.insert(word).second) << word;
    EXPECT_FALSE(format->display.empty()) << format->name;
    EXPECT_TRUE(format->built_in || !format->package.empty()) << format->name;
    EXPECT_TRUE(format->open_mesh || format->open_volume || format->open_picture) << format->name;
    EXPECT_EQ(format->open_mesh == nullptr, format->needs == nullptr) << format->name;
    EXPECT_EQ(find_sink_format(format->name), format);
  }
  EXPECT_EQ(find_sink_format(""), nullptr);
}

TEST(SinkFormats, ExtensionsFindTheirRow) {
  for (const SinkFormat* format : sink_formats()) {
    std::istringstream words{std::string(format->extensions)};
    for (std::string word; words >> word;) EXPECT_EQ(&output_format("a." + word, {}), format);
  }
}

TEST(SinkFormats, UsualOnesAreThere) {
  EXPECT_EQ(usual_mesh_format().name, "glb");
  EXPECT_EQ(usual_volume_format().name, "nrrd");
}

TEST(SinkFormats, RefusalsNameThePackageAndAnotherFormat) {
  const auto refusal = [](const char* name) {
    return error_text([&] { sink::refuse_absent(*find_sink_format(name), "a.x"); },
                      ErrorKind::usage);
  };
  EXPECT_EQ(refusal("gltf"),
            "a.x: this build cannot write glTF; install libtinygltf-dev and build again, or write "
            ".ply");
  EXPECT_EQ(refusal("vdb"),
            "a.x: this build cannot write VDB; install libopenvdb-dev and build again, or write "
            ".nrrd");
  EXPECT_EQ(refusal("exr"),
            "a.x: this build cannot write OpenEXR; install libopenexr-dev and build again, or "
            "write .nrrd");
  EXPECT_EQ(refusal("png"),
            "a.x: this build cannot write PNG; install libpng-dev and build again, or write .nrrd");
}

// An embedder's format: the number of vertices, then their positions.
class PointSink final : public MeshSink {
 public:
  PointSink(const std::string& path, const SinkOptions& options) : out_(path, options) {}
  void begin_object(const MeshObject& /*object*/) override { put_count(); }
  void place(const MeshChunk& chunk, std::size_t /*slot*/) override {
    n_vertices_ += static_cast<std::uint32_t>(chunk.n_vertices());
    out_.write(std::as_bytes(std::span(chunk.positions)));
  }
  void end_object(const MeshTotals& /*totals*/) override {
    if (out_.seekable()) out_.patch(0, std::as_bytes(std::span(&n_vertices_, 1)));
  }
  void finish() override { out_.finish(); }

 private:
  void put_count() { out_.write(std::as_bytes(std::span(&n_vertices_, 1))); }

  OutputStream out_;
  std::uint32_t n_vertices_ = 0;
};

std::unique_ptr<MeshSink> open_points(const std::string& path, const SinkOptions& options) {
  return std::make_unique<PointSink>(path, options);
}

constexpr SinkFormat kPoints{.name = "points",
                             .display = "points",
                             .extensions = "points pts",
                             .open_mesh = open_points,
                             .needs = [](const SinkOptions& /*options*/, bool moves) {
                               return MeshNeeds{Precision::f32, moves, {}};
                             }};
constexpr std::array<const SinkFormat*, 1> kFurther{&kPoints};

SinkOptions further(const std::string& to = {}) {
  SinkOptions options;
  options.to = to;
  options.further_formats = kFurther;
  return options;
}

void write_points(const std::string& path, const SinkOptions& options) {
  const auto sink = open_mesh_sink(path, options);
  const Tetrahedron mesh;
  sink->begin_object(mesh.object(false));
  for (const MeshChunk& chunk : mesh.chunks(1)) sink->put(chunk);
  sink->end_object(Tetrahedron::totals());
  sink->finish();
}

TEST(FurtherSink, IsChosenByExtensionAndName) {
  const TemporaryFolder folder;
  write_points(folder / "a.pts", further());
  const std::string bytes = read_all(folder / "a.pts");
  EXPECT_EQ(bytes.size(), 4 + 4 * 12);
  EXPECT_EQ(bytes[0], 4);
  write_points(folder / "b.ply", further("points"));
  EXPECT_EQ(read_all(folder / "b.ply"), bytes);
  EXPECT_TRUE(find_sink_format("points", kFurther)->needs({}, true).relative_origin);
  EXPECT_EQ(find_sink_format("points"), nullptr);
}

TEST(FurtherSink, GoesThroughAPipe) {
  const std::string bytes =
      through_fifo([](const std::string& path) { write_points(path, further("points")); });
  EXPECT_EQ(bytes.size(), 4 + 4 * 12);
  EXPECT_EQ(bytes[0], 0);  // a count that comes first cannot be patched
}

TEST(FurtherSink, LeavesNothingUnfinishedAndReplacesNothing) {
  const TemporaryFolder folder;
  {
    const auto sink = open_mesh_sink(folder / "a.pts", further());
    EXPECT_EQ(folder.n_entries(), 1U);
  }
  EXPECT_EQ(folder.n_entries(), 0U);
  write_all(folder / "a.pts", "old");
  EXPECT_EQ(error_text([&] { open_mesh_sink(folder / "a.pts", further()); }, ErrorKind::output),
            folder / "a.pts: exists; add --force to replace it");
  EXPECT_EQ(read_all(folder / "a.pts"), "old");
}

TEST(FurtherSink, IsListedInMessages) {
  const auto fault = [](const std::string& path, const SinkOptions& options) {
    return error_text([&] { open_mesh_sink(path, options); }, ErrorKind::usage);
  };
  EXPECT_EQ(fault("a.exe", further()),
            "a.exe: unknown output format \"exe\": expected ply, obj, stl, glb, gltf, vdb, nrrd, "
            "raw, exr, png or points; change it, or add --to FORMAT");
  EXPECT_EQ(fault("a.vdb", further()),
            "a.vdb: vdb holds volumes, but this is a mesh; write ply, obj, stl, glb, gltf or "
            "points");
  SinkOptions ascii = further();
  ascii.ascii = true;
  EXPECT_EQ(fault("a.pts", ascii), "--ascii: points has no text form; write ply, stl or obj");
}

TEST(OutputStream, WritesToMemory) {
  Buffer<std::byte> memory;
  SinkOptions options;
  options.memory = &memory;
  OutputStream out("name", options);
  out.write("hello");
  EXPECT_EQ(out.size(), 5U);
  out.patch(0, std::as_bytes(std::span("j", 1)));
  out.finish();
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(memory.data()), memory.size()), "jello");
}

}  // namespace
}  // namespace mc::test
