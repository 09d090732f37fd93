// SPDX-License-Identifier: MIT
#include "source/image/open_image.hpp"

#include <algorithm>

#ifdef MC_IMAGE_MODULE
#include "base/module.hpp"
#endif
#include "mc/base.hpp"
#include "source/formats.hpp"
#include "source/image/image_formats.hpp"

// From a picture's format to what reads it.

namespace mc::source {

namespace {

#ifdef MC_IMAGE_MODULE

OpenImage opener(const std::string& place) {
  std::string why;
  void* found = base::module_symbol(MC_IMAGE_MODULE, kOpenImageSymbol, why);
  if (found == nullptr) {
    throw Error(ErrorKind::input, place, "cannot load what reads pictures: " + why,
                "install " MC_IMAGE_MODULE
                " with mc, and the libraries of OpenEXR and PNG (libopenexr-3-1-30, libpng16-16)");
  }
  return reinterpret_cast<OpenImage>(found);
}

#elif MC_WITH_PNG || MC_WITH_EXR

OpenImage opener(const std::string& /*place*/) { return mc_open_image; }

#endif

}  // namespace

std::unique_ptr<ImageFile> open_image(ImageKind kind, const MappedFile& file) {
  const std::string& place = file.place();
#if MC_WITH_PNG || MC_WITH_EXR
  if (format_of(kind).built_in) {
    return std::unique_ptr<ImageFile>(opener(place)(kind, place, file.bytes()));
  }
#endif
  refuse_absent(format_of(kind), place);
}

std::optional<std::size_t> channel_named(const ImagePart& part,
                                         const std::optional<std::string>& name) {
  const auto& all = part.channels;
  const auto at = [&](std::string_view wanted) {
    return static_cast<std::size_t>(std::ranges::find(all, wanted, &ImageChannel::name) -
                                    all.begin());
  };
  if (name) return at(*name) < all.size() ? std::optional(at(*name)) : std::nullopt;
  for (const std::string_view usual : {"Y", "R"}) {
    if (at(usual) < all.size()) return at(usual);
  }
  return 0;
}

std::string channel_list(const ImagePart& part) {
  std::string list;
  for (const ImageChannel& channel : part.channels) {
    list += (list.empty() ? "" : ", ") + channel.name;
  }
  return list;
}

}  // namespace mc::source
