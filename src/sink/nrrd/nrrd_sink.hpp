// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/field.hpp"
#include "mc/sink.hpp"

namespace mc::sink {

/// One file: a header (see nrrd_header()) and the raw samples after it, in their own byte order.
/// Half samples are written as float, which holds each of them exactly.
std::unique_ptr<VolumeSink> open_nrrd(const std::string& path, const SinkOptions& options);

inline constexpr SinkFormat kNrrdFormat{
    .name = "nrrd", .display = "NRRD", .extensions = "nrrd", .open_volume = open_nrrd};

}  // namespace mc::sink
