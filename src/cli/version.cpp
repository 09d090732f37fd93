// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "base/parallel.hpp"
#include "cli/invocation.hpp"
#include "extract/simd_target.hpp"

// `mc --version -v`: what to quote when reporting a bug.

namespace mc::cli {

std::string version_text(bool verbose) {
  std::string text = "mc " MC_VERSION "\n";
  if (!verbose) return text;
  const auto list = [](const char* plain, bool more, const char* extra) {
    return fmt::format("{}{}", plain, more ? extra : "");
  };
  text += fmt::format("reads    {}\n", list("raw nrrd spec", MC_WITH_VDB != 0, " vdb") +
                                           list("", MC_WITH_EXR != 0, " exr") +
                                           list("", MC_WITH_PNG != 0, " png"));
  text += fmt::format("meshes   {}\n", list("ply obj stl", MC_WITH_GLTF != 0, " glb gltf"));
  text += fmt::format("volumes  {}\n", list("nrrd raw", MC_WITH_VDB != 0, " vdb") +
                                           list("", MC_WITH_EXR != 0, " exr"));
  text += fmt::format("pictures {}\n",
                      list("", MC_WITH_EXR != 0, "exr ") + list("", MC_WITH_PNG != 0, "png"));
  text += fmt::format("unpacks  {}\n",
                      list("", MC_WITH_GZIP != 0, "gzip ") + list("", MC_WITH_ZSTD != 0, "zstd"));
  if (MC_WITH_VDB == 0) text += "without  vdb (build with libopenvdb-dev)\n";
  if (MC_WITH_GLTF == 0) text += "without  glb gltf (build with libtinygltf-dev)\n";
  if (MC_WITH_EXR == 0) text += "without  exr (build with libopenexr-dev)\n";
  if (MC_WITH_PNG == 0) text += "without  png (build with libpng-dev)\n";
  if (MC_WITH_GZIP == 0) text += "without  gzip (build with zlib1g-dev)\n";
  if (MC_WITH_ZSTD == 0) text += "without  zstd (build with libzstd-dev)\n";
  text += fmt::format("simd     {} (of {})\n", extraction::simd_target_name(),
                      fmt::join(extraction::simd_targets(), " "));
  text += fmt::format("threads  {} ({})\n", base::thread_count(), MC_THREADS_BACK_END);
  return text;
}

}  // namespace mc::cli
