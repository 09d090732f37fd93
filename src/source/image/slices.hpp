// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/image/module/image_file.hpp"
#include "source/mapped_file.hpp"

namespace mc::source {

/// Pictures as the planes of a volume, k going up from the first. `files` are in order; of one with
/// several parts each part that has the channel is a plane, in the order of the parts. The bottom
/// row is j = 0.
/// Channel  options.channel, else that of channel_named() in the first part; a note lists the
/// others. Place    what mc wrote into them; else one world unit a pixel, the lower left of the
/// window that
///          the pictures are shown in at 0,0. options.spacing and origin override it.
/// Errors   input: damaged, another kind of file, fewer than two planes, planes that differ in
/// size,
///          place or type, a slice that is missing by the files' numbers or by what mc wrote.
/// Threads  read() decodes its planes one by one, and may be called from several threads.
std::unique_ptr<SlabReader> open_slices(std::vector<MappedFile> files, ImageKind kind,
                                        const SourceOptions& options, Progress& progress);

}  // namespace mc::source
