// SPDX-License-Identifier: MIT
#include "source/image/module/image_file.hpp"

// What the module exports for reading.

mc::source::ImageFile* mc_open_image(mc::source::ImageKind kind, const std::string& place,
                                     std::span<const std::byte> bytes) {
#if MC_WITH_PNG
  if (kind == mc::source::ImageKind::png) return mc::source::open_png(place, bytes);
#endif
#if MC_WITH_EXR
  if (kind == mc::source::ImageKind::exr) return mc::source::open_exr(place, bytes);
#endif
  return nullptr;
}
