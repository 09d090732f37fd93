// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/field.hpp"
#include "mc/sink.hpp"

namespace mc::sink {

/// The samples alone, and beside them NAME.nhdr, a detached NRRD header that says what they are.
/// Both appear together. A stream or a device gets no header. Half samples are written as float,
/// since the header could not name them otherwise.
std::unique_ptr<VolumeSink> open_raw(const std::string& path, const SinkOptions& options);

inline constexpr SinkFormat kRawFormat{
    .name = "raw", .display = "raw data", .extensions = "raw", .open_volume = open_raw};

}  // namespace mc::sink
