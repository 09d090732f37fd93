// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

struct SinkFormat;

/// Rows of formats. The rows are borrowed: they must outlive the calls that they are given to.
using SinkFormats = std::span<const SinkFormat* const>;

struct SinkOptions {
  std::string to{};              ///< SinkFormat::name; empty: by extension
  bool force = false;            ///< replace an existing file; write binary to a terminal
  bool sync = false;             ///< finish() waits until data and names are on the disk
  bool ascii = false;            ///< PLY, STL: text form
  Progress* progress = nullptr;  ///< is told, as a detail, of what is spooled to $TMPDIR
  std::optional<Precision>
      precision{};  ///< PLY coordinates; unset: f32 unless it would move a vertex
  /// Facts written into the file (PLY/OBJ comments, glTF asset.extras), in order. Never time, host,
  /// path, threads, memory or SIMD target.
  std::vector<std::pair<std::string, std::string>> provenance{};
  /// Formats with SinkFormat::to_memory: finish() puts the mesh's bytes there, and no file is made.
  /// Must outlive the sink.
  Buffer<std::byte>* memory = nullptr;
  SinkFormats further_formats{};  ///< beside sink_formats(), which come first
};

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

/// Whether a format has a text form, and another one.
enum class TextForm : std::uint8_t { none, optional, always };

/// A format of outputs: everything that the library and the command line know of it. A format may
/// be of several kinds: meshes, volumes, pictures.
struct SinkFormat {
  std::string_view name;        ///< of SinkOptions::to
  std::string_view display;     ///< in messages: "OpenEXR"
  std::string_view extensions;  ///< in lower case, with blanks between
  /// The package that brings its library; empty: needs none. Without the library it is not built
  /// in, and opening it refuses with that package's name.
  std::string_view package{};
  bool built_in = true;

  /// Null: holds no meshes.
  std::unique_ptr<MeshSink> (*open_mesh)(const std::string& path,
                                         const SinkOptions& options) = nullptr;
  /// How a mesh wants its positions; set with open_mesh. `f32_moves` says that float would move a
  /// vertex of this volume by more than 1/8192 of a cell.
  MeshNeeds (*needs)(const SinkOptions& options, bool f32_moves) = nullptr;
  TextForm text = TextForm::none;  ///< optional: SinkOptions::ascii chooses it
  bool precision = false;          ///< SinkOptions::precision chooses float or double coordinates
  bool has_normals = true;         ///< one a vertex
  /// Bytes that the sink makes of an attribute of one vertex, converted if need be; 0 if it cannot
  /// hold the attribute. Null: it holds none.
  std::size_t (*attribute_bytes)(const AttributeInfo& attribute,
                                 const SinkOptions& options) = nullptr;
  bool several_objects = false;  ///< in one file
  bool y_up_metres = false;      ///< coordinates are in metres, +Y is up; else the source's
  bool one_file = true;          ///< a mesh is one file, and can go to a pipe
  bool to_memory = false;        ///< SinkOptions::memory

  /// Null: holds no volumes.
  std::unique_ptr<VolumeSink> (*open_volume)(const std::string& path,
                                             const SinkOptions& options) = nullptr;

  /// Null: holds no single pictures.
  std::unique_ptr<PictureSink> (*open_picture)(const std::string& path,
                                               const SinkOptions& options) = nullptr;
  bool greys = false;  ///< pictures hold whole numbers from black to white, 8 or 16 bits
};

/// Every format of this library, in the order in which they are listed.
[[nodiscard]] SinkFormats sink_formats();

/// The format of that name, of sink_formats() or else of `further`. Null: there is none.
[[nodiscard]] const SinkFormat* find_sink_format(std::string_view name, SinkFormats further = {});

/// The format that `options.to` or the extension of `path` names.
/// Errors   usage: unknown or missing; the message lists what there is.
const SinkFormat& output_format(std::string_view path, const SinkOptions& options);

/// What meshes and volumes are written as by a caller that has no wish.
[[nodiscard]] const SinkFormat& usual_mesh_format();
[[nodiscard]] const SinkFormat& usual_volume_format();

namespace sink {
class OutputFile;
}

/// One output file for the sinks of further formats, with the guarantees of this header: a regular
/// file appears under its name complete, by finish(), or not at all; "-", devices and FIFOs are
/// written in place; SinkOptions::force, sync and memory are honoured.
/// Errors   output, of every call. Threads  one at a time.
class OutputStream {
 public:
  /// `binary` output is refused by a terminal, unless options.force.
  OutputStream(const std::string& path, const SinkOptions& options, bool binary = true);
  /// Without finish() it leaves nothing behind.
  ~OutputStream();
  OutputStream(const OutputStream&) = delete;
  OutputStream& operator=(const OutputStream&) = delete;

  /// How messages name it: the path, or "<stdout>".
  [[nodiscard]] const std::string& place() const;
  /// Whether patch() can be called: not if it is written in place.
  [[nodiscard]] bool seekable() const;
  [[nodiscard]] std::uint64_t size() const;  ///< bytes written so far
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Overwrites bytes written before. Precondition: seekable(), offset + bytes.size() <= size().
  void patch(std::uint64_t offset, std::span<const std::byte> bytes);
  void finish();

 private:
  std::unique_ptr<sink::OutputFile> file_;
};

}  // namespace mc
