// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "mc/base.hpp"

// Scalar fields on a lattice, and the ports they come in by: SlabReader for dense volumes,
// PlaneStream for dense volumes that can be read only once, LeafReader for sparse ones. Sources
// implement them; the engine knows nothing else. VolumeSink is the port by which volumes (not
// meshes) leave.

namespace mc {

/// A 3x4 affine map, row-major: world = m * (i, j, k, 1).
struct Affine {
  std::array<double, 12> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  static Affine scale_translate(const Vec3& spacing, const Vec3& origin);

  /// Terms are added in one fixed order, ((m0*i + m1*j) + m2*k) + m3, without fused multiply-add.
  [[nodiscard]] Vec3 operator()(const Vec3& p) const;
  /// Determinant of the linear part; negative for a mirroring map.
  [[nodiscard]] double determinant() const;
  /// The map that applies `first`, then this one.
  [[nodiscard]] Affine after(const Affine& first) const;
  /// The map back; none where this one flattens space, or the map back overflows.
  [[nodiscard]] std::optional<Affine> inverse() const;
  /// Length of the image of a unit step along `axis`.
  [[nodiscard]] double spacing(int axis) const;
  bool operator==(const Affine&) const = default;
};

/// An inclusive box of lattice indices.
struct IndexBox {
  Index3 lo{};
  Index3 hi{-1, -1, -1};

  [[nodiscard]] std::int64_t extent(int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    return std::int64_t{hi[a]} - lo[a] + 1;
  }
  [[nodiscard]] bool contains(const Index3& p) const;
  [[nodiscard]] bool contains(const IndexBox& other) const;
  bool operator==(const IndexBox&) const = default;
};
[[nodiscard]] inline bool is_empty(const IndexBox& box) {
  return box.lo[0] > box.hi[0] || box.lo[1] > box.hi[1] || box.lo[2] > box.hi[2];
}
[[nodiscard]] inline IndexBox common_part(const IndexBox& a, const IndexBox& b) {
  IndexBox out;
  for (std::size_t n = 0; n < 3; ++n) {
    out.lo[n] = a.lo[n] > b.lo[n] ? a.lo[n] : b.lo[n];
    out.hi[n] = a.hi[n] < b.hi[n] ? a.hi[n] : b.hi[n];
  }
  return out;
}
/// The least box around both; an empty one adds nothing.
[[nodiscard]] inline IndexBox joined(const IndexBox& a, const IndexBox& b) {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  IndexBox out;
  for (std::size_t n = 0; n < 3; ++n) {
    out.lo[n] = a.lo[n] < b.lo[n] ? a.lo[n] : b.lo[n];
    out.hi[n] = a.hi[n] > b.hi[n] ? a.hi[n] : b.hi[n];
  }
  return out;
}
/// Planes [k0, k1) of a box, counted from its lowest.
[[nodiscard]] inline IndexBox planes_of(IndexBox box, std::int32_t k0, std::int32_t k1) {
  box.hi[2] = box.lo[2] + k1 - 1;
  box.lo[2] += k0;
  return box;
}
/// With n more samples on all sides.
[[nodiscard]] inline IndexBox grown(IndexBox box, std::int32_t n) {
  for (std::size_t a = 0; a < 3; ++a) {
    box.lo[a] -= n;
    box.hi[a] += n;
  }
  return box;
}

/// Where samples are: their index box, and where an index lies in the world.
struct Lattice {
  IndexBox box;  ///< dense volumes start at 0,0,0; sparse ones give their active bounding box
  Affine to_world;

  [[nodiscard]] Index3 dims() const;  ///< precondition: each extent fits 31 bits
};

enum class SampleType : std::uint8_t { u8, i8, u16, i16, u32, i32, i64, f16, f32, f64 };

[[nodiscard]] std::size_t sample_size(SampleType type);  ///< bytes
[[nodiscard]] const char* sample_name(SampleType type);  ///< "u8" ... "f64", as on the command line
[[nodiscard]] std::optional<SampleType> sample_type_named(std::string_view name);

/// What a vertex carries besides its position and normal: one to four numbers of one type.
struct AttributeInfo {
  std::string name;
  SampleType type = SampleType::f32;
  std::uint8_t n_components = 1;

