// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"

// Opening files that hold volumes (and, for `check`, meshes). What a file is, its content decides
// before its name does.

namespace mc {

/// What the user says of the input; everything unset is read from the file.
struct SourceOptions {
  std::string from;                 ///< "vdb", "raw", "nrrd", "spec", "exr", "png"; empty: decide
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
};

struct Source {
  std::string place;  ///< how messages name it: the path, or "<stdin>"
  VolumeReader reader;
  std::vector<std::string> other_grids;  ///< VDB: scalar grids that were not chosen
};

/// Opens a volume. `inputs`: one file, "-" for stdin, a folder, a glob that the shell left alone,
/// or several slices, raw or pictures (natural order is made here). What is packed by gzip or zstd
/// is unpacked.
/// Errors   input: missing, empty, damaged, of the wrong size, nothing to mesh; usage: options that
///          contradict each other or the kind of file, an invalid spec.
Source open_source(std::span<const std::string> inputs, const SourceOptions& options,
                   Progress& progress);

/// Knows the files that its thread opens as inputs during its life. Watches of one thread nest: a
/// file belongs to the innermost.
class InputWatch {
 public:
  InputWatch();
  ~InputWatch();
  InputWatch(const InputWatch&) = delete;
  InputWatch& operator=(const InputWatch&) = delete;

  /// Whether a file, open or closed by now, changed while it was open: what was made of it is not
  /// to be kept then. Errors   input: changed, or became shorter.
  void refuse_changed() const;

  struct State;

 private:
  std::unique_ptr<State> state_;
};

/// Does so for the innermost watch of this thread; nothing where there is none.
void refuse_changed_inputs();

/// For a handler of SIGBUS, which reading a mapped file raises once it has become shorter: where
/// `address` lies in an input, zeros take the place of what is gone, and a watch will tell.
/// Async-signal-safe. Returns whether it was an input.
bool recover_input(const void* address) noexcept;

/// One line of `mc info`: a grid that may or may not be meshable.
struct GridDescription {
  Volume volume;
  std::string type_name;  ///< "float", "vec3s", "ptdataidx32": as the format calls it
  std::string refused;    ///< why it cannot be meshed; empty if it can
};

/// Lists everything in the input without reading samples where the format allows it.
std::vector<GridDescription> describe_source(std::span<const std::string> inputs,
                                             const SourceOptions& options, Progress& progress);

/// Reads a mesh: PLY, OBJ, STL (welded by exact position), glTF, GLB, decided by content. Several
/// primitives or objects become one soup. "-" is stdin.
/// Errors   input.
MeshSoup read_mesh(const std::string& path);

}  // namespace mc
