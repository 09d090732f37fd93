// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sink/gltf/gltf_json.hpp"
#include "sink/output_file.hpp"

// The buffers of a .gltf: "a/b.gltf" has "a/b.bin", then "a/b-2.bin" and on; another extension
// stays and ".bin" is added.

namespace mc::sink {

class BinFiles {
 public:
  /// Opens the first, which may turn out empty. Each holds at most `most_bytes`.
  /// Errors   output.
  BinFiles(std::string gltf_path, SinkOptions options, std::uint64_t most_bytes);

  /// The last, which objects go into, and its number from 0.
  [[nodiscard]] FileWriter& writer();
  [[nodiscard]] std::size_t last() const { return files_.size() - 1; }

  /// `whole`, the last object of the last file, does not fit there: moves it into the next, whole
  /// if it fits there, else in parts of a file each. Returns what it has become. Cost
  /// cut_into_parts(). Errors   output.
  [[nodiscard]] std::vector<GltfObject> spread(const GltfObject& whole);

  /// All of them, for the JSON; what is to be committed, which is nothing where the first is empty.
  [[nodiscard]] std::vector<GltfBuffer> buffers() const;
  [[nodiscard]] std::vector<OutputFile*> files();
  /// Warns of the vertices on the seams, where there are several.
  void note_parts() const;

 private:
  OutputFile& add();

  std::string gltf_path_;
  SinkOptions options_;
  std::uint64_t most_bytes_;
  std::vector<std::unique_ptr<OutputFile>> files_;
  std::uint64_t n_repeated_ = 0;  // vertices of parts beyond those of the objects
};

}  // namespace mc::sink
