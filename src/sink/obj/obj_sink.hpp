// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// Wavefront OBJ, always text. Errors: output.
std::unique_ptr<MeshSink> open_obj(const std::string& path, const SinkOptions& options);
MeshNeeds obj_needs(const SinkOptions& options, bool f32_moves);

inline constexpr SinkFormat kObjFormat{.name = "obj",
                                       .display = "OBJ",
                                       .extensions = "obj",
                                       .open_mesh = open_obj,
                                       .needs = obj_needs,
                                       .text = TextForm::always,
                                       .several_objects = true};

}  // namespace mc::sink
