// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// STL, binary or ASCII. Errors: output.
std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
