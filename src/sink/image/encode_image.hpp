// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sink/image/module/encode.hpp"

namespace mc::sink {

/// Fills `out` with a whole file; the module is loaded first where it is not yet. `place` is the
/// output in messages.
/// Errors   as EncodeImage; usage: this build has no such writer; output too: the module, or a
///          library of its, is not there.
void encode_image(ImageKind kind, const std::string& place, const Picture& picture,
                  const SliceOf& slice, const SinkOptions& options, Buffer<std::byte>& out);

}  // namespace mc::sink
