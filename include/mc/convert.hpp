// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "mc/edit.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"
#include "mc/pipe.hpp"
#include "mc/process.hpp"
#include "mc/simplify.hpp"
#include "mc/sink.hpp"
#include "mc/source.hpp"

// File to file: a volume to a mesh or to another volume, and the choices that this takes: which
// surface, in which frame and unit, at which precision. What a program does about signals and
// changing inputs is in mc/host.hpp.

namespace mc {

/// The library's version, "1.2.3".
[[nodiscard]] std::string_view version();

/// An isovalue as asked for; which number it is may depend on the data.
struct IsoChoice {
  enum class Kind : std::uint8_t { number, otsu, percentile };
  Kind kind = Kind::number;
  double value = 0;  ///< the number, or the percentile in [0, 100]
};

/// Which surface of a volume; what is unset, the volume decides.
struct SurfaceChoice {
  std::vector<IsoChoice> isos{};   ///< empty: the volume's own, else Otsu's threshold
  std::optional<Inside> inside{};  ///< unset: below for signed distances, else above
  bool invert = false;             ///< swap the solid side
  std::optional<Border> border{};  ///< unset: the volume's own, else open
};

/// An isovalue as used.
struct Iso {
  double value = 0;    ///< rounded to float for f16 and f32 data
  std::string reason;  ///< "fog volume", "otsu", "p50"; empty where the caller gave the number
};

/// A surface that has been decided.
struct Surface {
  std::vector<Iso> isos;
  Inside inside = Inside::above;
  Border border = Border::open;
};

/// The surface that a volume has unless its caller chooses another. `statistics` may be null where
/// the volume itself says its isovalue; else the isovalue is Otsu's threshold, NaN without them.
[[nodiscard]] Surface default_surface(const Volume& volume, const FieldStatistics* statistics);

enum class Up : std::uint8_t { y, z };

/// Where a mesh should lie; what is unset, the source decides.
struct FrameChoice {
  std::optional<Frame> frame{};  ///< ras or lps: convert to it, or declare it
  std::optional<Up> up{};        ///< of a source that has no frame
  std::optional<Units> units{};  ///< mm or m: convert to them, or declare them
};

/// Where a mesh lies in its file.
struct OutputFrame {
  Affine to_world;                      ///< lattice to the file's coordinates
  Frame frame = Frame::none;            ///< of the file's coordinates; none for glTF, which is y-up
  Frame source_frame = Frame::none;     ///< the source's, or as declared
  Up source_up = Up::y;                 ///< of sources without a frame
  Units units = Units::unknown;         ///< of the file's coordinates
  Units source_units = Units::unknown;  ///< the source's, or as declared
};

/// The map from `volume`'s lattice to an output of `format`.
/// glTF     y-up metres: superior -> +Y, anterior -> +Z, millimetres scaled; a frame without units
///          counts as millimetres. Others keep the source's frame and units, or take those chosen.
/// Errors   usage: an up axis for a source that has a frame; units that glTF cannot have.
[[nodiscard]] OutputFrame output_frame(const Volume& volume, const FrameChoice& choice,
                                       const SinkFormat& format);

/// "above", "open", "ras", "mm", "y": as options and reports spell them.
[[nodiscard]] const char* name_of(Inside inside);
[[nodiscard]] const char* name_of(Border border);
[[nodiscard]] const char* name_of(Frame frame);
[[nodiscard]] const char* name_of(Units units);
[[nodiscard]] const char* name_of(Up up);
/// The shortest text that reads back as this value of this type.
[[nodiscard]] std::string value_text(double value, SampleType type);

/// Which plane of samples becomes a picture, and which greys its values are.
struct SliceChoice {
  int axis = 2;        ///< 0, 1, 2
  bool world = false;  ///< `at` is a world coordinate, else an index
  double at = 0;
  int bits = 16;                                 ///< PNG: 8 or 16
  std::optional<std::array<double, 2>> range{};  ///< PNG: black and white; unset: finite range
};

/// A vertex attribute that the samples of a volume give: linear between samples; past the border of
/// a dense volume that of the border, past the leaves and tiles of a sparse one the background. It
/// is NaN where a sample that counts is. f32, but f64 for samples of 32-bit and wider integers and
/// of f64.
struct VolumeAttribute {
  std::string name;                      ///< see check_attributes()
  const VolumeReader* volume = nullptr;  ///< no stream; must outlive what samples it
};

/// What convert() does. Outputs that are volumes or pictures take source, sink, region, memory and
/// slice only.
struct ConvertOptions {
  SourceOptions source{};
  SinkOptions sink{};
  SurfaceChoice surface{};
  FrameChoice frame{};
  /// Region, interpolation, minimum edge and whether to measure; the run itself decides iso,
  /// inside, border, normals, precision and origin.
  ExtractOptions extract{};
  MeshStages stages{};               ///< applied to the mesh before it is written, in order
  CubeStages cube_stages{};          ///< applied after `stages`, in order
  std::optional<Normals> normals{};  ///< unset: gradient where the format holds normals, else none
  std::optional<KeepRule> keep{};    ///< components that remain; unset: all
  std::optional<SimplifyGoal> simplify{};                ///< applied after cube_stages
  std::uint64_t memory_bytes = std::uint64_t{1} << 30U;  ///< the process's budget
  bool allow_empty = false;                              ///< a mesh without triangles is a success
  bool skip = true;      ///< leave out samples far from the surface where the source can
  bool dry_run = false;  ///< decide everything, write nothing
  std::optional<SliceChoice> slice{};  ///< a picture of this plane, to a format of pictures
  /// Beside the volume's own: of volumes in the same world, as their sources place them.
  std::vector<VolumeAttribute> attributes{};
  /// Called before the work with what it will take; or empty.
  std::function<void(const MemoryNeed&)> on_memory_need{};
};

/// The time that one stage of a conversion took.
struct StageTime {
  std::string name;  ///< "open", "statistics", "spool", "extract"
  double seconds = 0;
  std::optional<std::uint64_t> n_bytes;  ///< of samples read
};

/// How a conversion went, filled in as far as it came.
struct ConvertReport {
  std::string input;   ///< as messages name it
  std::string format;  ///< of the output
  std::optional<Volume> volume;
  std::optional<OutputFrame> frame;
  std::optional<Surface> surface;
  std::vector<MeshTotals> totals;    ///< one for each isovalue; empty for volumes and dry runs
  std::optional<MemoryNeed> memory;  ///< of a dry run
  std::vector<StageTime> stages;
};

/// Converts a volume to a mesh, a volume or, with options.slice, a picture, by the output's format.
/// Inputs   as open_source() takes them. Output: a path, or "-" for stdout with options.sink.to.
/// Report   filled in as far as the run comes, also when it throws.
/// Errors   those of source and sink; empty: no surface; limit: memory, what the format can hold;
///          usage: options that contradict the volume or the format. No partial file is left.
/// Threads  uses the caller's arena; the bytes written do not depend on the thread count.
/// Memory   options.memory_bytes, pages of mapped files aside.
void convert(std::span<const std::string> inputs, const std::string& output,
             const ConvertOptions& options, Progress& progress, const std::stop_token& stop,
             ConvertReport& report);
ConvertReport convert(std::span<const std::string> inputs, const std::string& output,
                      const ConvertOptions& options = {}, Progress& progress = silent_progress(),
                      const std::stop_token& stop = {});

/// Converts one input.
ConvertReport convert(const std::string& input, const std::string& output,
                      const ConvertOptions& options = {}, Progress& progress = silent_progress(),
                      const std::stop_token& stop = {});

/// Writes the surface of an open volume as a mesh. Where `surface` is given, it is that one;
/// options.surface is then ignored. Errors, threads and memory: as convert(), but the reader is no
/// stream.
void write_mesh(const Source& source, const std::optional<Surface>& surface,
                const std::string& output, const ConvertOptions& options, Progress& progress,
                const std::stop_token& stop, ConvertReport& report);

/// A reader of the attribute, for RunOptions::attributes: `to_world` is the map of the volume that
/// is meshed. Errors   input: the other volume's map cannot be inverted; those of its reader.
/// Memory   a dense volume that is not mapped is read and kept whole; a sparse one takes 64 bytes a
///          leaf and tile.
std::unique_ptr<AttributeReader> volume_attribute(const VolumeAttribute& attribute,
                                                  const Affine& to_world);

struct VolumeOptions {
  SinkOptions sink{};
  std::optional<IndexBox> region{};  ///< only these samples
  std::uint64_t memory_bytes = std::uint64_t{1} << 30U;
};

/// The options of a conversion that concern its volume.
[[nodiscard]] VolumeOptions volume_options(const ConvertOptions& options);

/// Writes the samples of a volume, or those of a region, as a volume file. A sparse volume stays
/// sparse where the format can.
/// Errors   usage: a region outside the volume, or of a stream; limit: two planes exceed the
/// budget;
///          output.
void write_volume(const VolumeReader& from, const std::string& output, const VolumeOptions& options,
                  Progress& progress, const std::stop_token& stop);

/// Writes one plane of samples as a picture, seen with the first axis to the right and the second
/// up: i, j for a plane of constant k; k, j for i; i to the right and k down for j (y is up, so
/// that is the view from above). Precondition: `from` is no stream. Errors   usage: outside the
/// volume, a world axis that is no axis of the samples; limit; output.
void write_slice(const VolumeReader& from, const std::string& output, const SliceChoice& slice,
                 const VolumeOptions& options, Progress& progress, const std::stop_token& stop);

/// A file that an edited volume is written to, as a mesh or as a volume by its format.
struct ScriptOutput {
  std::string path;
  ConvertOptions options{};
};

/// The surface of an edited volume in cubes of cells, a GLB each, handed out as it changes.
struct ChunkOutput {
  std::optional<std::string> folder{};  ///< files there; unset: ScriptObserver::chunk()
  std::int32_t n_cells = 32;            ///< along a chunk's edge: a power of two from 8 to 256
  bool at_writes = false;  ///< at write records and at the end, instead of after each record
};

struct ScriptOptions {
  /// How the input is opened, which surface it has and in which frame; whether files are replaced.
  ConvertOptions base{};
  std::vector<ScriptOutput> outputs{};  ///< written when the script has ended
  /// The output that a write record asks for; empty: its path with the base options.
  std::function<ScriptOutput(const std::string& path)> output_of_write{};
  std::optional<ChunkOutput> chunks{};
  std::optional<std::string> journal{};  ///< records the edits with hashes, as a script to replay
  std::optional<std::size_t> undo{};     ///< steps to keep; unset: all, of live scripts 256
  bool keep_going = false;               ///< pass over invalid records
  bool limits_store = false;             ///< stored blocks keep within the budget too
};

/// A chunk of the surface that is new or differs from the one before.
struct ChunkUpdate {
  Index3 id{};
  std::string file;  ///< in the folder; empty where it went to ScriptObserver::chunk()
  std::uint64_t n_bytes = 0;
  std::uint64_t n_vertices = 0, n_triangles = 0;
  Bounds bounds;  ///< in the GLB's scene
};

struct ChunkChanges {
  std::vector<Index3> removed;  ///< chunks that have no surface any more
  std::vector<ChunkUpdate> updated;
  ChunkSums sums;  ///< over all chunks that exist
};

/// One record of a script, done; of a dry run, described.
struct RecordReport {
  std::uint64_t number = 0;  ///< from 1
  std::string op;            ///< as it is written; "open" and "end" for chunks without a record
  bool is_state = false;     ///< not a record: the chunks at the start, or at the end
  EditEffect effect{};       ///< of a group: of all its edits
  Bounds bounds{};           ///< of what was touched, in the script's space
  std::optional<std::size_t> count{};   ///< undo, redo: steps
  std::optional<std::string> output{};  ///< write
  std::optional<ChunkChanges> chunks{};
  std::optional<std::uint64_t> n_reached{};  ///< dry run: chunks that the box reaches
  double seconds = 0;  ///< from the record's arrival until its chunks were handed out
};

/// How a script went, filled in as far as it came.
struct ScriptReport {
  std::string input;
  double iso = 0;
  Inside inside = Inside::above;
  bool index_space = false;
  std::uint64_t n_records = 0;
  std::uint64_t n_edits = 0;    ///< each of a group counts
  std::uint64_t n_outside = 0;  ///< edits that lay wholly outside
  std::uint64_t n_changed = 0;  ///< samples, counted for each edit
  std::uint64_t n_stored_blocks = 0;
  std::uint64_t stored_bytes = 0;
  std::optional<ErrorKind> fault;  ///< of the first invalid record
};

/// Follows a script while it runs. All calls come from the thread of apply_script() but chunk(),
/// which comes from any, one at a time.
class ScriptObserver {
 public:
  virtual ~ScriptObserver() = default;
  virtual void record(const RecordReport& /*report*/) {}
  /// A mesh was written.
  virtual void output(const std::string& /*path*/, const ConvertReport& /*report*/) {}
  /// A record is invalid.
  virtual void fault(const Error& /*error*/) {}
  /// A chunk changed, and ChunkOutput::folder is unset.
  virtual void chunk(std::uint64_t /*record*/, const Index3& /*id*/,
                     std::span<const std::byte> /*glb*/) {}
};

/// Applies a script of brush edits (mc-edits(5), a path or "-") to a volume, and writes it. The
/// surface is decided once, of the input. With options.base.dry_run nothing is applied or written,
/// and the observer is told what each record would touch.
/// Report   filled in as far as the script comes, also when it throws.
/// Errors   those of convert(); usage: an invalid script (all records are checked first, unless it
///          is live or keep_going), outputs that contradict each other; output: the journal.
/// Threads  one caller; inside, work is shared among the threads of its arena.
void apply_script(std::span<const std::string> inputs, const std::string& script,
                  const ScriptOptions& options, ScriptObserver& observer, Progress& progress,
                  const std::stop_token& stop, ScriptReport& report);

/// Refuses a region that the volume does not have. A dense volume ends at its box; a sparse one
/// goes on as background, so that a region may reach past its active samples, but not miss them
/// all. Errors   usage.
void check_region(const VolumeReader& reader, const std::optional<IndexBox>& region);

}  // namespace mc
