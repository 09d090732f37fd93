// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"

// Opening files that hold volumes (and, for `check`, meshes). What a file is, its content decides
// before its name does.

namespace mc {

struct SourceFormat;

/// Rows of formats. The rows are borrowed: they must outlive the calls that they are given to.
using SourceFormats = std::span<const SourceFormat* const>;

/// How dense samples of a file reach the memory of a run: through a mapping, or as copies of
/// planes.
enum class Reading : std::uint8_t { fastest, mapped, copied };

/// What the user says of the input; everything unset is read from the file.
struct SourceOptions {
  std::string from;                 ///< SourceFormat::name; empty: decide
  std::optional<std::string> grid;  ///< VDB: NAME, NAME[n] or #n
  std::vector<std::int64_t>
      dims;  ///< raw: two or three, each > 0; with two, the slices are counted
  std::optional<SampleType> type;  ///< raw
  std::endian endian = std::endian::little;
  std::uint64_t skip_bytes = 0;          ///< raw: header of each file
  std::optional<Vec3> spacing;           ///< world units; overrides the file's
  std::optional<Vec3> origin;            ///< world position of sample 0,0,0; overrides the file's
  std::optional<std::string> channel{};  ///< pictures; empty: Y, else R, else the first
  /// The caller accepts a PlaneStream: raw and NRRD samples of a pipe or a packed file are then not
  /// copied to $TMPDIR.
  bool streams = false;
  /// The folder that files must lie in which the input's own text names: pictures and volumes of
  /// documents, data files of NRRD headers. Empty: anywhere.
  std::string root{};
  /// What the run may hold. Values of a VDB that are more than half of it stay in their file, and
  /// are unpacked where they are looked at.
  std::uint64_t memory_bytes = std::uint64_t{1} << 30U;
  /// For tests and measurements: the mesh is the same. Files that cannot be copied are mapped.
  Reading reading = Reading::fastest;
  /// Formats beside source_formats(). They are recognised after those, but before the ones that are
  /// known by name only.
  SourceFormats further_formats{};
};

struct Source {
  std::string place;  ///< how messages name it: the path, or "<stdin>"
  VolumeReader reader;
  std::vector<std::string> other_grids;  ///< VDB: scalar grids that were not chosen
};

/// `to_world` with options.spacing and options.origin: the former replaces the lengths of its axes
/// and keeps their directions, the latter replaces the world position of sample 0,0,0.
[[nodiscard]] Affine placed(Affine to_world, const SourceOptions& options);

/// Opens a volume. `inputs`: one file, "-" for stdin, a folder, a glob that the shell left alone,
/// or several slices, raw or pictures (natural order is made here). What is packed by gzip or zstd
/// is unpacked.
/// Errors   input: missing, empty, damaged, of the wrong size, nothing to mesh; usage: options that
///          contradict each other or the kind of file, an invalid spec.
Source open_source(std::span<const std::string> inputs, const SourceOptions& options,
                   Progress& progress);

/// One line of `mc info`: a grid that may or may not be meshable.
struct GridDescription {
  Volume volume;
  std::string type_name;  ///< "float", "vec3s", "ptdataidx32": as the format calls it
  std::string refused;    ///< why it cannot be meshed; empty if it can
};

/// Lists everything in the input without reading samples where the format allows it.
std::vector<GridDescription> describe_source(std::span<const std::string> inputs,
                                             const SourceOptions& options, Progress& progress);

/// Bytes in order, each read once.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Fills `out`. Returns the number of bytes read, which is less than asked for only at the end.
  /// Errors   input: unreadable, damaged.
  virtual std::size_t read(std::span<std::byte> out) = 0;
};

/// All bytes of a file, in memory or mapped.
class InputBytes {
 public:
  virtual ~InputBytes() = default;
  [[nodiscard]] virtual std::span<const std::byte> bytes() const = 0;
};

/// What a format opens: the files that the user named. gzip and zstd are unpacked already.
/// Threads  one at a time.
class SourceInput {
 public:
  struct State;
  explicit SourceInput(std::unique_ptr<State> state);
  ~SourceInput();
  SourceInput(const SourceInput&) = delete;
  SourceInput& operator=(const SourceInput&) = delete;

