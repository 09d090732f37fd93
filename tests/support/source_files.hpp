// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/source.hpp"
#include "support/places.hpp"

// What tests of readers need: a folder of their own, files in it, and the errors that come out.

namespace mc::test {

/// A folder that is removed with everything in it.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "mc-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string path(std::string_view name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  [[nodiscard]] std::string file(std::string_view name, std::string_view bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// n bytes 0, 1, 2, ...
inline std::string counting_bytes(std::size_t n) {
  std::string out(n, '\0');
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = static_cast<char>(i);
  }
  return out;
}

inline Source open(const std::vector<std::string>& inputs, const SourceOptions& options = {}) {
  return open_source(inputs, options, silent_progress());
}

inline const SlabReader& slabs(const Source& source) {
  return *std::get<std::unique_ptr<SlabReader>>(source.reader);
}

inline PlaneStream& stream(const Source& source) {
  return *std::get<std::unique_ptr<PlaneStream>>(source.reader);
}

inline const LeafReader& leaves(const Source& source) {
  return *std::get<std::unique_ptr<LeafReader>>(source.reader);
}

/// All samples of a dense source, as they lie in the file.
inline std::string all_bytes(const SlabReader& reader) {
  const Index3 dims = reader.volume().lattice.dims();
  Slab slab;
  reader.read(0, dims[2], slab);
  const std::size_t row = static_cast<std::size_t>(dims[0]) * sample_size(reader.volume().type);
  std::string out;
  for (const std::byte* plane : slab.planes) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      out.append(reinterpret_cast<const char*>(plane) +
                     static_cast<std::size_t>(j) * slab.row_stride_bytes,
                 row);
    }
  }
  return out;
}

/// "3 PLACE: FAULT; REMEDY", the status and text of the Error that `f` throws.
inline std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + " " + error.what();
  }
  return "no error";
}

inline std::string error_of_open(const std::vector<std::string>& inputs,
                                 const SourceOptions& options = {}) {
  return error_of([&] { open(inputs, options); });
}

}  // namespace mc::test

#define MC_NEEDS_VOLUME(path)                                     \
  if (!std::filesystem::exists(path)) {                           \
    GTEST_SKIP() << path << " is not there; set MC_TEST_VOLUMES"; \
  }                                                               \
  static_assert(true)
