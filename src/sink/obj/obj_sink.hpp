// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// What is made of a chunk's vertices and triangles.
Formatted obj_formatted(Precision precision);

/// Wavefront OBJ, always text. Errors: output.
std::unique_ptr<MeshSink> open_obj(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
