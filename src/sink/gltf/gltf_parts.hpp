// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "sink/file_writer.hpp"
#include "sink/gltf/gltf_json.hpp"

// An object that is too large for one file, cut into primitives of a file each.

namespace mc::sink {

/// Cuts `whole`, which lies in `from`, into parts of at most `most_bytes`: triangles in their order
/// as long as they fit with the vertices they use, those in the order they had; what several parts
/// use, each has. The cuts depend on nothing but the object and `most_bytes`.
/// open()   hands out the file of the next part, which is empty.
/// made()   takes each part as it lies in its file.
/// Precondition: a triangle fits.
/// Cost     reads indices twice and vertices once, writes both once; UsedVertices for memory.
/// Errors   output.
void cut_into_parts(const FileWriter& from, const GltfObject& whole, std::uint64_t most_bytes,
                    const std::function<FileWriter&()>& open,
                    const std::function<void(const GltfObject&)>& made);

}  // namespace mc::sink
