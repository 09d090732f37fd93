// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"
#include "mc/graph.hpp"

// Brush edits: a brush is shape x falloff x operation over a box of samples. An EditStore is a
// volume that edits change; it keeps only the blocks that were touched. mc-edits(5) gives every
// formula.

namespace mc {

/// A linear map and the room to undo it: what turns a brush.
struct Turn {
  std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< rows, orthonormal; world = m * brush
  bool operator==(const Turn&) const = default;
};

enum class ShapeType : std::uint8_t {
  sphere,     ///< center, radius
  box,        ///< center, size (full), turn; rounding
  capsule,    ///< center, end, radius at center, end_radius at end
  cylinder,   ///< center, radius, height along the brush's y, turn; rounding
  cone,       ///< center (of its axis), radius below, end_radius above, height along y, turn
  ellipsoid,  ///< center, size (radii), turn
  plane,      ///< all that lies below `center` against `normal`
  node,       ///< what `field` calls solid, within `bounds`
};

/// Where a brush works, in the script's space. Signed distance: negative inside.
struct BrushShape {
  ShapeType type = ShapeType::sphere;
  Vec3 center{};
  Vec3 end{};
  Vec3 size{};
  Vec3 normal{0, 1, 0};  ///< unit length
  double radius = 0;
  double end_radius = 0;
  double height = 0;
  double rounding = 0;  ///< of edges; within the size
  Turn turn{};
  /// node: its value is the distance, positive inside (density, over iso 0), moved by `center`.
  std::shared_ptr<const GraphField> field{};
  std::array<Vec3, 2> bounds{};  ///< node: lowest and highest corner, before it is moved
};

enum class FalloffType : std::uint8_t {
  hard,
  linear,
  smoothstep,
  smootherstep,
  spherical,
  tip,
  curve,
  none,  ///< 1 wherever the operation reaches: csg beyond the shape, stamps all over; else as hard
};

/// The weight from 1 at inner * R to 0 at R, the shape's inradius; see mc-edits(5).
struct Falloff {
  FalloffType type = FalloffType::smoothstep;
  double inner = 0;                             ///< in [0, 1)
  std::vector<std::array<double, 2>> points{};  ///< curve: t and w, t rising from 0 to 1
};

/// What an edit does with the samples d that its weight w in [0, 1] reaches; s is its strength.
/// Everything is computed in double and rounded to the samples' type once a step.
/// - What adds (add, subtract, inflate, noise, a stamp that accumulates) is clamped: clamp(d +- s
/// w).
/// - What mixes stays between what it mixes: mix(d, v, t) = d + (v - d) t, and v where t >= 1.
/// - csg mixes with max(d, b) + c for what rises (the union where the solid is above) or
///   min(d, b) - c for what falls; b is iso and the shape's distance with the solid side's sign (of
///   a difference the other sign), c = h h k / 4 with h = max(k - |d - b|, 0) / k, k = `smooth`.
/// - NaN stays NaN, and what would become NaN stays what it is; only fill and a whole revert put
///   samples as they are.
enum class EditOp : std::uint8_t {
  add,       ///< more solid by s w, or the union with the shape (Blend::csg)
  subtract,  ///< less solid by s w, or the difference
  set,       ///< mix(d, value, s w)
  fill,      ///< value everywhere; no shape
  smooth,    ///< mix(d, mean around d, s w), of the field as it was before the edit
  flatten,   ///< mix(d, distance to a plane, s w)
  inflate,   ///< the surface outwards by s w world units: more solid by s w |gradient|
  noise,     ///< more solid by s w noise(p)
  revert,    ///< mix(d, the input's sample, s w)
  stamp,     ///< combined with another volume, placed by an affine map
  paint,     ///< material index where w >= 1/2
};

enum class Blend : std::uint8_t { accumulate, csg };
enum class SmoothKernel : std::uint8_t { box, gaussian, median };
enum class PathMode : std::uint8_t {
  dabs,   ///< the brush again and again, every `spacing` * radius of arc length: as so many edits
  sweep,  ///< once, by the distance to the whole polyline; a capsule's radius runs along its length
};

struct BrushPath {
  std::vector<Vec3> points{};  ///< at least two
  PathMode mode = PathMode::dabs;
  double spacing = 0.25;  ///< dabs: of the radius, > 0
};

/// The edit again, mirrored in the planes normal to `axes` through `at`.
struct Mirror {
  std::array<bool, 3> axes{};
  Vec3 at{};
};
/// The edit `count` times in all, each with its mirror images, turned around `axis` through `at`.
struct Radial {
  std::uint32_t count = 1;
  std::size_t axis = 1;
  Vec3 at{};
};

/// The plane of a flatten.
struct FlattenPlane {
  Vec3 point{};
  Vec3 normal{0, 1, 0};  ///< unit length, to the side that is not solid
};

/// One edit, complete: nothing is left to a default of the script's. World units, unless said.
struct Edit {
  EditOp op = EditOp::add;
  BrushShape shape{};
  Falloff falloff{};
  Blend blend = Blend::accumulate;
  double smooth = 0;        ///< csg: radius of the blend, world units
  double strength = 1;      ///< value units a step (accumulate, noise); else a part in [0, 1]
  std::uint32_t steps = 1;  ///< so often, each clamped: rate * duration in steps of dt
  std::array<double, 2> clamp{-std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};
  double value = 0;  ///< set, fill
  std::optional<BrushPath> path{};
  std::optional<Mirror> mirror{};
  std::optional<Radial> radial{};
  std::shared_ptr<const GraphField> mask{};  ///< weight, clamped to [0, 1]
  SmoothKernel kernel = SmoothKernel::gaussian;
  double kernel_radius = 1;  ///< samples
  std::uint32_t iterations = 1;
  std::optional<FlattenPlane> plane{};  ///< unset: fitted to the surface under the brush
  std::shared_ptr<const GraphField> noise{};
  std::shared_ptr<const SampledVolume> stamp{};  ///< many edits may have it; to_index is not used
  Affine stamp_to_index{};     ///< from the edits' space to the place among its samples
  double stamp_iso = 0;        ///< what its values are compared with
  bool stamp_above = true;     ///< its solid side
  bool stamp_carves = false;   ///< taken away instead of put in
  std::uint16_t material = 0;  ///< paint
};

/// What an edit did.
struct EditEffect {
  IndexBox touched{};           ///< samples whose value may differ now; empty where none
  std::uint64_t n_samples = 0;  ///< samples that the weight reached
  std::uint64_t n_changed = 0;  ///< samples whose bits differ
  std::uint64_t n_dabs = 0;     ///< brush positions, copies by symmetry included
  std::uint64_t n_outside = 0;  ///< of them wholly outside the volume: no-ops
};

/// What edits mean on this volume.
struct EditRules {
  bool above = true;  ///< samples above iso are solid, else those below
  double iso = 0;     ///< the surface that csg, flatten and stamps refer to
  Affine to_world{};  ///< where samples lie for the script: its space
};

/// A volume under edits. Reads go to the input until a block (8x8x8 samples) is touched; from then
/// on the block is stored. A sparse input stays sparse: what an edit touches becomes leaves.
/// Values keep the volume's type: integers are rounded to nearest, ties to even, and saturate.
/// The result depends on the order of the edits alone.
/// Threads  one caller; inside, work is shared among the threads of its arena.
/// Memory   2 KiB a touched block of f32, and as much again for each step that undo can take back.
class EditStore {
 public:
  /// Keeps a reference to `input`, which must outlive the store and is no stream.
  EditStore(const VolumeReader& input, const EditRules& rules);
  ~EditStore();
  EditStore(EditStore&& other) noexcept;
  EditStore& operator=(EditStore&& other) noexcept;

