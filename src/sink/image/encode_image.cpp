// SPDX-License-Identifier: MIT
#include "sink/image/encode_image.hpp"

#ifdef MC_IMAGE_MODULE
#include "base/module.hpp"
#endif

#include "sink/formats.hpp"
#include "sink/image/image_formats.hpp"

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
#if MC_WITH_PNG || MC_WITH_EXR
  if (format_of(kind).built_in) {
    return encoder(place)(kind, picture, slice, options, out);
  }
#endif
  refuse_absent(format_of(kind), place);
}

}  // namespace mc::sink
