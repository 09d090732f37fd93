// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"

// Opening outputs. Every output is written as NAME.partial-XXXX in the same folder and renamed by
// finish(); devices, FIFOs and stdout are written in place.

namespace mc {

struct SinkOptions {
  std::string to;      ///< "ply", "obj", "stl", "glb", "gltf"; "vdb", "nrrd", "raw", "exr", "png";
                       ///< empty: by extension
  bool force = false;  ///< replace an existing file; write binary to a terminal
  bool sync = false;   ///< finish() waits until data and names are on the disk
  bool ascii = false;  ///< PLY, STL: text form
  Progress* progress = nullptr;  ///< is told, as a detail, of what is spooled to $TMPDIR
  std::optional<Precision>
      precision;  ///< PLY coordinates; unset: f32 unless it would move a vertex
  /// Facts written into the file (PLY/OBJ comments, glTF asset.extras), in order. Never time, host,
  /// path, threads, memory or SIMD target.
  std::vector<std::pair<std::string, std::string>> provenance{};
  /// GLB only: finish() puts the mesh's bytes there, and no file is made. Must outlive the sink.
  Buffer<std::byte>* memory = nullptr;
};

/// The format that `options.to` or the extension of `path` names ("ply" ... "raw").
/// Errors   usage: unknown or missing; the message lists what there is.
std::string output_format(std::string_view path, const SinkOptions& options);
/// Whether that format holds meshes (else volumes).
bool is_mesh_format(std::string_view format);

/// How a mesh format wants its positions. `f32_moves` says that float would move a vertex of this
/// volume by more than 1/8192 of a cell.
MeshNeeds mesh_needs(std::string_view format, const SinkOptions& options, bool f32_moves);
/// Whether the format holds an index a vertex.
bool holds_materials(std::string_view format);
/// Objects that one file of the format can hold: 1 for PLY and STL.
bool holds_several_objects(std::string_view format);

/// Opens a mesh output; "-" is stdout. The partial file is made here, so that an output that cannot
/// be written is found before the work. Errors   output: exists (without force), missing or
/// read-only folder, terminal; usage: options.
std::unique_ptr<MeshSink> open_mesh_sink(const std::string& path, const SinkOptions& options);
std::unique_ptr<VolumeSink> open_volume_sink(const std::string& path, const SinkOptions& options);

/// A plane of samples as a picture: the top row first, rows adjacent, native byte order.
struct Picture {
  std::int32_t width = 0;
  std::int32_t height = 0;
  SampleType type = SampleType::f32;
  Buffer<std::byte> samples{};
};

/// The port by which pictures leave.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  /// Writes the picture and puts it under its name; `texts` go into its header after the
  /// provenance. Errors   usage: a type that PNG does not hold; limit: one that OpenEXR has no room
  /// for; output.
  virtual void write(const Picture& picture,
                     const std::vector<std::pair<std::string, std::string>>& texts) = 0;
};

/// Opens a picture of one channel: PNG (u8, u16) or OpenEXR (all but i32, i64 and f64; no sample is
/// rounded). "-" is stdout. Errors   as open_mesh_sink().
std::unique_ptr<PictureSink> open_picture_sink(const std::string& path, const SinkOptions& options);

/// Unlinks every partial file of this process, and puts back what several files that belong
/// together were about to replace. For a process that is about to end: whoever then wants to make
/// or rename an output waits for that end. Async-signal-safe enough for a signal thread: takes no
/// lock that a blocked writer holds, and waits at most a tenth of a second for a blocked rename.
void unlink_partials() noexcept;

}  // namespace mc