  /// Bytes that it takes of each vertex.
  [[nodiscard]] std::size_t bytes() const { return n_components * sample_size(type); }
  bool operator==(const AttributeInfo&) const = default;
};

/// The attribute that is the index of a vertex's material: "material", u16.
[[nodiscard]] const AttributeInfo& material_attribute();
/// Refuses attributes that formats cannot tell apart. A name starts with a letter, goes on with
/// letters, digits and underscores, at most 64 in all, and is not one of position and normal. No
/// two names are equal without regard to case, nor is one the other's followed by _x, _y, _z or _w.
/// "material" is material_attribute().
/// Errors   usage: the name, and what is wrong with it.
void check_attributes(std::span<const AttributeInfo> attributes);

/// The bits of an IEEE binary16 number; arithmetic happens in float.
struct Half {
  std::uint16_t bits;
};
[[nodiscard]] float to_float(Half h) noexcept;
/// Rounds to nearest, ties to even.
[[nodiscard]] Half to_half(float f) noexcept;

/// One sample of some SampleType, in native byte order.
struct Scalar {
  alignas(8) std::array<std::byte, 8> bytes{};

  template <class T>
  static Scalar of(T value) {
    Scalar s;
    std::memcpy(s.bytes.data(), &value, sizeof value);
    return s;
  }
  template <class T>
  [[nodiscard]] T as() const {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  bool operator==(const Scalar&) const = default;
};
[[nodiscard]] double to_double(Scalar s, SampleType type);

/// What the numbers mean, as far as the source says; it decides the default iso and solid side.
enum class VolumeClass : std::uint8_t { unknown, level_set, fog, mask, density_spec, sdf_spec };
/// Which axes world coordinates follow: none known, right-anterior-superior,
/// left-posterior-superior.
enum class Frame : std::uint8_t { none, ras, lps };
enum class Units : std::uint8_t { unknown, mm, m };
/// What surrounds the volume: nothing (the mesh ends there), not-solid samples, or solid samples.
enum class Border : std::uint8_t { open, closed, solid };

/// What a source says of its volume.
struct Volume {
  std::string name;    ///< of the grid; empty where it has none
  std::string format;  ///< SourceFormat::name
  Lattice lattice;
  SampleType type = SampleType::f32;
  std::endian endian = std::endian::native;  ///< of the samples a SlabReader hands out
  VolumeClass cls = VolumeClass::unknown;
  Frame frame = Frame::none;
  Units units = Units::unknown;
  std::optional<double> iso;              ///< the source's own, if it has one
  std::optional<Border> border;           ///< the source's own, if it has one
  std::string stored_as;                  ///< "half" where the file stores less than `type`; or ""
  std::optional<std::uint64_t> n_active;  ///< sparse: active samples
};

/// Where a run looks at a dense volume: at the surface, and a step of the lattice around it.
struct SurfaceQuery {
  double iso = 0;       ///< as samples are compared with it
  IndexBox region;      ///< nothing outside it is looked at
  bool capped = false;  ///< a constant layer surrounds the region: its faces' sides count too
};

/// The samples that a reader left out because the surface is not near them, and on which side of it
/// they lie: one bit a sample along i, one row of bits for blocks of rows and planes.
class SideMap {
 public:
  /// Nothing is left out, and nothing is known.
  void clear() { n_left_out_ = 0, known_.clear(), above_.clear(); }
  /// Nothing is left out of `box` yet. A block has so many rows and planes, counted from box.lo.
  void reset(const IndexBox& box, std::int32_t rows, std::int32_t planes);
  /// Leaves out the samples of a box of whole blocks along j (or up to the end), within one block
  /// along k.
  void leave_out(const IndexBox& part, bool above);

