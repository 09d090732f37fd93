// SPDX-License-Identifier: MIT
#include "sink/image/module/encode.hpp"

// What the module exports for writing.

void mc_encode_image(mc::sink::ImageKind kind, const mc::Picture& picture,
                     [[maybe_unused]] const mc::sink::SliceOf& slice,
                     const mc::SinkOptions& options, mc::Buffer<std::byte>& out) {
  out.clear();
#if MC_WITH_PNG
  if (kind == mc::sink::ImageKind::png) mc::sink::encode_png(picture, options, out);
#endif
#if MC_WITH_EXR
  if (kind == mc::sink::ImageKind::exr) mc::sink::encode_exr(picture, slice, options, out);
#endif
}
