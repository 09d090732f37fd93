// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include "mc/source.hpp"
#include "source/input_files.hpp"
#include "source/mapped_file.hpp"
#include "source/stream/input_file.hpp"

// What is behind SourceInput, for the formats of this library.

namespace mc {

namespace source {
struct SpecNesting;
}

struct SourceInput::State {
  source::InputFiles files;
  Progress& progress;
  const source::SpecNesting* within = nullptr;  ///< of the document that names this input
  /// The first file, if its head has been read: a pipe gives those bytes once.
  std::optional<source::InputFile> first{};
};

namespace source {

/// Opens the first file unless it is open.
InputFile& first_file(SourceInput& input);
/// File n, opened. A second call for the same file opens it again.
InputFile take_file(SourceInput& input, std::size_t n = 0);
/// File n, mapped; a stream is copied first.
MappedFile map_file(SourceInput& input, std::size_t n = 0,
                    MappedFile::Keep keep = MappedFile::Keep::mapping);

}  // namespace source

}  // namespace mc