  [[nodiscard]] bool empty() const { return known_.empty(); }
  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] std::int32_t rows() const { return rows_; }
  [[nodiscard]] std::uint64_t n_left_out() const { return n_left_out_; }
  /// The bits of a row: bit n is sample box.lo[0] + n. Bits past the end are known, and not above.
  [[nodiscard]] std::span<const std::uint64_t> known(std::int32_t j, std::int32_t k) const {
    return std::span(known_).subspan(row(j, k), n_words_);
  }
  [[nodiscard]] std::span<const std::uint64_t> above(std::int32_t j, std::int32_t k) const {
    return std::span(above_).subspan(row(j, k), n_words_);
  }

 private:
  [[nodiscard]] std::size_t row(std::int32_t j, std::int32_t k) const;

  IndexBox box_;
  std::int32_t rows_ = 1, planes_ = 1;
  std::size_t n_row_blocks_ = 0, n_words_ = 0;
  std::vector<std::uint64_t> known_, above_;
  std::uint64_t n_left_out_ = 0;
};

/// Consecutive planes of samples: planes[n] is plane k0 + n and starts with sample i0 of row j0 (0
/// where whole planes are held), rows lie row_stride_bytes apart, the samples of a row are
/// adjacent, nothing is aligned. Mapped sources point into the mapping, others
/// into `storage`, which a reused Slab keeps from read to read. Samples that `sides` leaves out are
/// not there: their memory holds anything.
struct Slab {
  /// Makes `storage` hold the samples of `box` without gaps, i fastest, and points `planes` at
  /// them. The contents are undefined, `sides` and `shared` are emptied. Memory that is large
  /// enough is reused; a copying reallocation would briefly hold both buffers.
  /// Errors   limit: more bytes than an address space has.
  void allocate(const IndexBox& box, std::size_t sample_bytes);

  std::int32_t i0 = 0, j0 = 0, k0 = 0;
  std::vector<const std::byte*> planes;
  std::size_t row_stride_bytes = 0;
  Buffer<std::byte> storage;
  /// Memory of a source's own that several slabs point into: it stays while one does.
  std::vector<std::shared_ptr<const std::byte>> shared;
  SideMap sides;
};

/// What the numbers of a volume are. Sparse volumes: active samples only, active tiles included.
struct FieldStatistics {
  std::uint64_t n_samples = 0;  ///< all that were looked at
  std::uint64_t n_nan = 0;
  std::uint64_t n_infinite = 0;
  double min = 0, max = 0, mean = 0;  ///< over the finite samples; NaN where there are none
  double otsu = 0;  ///< the threshold of Otsu 1979; NaN where there are no finite samples
  std::vector<double> percentiles;  ///< in the order asked for
};

/// The port of vertex attributes: the values of one at places in a volume.
class AttributeReader {
 public:
  virtual ~AttributeReader() = default;
  [[nodiscard]] virtual const AttributeInfo& info() const = 0;
  /// Fills `out` with the value at each of `places`, which are lattice coordinates, also between
  /// samples and beyond them. Returns at how many places the value is one that the type cannot
  /// hold: it is clamped then, NaN becomes 0.
  /// Shapes   out: places.size() * info().bytes(), aligned for every type.
  /// Threads  may be called from several threads at once. A value depends on its place alone.
  virtual std::size_t values_at(std::span<const Vec3> places, std::byte* out) const = 0;
};
/// Attributes of one volume, which owns them. A material comes last, so that the first paint adds
/// it at the end.
using AttributeReaders = std::span<const AttributeReader* const>;
/// The one of that kind; null if there is none.
[[nodiscard]] const AttributeReader* find_attribute(AttributeReaders readers,
                                                    const AttributeInfo& info);

/// The port of dense volumes.
class SlabReader {
 public:
  virtual ~SlabReader() = default;
  [[nodiscard]] virtual const Volume& volume() const = 0;
  /// Hands out planes [k0, k1) of the volume's box (k counts from box.lo[2] = 0).
  /// Threads: may be called from several threads at once, in any order, each with its own Slab.
  /// Errors: input, when the planes cannot be read.
  virtual void read(std::int32_t k0, std::int32_t k1, Slab& out) const = 0;
  /// read(), for who looks only where `query` says: may leave out other samples, and tells on which
  /// side of the surface they lie. What is there has the bits that read() gives it. All is there of
  /// a sample that lies at most one step, also diagonally, from an end of a crossed lattice edge of
  /// these planes; where the query is capped, samples on the region's faces that are left out hold
  /// an infinity of their side.
  virtual void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                            Slab& out) const;
  /// Copies the samples of `box`, which lies within the volume's, to `out`: i fastest, without
  /// gaps, in the volume's type and byte order. `out` has exactly their size.
  /// Threads: as read(). Cost: reads the box's planes one by one, unless overridden.
  virtual void read_box(const IndexBox& box, std::span<std::byte> out) const;
  /// Whether read_box() costs less than the planes that the box lies in, as where samples are
  /// computed.
  [[nodiscard]] virtual bool reads_boxes_cheaply() const { return false; }
  /// Whether reading planes again costs no more than memory bandwidth (mapped files).
  [[nodiscard]] virtual bool rereads_cheaply() const = 0;
  /// A reader of the same planes that copies them, if that is faster than what read() does; its
  /// slabs share planes through Slab::shared, `n_planes` of them at once. It refers to this reader,
  /// and its own volume() may lie elsewhere in the world. Null: there is none.
  [[nodiscard]] virtual std::unique_ptr<SlabReader> copies(std::size_t /*n_planes*/) const {
    return nullptr;
  }
  /// What the volume's vertices carry; all of them pass check_attributes().
  [[nodiscard]] virtual AttributeReaders attributes() const { return {}; }
  /// Memory that it holds from plane to plane, pages of mapped files aside.
  [[nodiscard]] virtual std::uint64_t held_bytes() const { return 0; }
};

