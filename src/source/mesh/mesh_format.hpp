// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "mc/source.hpp"

namespace mc::source {

[[nodiscard]] Recognition recognise_mesh(std::string_view head);

/// Meshes where a volume is expected; read_mesh() reads them.
inline constexpr SourceFormat kMeshFormat{.name = "",
                                          .display = "a mesh as a volume",
                                          .extensions = "ply obj stl gltf glb",
                                          .recognise = recognise_mesh,
                                          .refusal = "a mesh, but a volume was expected"};

}  // namespace mc::source
