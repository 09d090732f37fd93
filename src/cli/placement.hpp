// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "cli/resolve.hpp"
#include "mc/field.hpp"

// Where a mesh lies in its file: the source's frame and units against what the format and the user
// want (DESIGN section 5).

namespace mc::cli {

struct Placement {
  Affine to_world;                      ///< lattice to the file's coordinates
  Frame frame = Frame::none;            ///< of the file's coordinates; none for glTF, which is y-up
  Frame source_frame = Frame::none;     ///< the source's, or as declared
  Up source_up = Up::y;                 ///< of sources without a frame
  Units units = Units::unknown;         ///< of the file's coordinates
  Units source_units = Units::unknown;  ///< the source's, or as declared
};

/// Composes the map from `volume`'s lattice to an output of `format`.
/// glTF     y-up metres: superior -> +Y, anterior -> +Z, millimetres scaled; a frame without units
///          counts as millimetres. Others keep the source's frame and units, or take those chosen.
/// Errors   usage: an up axis for a source that has a frame; units that glTF cannot have.
Placement place(const Volume& volume, const PlaceChoice& choice, std::string_view format);

/// What rounding stored positions does to vertices.
struct RoundingLoss {
  double largest_move = 0;  ///< world units, at most; infinity where positions overflow
  bool matters = false;     ///< more than 1/8192 of the smallest cell spacing
  bool collapses = false;   ///< more than 1/8: neighbouring vertices may become one
};

/// Rounding of positions anywhere in `box` under `to_world`.
RoundingLoss rounding_loss(const IndexBox& box, const Affine& to_world, Precision precision);

/// A mesh whose vertices cannot be told apart is no mesh. Errors   limit; usage, where the map was
/// `asked` for.
void check_told_apart(const std::string& place, const IndexBox& box, const Affine& to_world,
                      const MeshNeeds& needs, bool asked);

/// The middle of the box: positions relative to it are small.
Vec3 double_origin(const IndexBox& box, const Affine& to_world);

const char* name_of(Frame frame);
const char* name_of(Units units);
const char* name_of(Up up);

}  // namespace mc::cli
