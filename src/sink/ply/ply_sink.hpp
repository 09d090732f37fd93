// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// What is made of a chunk's vertices and triangles.
Formatted ply_formatted(Precision precision, bool ascii);

/// PLY, binary little endian or ASCII. Errors: output.
std::unique_ptr<MeshSink> open_ply(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