  [[nodiscard]] const EditRules& rules() const;
  /// The edited volume's description: as the input's; a sparse one's active box grows.
  [[nodiscard]] const Volume& volume() const;

  /// What apply() would touch, without touching it: n_changed is 0.
  [[nodiscard]] EditEffect measure(const Edit& edit) const;
  /// Applies one edit, which undo() takes back as one step.
  /// Errors   limit: memory; input: the input cannot be read.
  /// Cost     samples in the boxes of the brush's positions; copies of the blocks touched.
  EditEffect apply(const Edit& edit);
  /// Edits until end_group() are one step for undo(). Groups nest.
  void begin_group();
  void end_group();
  /// Take back, or do again, `count` steps; how many there were.
  std::size_t undo(std::size_t count = 1);
  std::size_t redo(std::size_t count = 1);
  /// Steps that are kept; older ones are forgotten (default: all).
  void keep_undo(std::size_t n_steps);
  /// What blocks and undo may hold (default: the machine's memory). An edit that could need more is
  /// refused before it touches anything.
  void limit_memory(std::uint64_t bytes);

  /// Boxes of samples that changed since the last call, undone ones too; empty boxes never.
  [[nodiscard]] std::vector<IndexBox> take_dirty();

  /// Copies the samples of `box` (within the volume's), x fastest, in the volume's type and native
  /// byte order. `out` holds box samples * sample_size bytes.
  void read_box(const IndexBox& box, std::span<std::byte> out) const;
  [[nodiscard]] std::uint64_t n_stored_blocks() const;
  [[nodiscard]] std::uint64_t stored_bytes() const;  ///< blocks and undo
  /// A hash of all stored blocks: equal for equal edits of equal inputs.
  [[nodiscard]] std::uint64_t hash() const;

  /// What the edited volume's vertices carry: the input's attributes, and paint over its materials;
  /// no materials while there are neither. Edits must rest while they are read.
  [[nodiscard]] AttributeReaders attributes() const;

  /// The edited volume behind the port of its kind, with the materials of paint over the input's:
  /// dense stays dense (what no edit touched is the input's, also its skipping), sparse stays
  /// sparse. Keeps a reference to the store, whose edits must rest while it is read.
  [[nodiscard]] VolumeReader reader() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mc