  /// How messages name the whole: the first input as the user named it, or "<stdin>".
  [[nodiscard]] const std::string& place() const;
  /// The files, never empty; "-" is stdin. Several are in natural order (2 before 10); a format
  /// that knows a better one, such as positions in the files, orders them itself.
  [[nodiscard]] std::span<const std::string> paths() const;
  /// The first n bytes of the first file, fewer if it is shorter. They can still be read after
  /// that. Valid until the next call. Errors   input: missing, unreadable, empty.
  [[nodiscard]] std::string_view head(std::size_t n);
  /// The bytes of file n from its beginning. A pipe or FIFO gives its bytes once: to stream() or to
  /// map(). Errors   as head(); input: a device, which may have no end.
  [[nodiscard]] std::unique_ptr<ByteStream> stream(std::size_t n = 0);
  /// All bytes of file n. What cannot be mapped is first copied to $TMPDIR.
  /// Errors   as stream(); output: no space for the copy; limit: no address space.
  [[nodiscard]] std::unique_ptr<InputBytes> map(std::size_t n = 0);

  /// For the formats of this library.
  [[nodiscard]] State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// The options of SourceOptions that only some formats take; others refuse them.
struct SourceTakes {
  bool grid = false, channel = false;
  bool dims = false, type = false, endian = false, skip = false;
};

/// What a format says of the first bytes of a file. If it is unsure, it is asked again with more.
enum class Recognition : std::uint8_t { no, unsure, yes };

/// A format of volumes: everything that the library and the command line know of it.
struct SourceFormat {
  static constexpr std::size_t kHeadBytes = 512;                        ///< for recognise()
  static constexpr std::size_t kLongHeadBytes = std::size_t{1} << 20U;  ///< if it was unsure

  /// Of SourceOptions::from and Volume::format; empty: cannot be named.
  std::string_view name;
  std::string_view display;     ///< in messages: "OpenEXR", "raw data"
  std::string_view extensions;  ///< in lower case, with blanks between
  /// The package that brings its library; empty: needs none. Without the library it is not built
  /// in, and its open() refuses with that package's name.
  std::string_view package{};
  bool built_in = true;
  /// Decides by the first kHeadBytes of a file; if unsure, by kLongHeadBytes. Null: never.
  Recognition (*recognise)(std::string_view head) = nullptr;
  SourceTakes takes{};
  /// Samples without a header: chosen by SourceOptions::dims with type.
  bool headerless = false;
  /// Extension of a header file of another format that may lie beside it, and is then opened in its
  /// place.
  std::string_view sidecar{};
  bool several_files = false;  ///< several files, or a folder, are slices of one volume
  bool streams = false;        ///< reads a pipe in one pass, see SourceOptions::streams
  std::string_view own_iso = "the file's own";  ///< reason shown when Volume::iso is used
  /// Source::place is set by the caller. Null: cannot be read, and is known only to be refused.
  Source (*open)(SourceInput& input, const SourceOptions& options, Progress& progress) = nullptr;
  /// For files with several grids. Null: open() says everything.
  std::vector<GridDescription> (*describe)(SourceInput& input, Progress& progress) = nullptr;
  std::string_view refusal{};  ///< without open(): the fault; empty: is not supported
};

/// Every format of this library, in the order in which they are listed and recognised.
[[nodiscard]] SourceFormats source_formats();

/// The format of that name, of source_formats() or else of `further`. Null: there is none.
[[nodiscard]] const SourceFormat* find_source_format(std::string_view name,
                                                     SourceFormats further = {});

/// Reads a mesh: PLY, OBJ, STL (welded by exact position), glTF, GLB, decided by content. Several
/// primitives or objects become one mesh. "-" is stdin.
/// Shapes   positions are f32 if the file stores them so and no node of a glTF moves them, else
/// f64. Errors   input.
Mesh read_mesh(const std::string& path);

}  // namespace mc