/// The port of dense volumes whose planes can be read only once, in order: pipes and packed files.
/// Only callers that set SourceOptions::streams get one.
class PlaneStream {
 public:
  virtual ~PlaneStream() = default;
  [[nodiscard]] virtual const Volume& volume() const = 0;
  /// Hands out planes [k0, k1) of the volume's box. No k0 is lower than in the read before, and the
  /// last read ends with the last plane.
  /// Threads: one call at a time. Errors: input, when the planes cannot be read.
  virtual void read(std::int32_t k0, std::int32_t k1, Slab& out) = 0;
  /// Like read(), for a caller that needs only the surface in `query`: once samples on both sides
  /// of it have passed, statistics() may leave out the rest.
  virtual void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                            Slab& out) = 0;
  /// Copies all samples to disk and returns a reader of the copy; this stream is used up. Call it
  /// before the first read. Errors: input; output, when the copy does not fit on the disk.
  [[nodiscard]] virtual std::unique_ptr<SlabReader> spool(Progress& progress) = 0;
  /// Counts and range of the samples read so far.
  [[nodiscard]] virtual FieldStatistics statistics() const = 0;
};

/// A cube of equal samples, `size` a multiple of 8, `origin` a multiple of `size`.
struct Tile {
  Index3 origin{};
  std::int32_t size = 0;
  Scalar value;
  bool active = false;
};

/// The port of sparse volumes: 8x8x8 leaves, tiles, and a background everywhere else. Leaves and
/// tiles do not overlap. Inactive values count as values.
class LeafReader {
 public:
  /// Samples of one leaf.
  static constexpr std::size_t kLeafSamples = 512;

  virtual ~LeafReader() = default;
  [[nodiscard]] virtual const Volume& volume() const = 0;
  [[nodiscard]] virtual Scalar background() const = 0;
  /// Origins of all leaves (multiples of 8), ordered by (z, y, x).
  [[nodiscard]] virtual std::span<const Index3> leaves() const = 0;
  /// The 512 samples of leaf n, sample (x, y, z) at x*64 + y*8 + z, in native byte order, in the
  /// volume's type. Returns memory of the reader's, or `scratch` (512 * 8 bytes) filled.
  /// Threads: may be called from several threads at once.
  virtual const std::byte* leaf_values(std::size_t n, std::byte* scratch) const = 0;
  /// Bit x*64 + y*8 + z of the eight words is set where the sample is active.
  [[nodiscard]] virtual std::array<std::uint64_t, 8> leaf_active(std::size_t n) const = 0;
  /// Every tile whose value differs from the background or that is active, in any order.
  [[nodiscard]] virtual std::span<const Tile> tiles() const = 0;
  /// What the volume's vertices carry; all of them pass check_attributes().
  [[nodiscard]] virtual AttributeReaders attributes() const { return {}; }
  /// Memory that it holds, pages of mapped files aside.
  [[nodiscard]] virtual std::uint64_t held_bytes() const { return 0; }
};

