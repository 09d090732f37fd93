// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "mc/field.hpp"
#include "mc/source.hpp"

// What --spacing and --origin do to a lattice.

namespace mc::source {

/// Errors   usage: a spacing that is zero, negative or not finite; an origin that is not finite.
void check_placement(const SourceOptions& options);

/// Whether the options move anything.
[[nodiscard]] bool places(const SourceOptions& options);

/// The same samples under another placement.
std::unique_ptr<SlabReader> placed_reader(std::unique_ptr<SlabReader> reader,
                                          const SourceOptions& options);

/// Errors   input, named by `place`: a map that is singular or not finite.
void check_map(const Affine& to_world, std::string_view place);

}  // namespace mc::source
