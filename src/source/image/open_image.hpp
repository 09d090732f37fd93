// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "source/image/module/image_file.hpp"
#include "source/mapped_file.hpp"

namespace mc::source {

/// Opens a picture; `file` must outlive it. The module is loaded at the first call. Errors   as
/// OpenImage; input too: this build has no such reader, or its library is not there.
std::unique_ptr<ImageFile> open_image(ImageKind kind, const MappedFile& file);

/// The place of the channel called `name`; without a name of Y, else of R, else 0, the first.
/// nullopt: there is none of that name.
[[nodiscard]] std::optional<std::size_t> channel_named(const ImagePart& part,
                                                       const std::optional<std::string>& name);

/// "R, G, B": for messages.
[[nodiscard]] std::string channel_list(const ImagePart& part);

}  // namespace mc::source
