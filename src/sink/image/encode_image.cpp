// SPDX-License-Identifier: MIT
#include "sink/image/encode_image.hpp"

#ifdef MC_IMAGE_MODULE
#include "base/module.hpp"
#endif

// From a kind of picture to what writes it.

namespace mc::sink {

namespace {

#ifdef MC_IMAGE_MODULE

EncodeImage encoder(const std::string& place) {
  std::string why;
  void* found = base::module_symbol(MC_IMAGE_MODULE, kEncodeImageSymbol, why);
  if (found == nullptr) {
    throw Error(ErrorKind::output, place, "cannot load what writes pictures: " + why,
                "install " MC_IMAGE_MODULE
                " with mc, and the libraries of OpenEXR and PNG (libopenexr-3-1-30, libpng16-16)");
  }
  return reinterpret_cast<EncodeImage>(found);
}

#elif MC_WITH_PNG || MC_WITH_EXR

EncodeImage encoder(const std::string& /*place*/) { return mc_encode_image; }

#endif

}  // namespace

void encode_image(ImageKind kind, const std::string& place, [[maybe_unused]] const Picture& picture,
                  [[maybe_unused]] const SliceOf& slice,
                  [[maybe_unused]] const SinkOptions& options,
                  [[maybe_unused]] Buffer<std::byte>& out) {
  const bool exr = kind == ImageKind::exr;
#if MC_WITH_PNG || MC_WITH_EXR
  if ((exr && MC_WITH_EXR) || (!exr && MC_WITH_PNG)) {
    return encoder(place)(kind, picture, slice, options, out);
  }
#endif
  throw Error(ErrorKind::usage, place,
              std::string("this build cannot write ") + (exr ? "OpenEXR" : "PNG"),
              std::string("install ") + (exr ? "libopenexr-dev" : "libpng-dev") +
                  " and build again, or write .nrrd");
}

}  // namespace mc::sink