/// A volume of any kind.
using VolumeReader = std::variant<std::unique_ptr<SlabReader>, std::unique_ptr<LeafReader>,
                                  std::unique_ptr<PlaneStream>>;
[[nodiscard]] const Volume& volume_of(const VolumeReader& reader);
/// The volume's vertex attributes; a stream has none.
[[nodiscard]] AttributeReaders attributes_of(const VolumeReader& reader);
[[nodiscard]] inline bool is_dense(const VolumeReader& reader) {
  return !std::holds_alternative<std::unique_ptr<LeafReader>>(reader);
}
[[nodiscard]] inline bool is_stream(const VolumeReader& reader) {
  return std::holds_alternative<std::unique_ptr<PlaneStream>>(reader);
}
/// Replaces a stream by a copy of its samples on disk, which can be read in any order and again;
/// leaves other readers alone. Returns whether it was a stream. Errors: as PlaneStream::spool().
bool spool_stream(VolumeReader& reader, Progress& progress);
/// Memory that the reader holds, pages of mapped files and the planes of streams aside.
[[nodiscard]] std::uint64_t held_bytes_of(const VolumeReader& reader);
/// What is left of so much memory beside an input that holds so much. At least half: an input that
/// holds more cannot be made smaller.
[[nodiscard]] constexpr std::uint64_t memory_beside(std::uint64_t held_bytes,
                                                    std::uint64_t memory_bytes) {
  const std::uint64_t half = memory_bytes / 2;
  return memory_bytes - (held_bytes < half ? held_bytes : half);
}

/// The port by which volumes leave.
class VolumeSink {
 public:
  virtual ~VolumeSink() = default;
  /// Called once, before any samples.
  virtual void begin(const Volume& volume) = 0;
  /// Planes in order from 0, each exactly once.
  virtual void write(const Slab& slab) = 0;
  /// Takes a sparse volume whole and keeps it sparse. Returns false if the format is dense: the
  /// caller then hands planes to write().
  virtual bool write_sparse(const LeafReader& reader) = 0;
  /// Completes the output and puts it under its name. Not called: nothing remains.
  virtual void finish() = 0;
};

/// A dense reader over part of a sparse one: `box` is filled from leaves, tiles and background.
/// The result's lattice starts at 0,0,0 and has box.lo moved into its affine. Keeps a reference.
std::unique_ptr<SlabReader> dense_view(const LeafReader& sparse, const IndexBox& box);

/// Part of a dense volume; indices start at 0,0,0 again, the affine keeps samples in place.
/// Keeps a reference.
std::unique_ptr<SlabReader> crop_view(const SlabReader& whole, const IndexBox& box);

/// Reads every sample (the scalars more than once where percentiles of wide types are asked for).
/// Precondition: not a stream, see spool_stream().
/// Percentiles  in [0, 100], nearest rank over the samples that are not NaN: always a value of the
/// data. Otsu     exact histogram for 8- and 16-bit types, else 1024 bins over the finite range;
/// the value
///          is the upper edge of the winning bin.
/// Threads  uses the caller's arena; the result does not depend on the thread count.
/// Memory   at most `memory_bytes` where one thread's counters and planes fit: else those.
/// Cost     one pass; plus for percentiles of 32- and 64-bit types one pass for each 16 bits.
/// Source   Otsu, "A threshold selection method from gray-level histograms", IEEE SMC 1979.
FieldStatistics measure_field(const VolumeReader& reader, std::span<const double> percentiles,
                              Progress& progress, const std::stop_token& stop,
                              std::uint64_t memory_bytes = 1ULL << 30);

}  // namespace mc
