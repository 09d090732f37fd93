// SPDX-License-Identifier: MIT
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "mc/mesh.hpp"
#include "mc/sink.hpp"

// What the tests of the sinks share: a folder of their own, a tetrahedron, and ways to write it.

namespace mc::test {

/// A folder that is gone with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mc-sink-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  [[nodiscard]] std::size_t n_entries() const {
    const std::filesystem::directory_iterator entries(path_);
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
  }

 private:
  std::string path_;
};

inline std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_all(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// The kind and text of the Error that `body` throws; "" where it throws none.
inline std::string error_text(const std::function<void()>& body, ErrorKind kind) {
  try {
    body();
  } catch (const Error& error) {
    return error.kind() == kind ? error.what() : "wrong kind: " + std::string(error.what());
  }
  return "";
}

/// A tetrahedron in chunks: cut 0 is one chunk, 1 has its last vertex (which the first chunk's
/// triangles name already) in a second, 2 is one vertex or triangle a chunk.
struct Tetrahedron {
  bool has_normals = false;
  Precision precision = Precision::f32;
  bool has_materials = false;
  /// Further attributes; number n of vertex v is v + 0.5 n in a floating-point type, else v + n.
  std::vector<AttributeInfo> attributes{};

  [[nodiscard]] std::vector<AttributeInfo> all_attributes() const;
  [[nodiscard]] MeshObject object(bool counts, const std::string& name = "iso 0.5") const;
  [[nodiscard]] std::vector<MeshChunk> chunks(int cut) const;
  [[nodiscard]] static MeshTotals totals();
};

/// How a test writes a mesh: to a file or through a FIFO, counts announced or not, cut how.
struct Way {
  bool stream = false;
  bool counts = false;
  int cut = 0;
};

/// All twelve.
std::vector<Way> all_ways();

/// Writes `objects` copies of the tetrahedron as `format` and returns the bytes that came out.
std::string written(const Tetrahedron& mesh, SinkOptions options, const Way& way,
                    std::size_t n_objects = 1);

/// Runs `body(path)` with the path of a FIFO and returns what came through it.
std::string through_fifo(const std::function<void(const std::string&)>& body);

}  // namespace mc::test
