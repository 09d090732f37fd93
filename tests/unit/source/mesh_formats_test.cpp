// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "fuzz/mesh_input.hpp"
#include "mc/source.hpp"
#include "support/mesh_files.hpp"
#include "support/places.hpp"

// What holds for every format: the same tetrahedron comes out, however a file is cut or damaged
// nothing but an Error does, and content goes before the name.

namespace mc {
namespace {

std::span<const std::byte> bytes_in(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mc-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error("cannot make a scratch folder");
    }
    path_ = name;
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, std::string_view content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

TEST(ReadMesh, EveryFormatGivesTheTetrahedron) {
  const ScratchFolder folder;
  for (const auto& [name, content] : test::small_mesh_files()) {
    SCOPED_TRACE(name);
    const MeshReport r = check_mesh(read_mesh(folder.write(name, content)));
    EXPECT_EQ(r.n_vertices, 4U);
    EXPECT_EQ(r.n_triangles, 4U);
    EXPECT_DOUBLE_EQ(r.volume, 1. / 6);
    EXPECT_FALSE(r.defective(true));
  }
}

TEST(ReadMesh, ContentGoesBeforeTheName) {
  const ScratchFolder folder;
  for (const auto& [name, content] : test::small_mesh_files()) {
    SCOPED_TRACE(name);
    for (const char* const other : {"mesh.stl", "mesh.PLY", "mesh", "mesh.obj"}) {
      EXPECT_EQ(read_mesh(folder.write(other, content)).triangles.size(), 4U) << other;
    }
  }
}

TEST(ReadMesh, GltfWithItsBufferBesideIt) {
  const ScratchFolder folder;
  folder.write("a b.bin", test::tetrahedron_gltf_buffer());
  const std::string path =
      folder.write("mesh.gltf", test::tetrahedron_gltf(R"(, "uri": "a%20b.bin")"));
  EXPECT_EQ(read_mesh(path).triangles, test::tetrahedron().triangles);
}

TEST(ReadMesh, MissingAndEmptyFilesAreInputFaults) {
  const ScratchFolder folder;
  const std::string empty = folder.write("empty.ply", "");
  try {
    read_mesh(empty);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.what(), empty + ": is empty");
  }
  EXPECT_THROW(read_mesh(empty + ".gone"), Error);
}

TEST(ReadMesh, AnythingElseIsRefused) {
  try {
    source::parse_mesh({.bytes = bytes_in("hello, world\n"), .place = "x", .folder = {}}, "");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "x: is no mesh of a known format: expected PLY, OBJ, STL, glTF or GLB");
  }
}

TEST(ReadMesh, EveryCutThrowsOrReads) {
  for (const auto& [name, content] : test::small_mesh_files()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(test::read_and_check_mesh(bytes_in(content)));
    std::size_t n_readable = 0;
    for (std::size_t size = 0; size < content.size(); ++size) {
      // A copy of its own, so that a sanitiser sees a read past the end.
      const std::vector<char> cut(content.begin(),
                                  content.begin() + static_cast<std::ptrdiff_t>(size));
      n_readable += test::read_and_check_mesh(std::as_bytes(std::span(cut))) ? 1 : 0;
    }
    // Text can lose its last line's end, STL part of the last name, OBJ whole lines; and the first
    // letter of "ply" or "solid" is an OBJ without triangles.
    const std::size_t n_allowed = name == "tetrahedron.obj" ? content.size()
                                  : name == "text.stl"      ? std::strlen("s by hand\n")
                                  : name == "text.ply"      ? std::strlen("p\n")
                                                            : 1;
    EXPECT_LE(n_readable, n_allowed);
  }
}

TEST(ReadMesh, DamagedBytesThrowOrRead) {
  for (const auto& [name, content] : test::small_mesh_files()) {
    SCOPED_TRACE(name);
    std::mt19937 random(7);
    std::size_t n_readable = 0;
    for (int n = 0; n < 300; ++n) {
      std::string damaged = content;
      for (int k = 0; k <= n % 3; ++k) {
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      }
      n_readable += test::read_and_check_mesh(bytes_in(damaged)) ? 1 : 0;
    }
    EXPECT_LT(n_readable, 300U);
  }
}

TEST(ReadMesh, CorpusIsReplayed) {
  std::size_t n_files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_file("data/corpus/mesh"))) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(file), {}};
    EXPECT_FALSE(test::read_and_check_mesh(bytes_in(content)));
    ++n_files;
  }
  EXPECT_GE(n_files, 8U);
}

}  // namespace
}  // namespace mc
