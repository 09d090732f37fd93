// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// Wavefront OBJ, always text. Errors: output.
std::unique_ptr<MeshSink> open_obj(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
