// SPDX-License-Identifier: MIT
#include "source/mesh/mesh_format.hpp"

#include "source/magic.hpp"

namespace mc::source {

Recognition recognise_mesh(std::string_view head) {
  return recognised(has_magic(head, "ply\n") || has_magic(head, "ply\r\n") ||
                    has_magic(head, "glTF"));
}

}  // namespace mc::source
