// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "mc/field.hpp"
#include "mc/sink.hpp"

namespace mc::sink {

/// The text of a NRRD header for a volume that is written whole, up to and with its empty line.
/// Ends with "data file" where `data_file` is not empty (a detached header).
/// Half samples are announced as float, for NRRD has no half type: SampleWriter converts them.
/// Written  provenance as comments; `mc name`, `mc class`, `mc iso`, `mc border` as key/value
///          pairs, each only where the volume has it.
/// Source   "Definition of NRRD File Format", version 5.
std::string nrrd_header(const Volume& volume, const SinkOptions& options,
                        std::string_view data_file = {});

}  // namespace mc::sink
