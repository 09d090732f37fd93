// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "mc/sink.hpp"

// A folder that goes away with its test, and whole volumes through a sink.

namespace mc::test {

class VolumeFolder {
 public:
  VolumeFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mc-volume-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~VolumeFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  VolumeFolder(const VolumeFolder&) = delete;
  VolumeFolder& operator=(const VolumeFolder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Hands planes to the sink, `n_planes` at a time, without finishing.
inline void write_planes(const SlabReader& reader, VolumeSink& sink, std::int32_t n_planes) {
  Slab slab;
  const std::int32_t nz = reader.volume().lattice.dims()[2];
  for (std::int32_t k = 0; k < nz; k += n_planes) {
    reader.read(k, std::min(nz, k + n_planes), slab);
    sink.write(slab);
  }
}

inline void write_volume(const std::string& path, const SlabReader& reader,
                         const SinkOptions& options = {}, std::int32_t n_planes = 3) {
  const auto sink = open_volume_sink(path, options);
  sink->begin(reader.volume());
  write_planes(reader, *sink, n_planes);
  sink->finish();
}

}  // namespace mc::test
