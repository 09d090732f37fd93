// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/spec/spec_files.hpp"

// Procedural volumes: JSON documents of the format mc-volume, see mc-volume(5).

namespace mc::source {

/// Opens a document; `place` is how messages name it. The whole document is checked, and the files
/// that it names are read, before this returns; samples are computed as they are read.
/// Errors   usage: every fault of the document, a line each; as SpecFiles where it is within
///          others.
/// Cost     read() takes O(samples * nodes), one thread a call.
std::unique_ptr<SlabReader> open_spec_text(const std::string& place, std::string_view text,
                                           const SpecNesting& within = {});

/// Whether the first bytes of a file look like such a document, damaged ones included.
[[nodiscard]] bool looks_like_spec(std::string_view head);
/// As looks_like_spec(), but unsure of a JSON object that has not named its format yet.
[[nodiscard]] Recognition recognise_spec(std::string_view head);

/// Opens a document within the one that names it, if one does. Errors   as open_spec_text().
Source open_spec(SourceInput& input, const SourceOptions& options, Progress& progress);

inline constexpr SourceFormat kSpecFormat{.name = "spec",
                                          .display = "mc-volume",
                                          .extensions = "json",
                                          .recognise = recognise_spec,
                                          .own_iso = "the spec's own",
                                          .open = open_spec};

}  // namespace mc::source
