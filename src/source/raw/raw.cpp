// SPDX-License-Identifier: MIT
#include "source/raw/raw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "base/checked.hpp"
#include "source/mapped_planes.hpp"
#include "source/placement.hpp"

namespace mc::source {

namespace {

constexpr std::int64_t kMostSamples = std::numeric_limits<std::int32_t>::max();

/// Dims as typed: "64x64" or "64x64x93".
std::string dims_text(const std::vector<std::int64_t>& dims) {
  return fmt::format("{}", fmt::join(dims, "x"));
}

void check_typed(const SourceOptions& options, const std::string& place) {
  if (options.dims.empty() || !options.type) {
    throw Error(ErrorKind::usage, place, "raw data says nothing of itself",
                "give --dims X,Y[,Z] and --type u8|i8|u16|i16|u32|i32|f16|f32|f64");
  }
  if (options.dims.size() < 2 || options.dims.size() > 3) {
    throw Error(ErrorKind::usage, "--dims",
                fmt::format("{} numbers, but two or three were expected", options.dims.size()));
  }
  for (const std::int64_t n : options.dims) {
    if (n < 2 || n > kMostSamples) {
      throw Error(ErrorKind::usage, "--dims",
                  fmt::format("{}: 2 to {} samples along each axis were expected",
                              dims_text(options.dims), kMostSamples));
    }
  }
  const std::int64_t nz = options.dims.size() == 3 ? options.dims[2] : 1;
  const auto bytes = volume_bytes(options.dims[0], options.dims[1], nz, *options.type);
  if (!bytes || !base::checked_add(*bytes, options.skip_bytes)) {
    throw Error(ErrorKind::usage, "--dims",
                fmt::format("{} {}: more bytes than 64 bits can count", dims_text(options.dims),
                            sample_name(*options.type)));
  }
}

[[noreturn]] void wrong_size(const MappedFile& file, const std::vector<std::int64_t>& dims,
                             const SourceOptions& options, std::uint64_t needed) {
  // A stream was read no further than one byte too many.
  const bool stream_goes_on = file.bytes().size() == needed + options.skip_bytes + 1;
  const bool skips = options.skip_bytes > 0;
  throw Error(ErrorKind::input, file.place(),
              fmt::format("{}{} bytes, but {} {}{} needs {}", stream_goes_on ? "at least " : "",
                          file.bytes().size(), dims_text(dims), sample_name(*options.type),
                          skips ? fmt::format(" after {} skipped bytes", options.skip_bytes) : "",
                          needed + options.skip_bytes),
              skips ? "check --dims, --type and --skip" : "check --dims and --type");
}

/// Planes that the bytes of one file make.
std::int64_t counted_planes(const MappedFile& file, const SourceOptions& options) {
  const std::uint64_t plane = *volume_bytes(options.dims[0], options.dims[1], 1, *options.type);
  const std::uint64_t size = file.bytes().size();
  const std::uint64_t samples = size > options.skip_bytes ? size - options.skip_bytes : 0;
  if (samples == 0 || samples % plane != 0) {
    throw Error(ErrorKind::input, file.place(),
                fmt::format("{} bytes, but {} {} planes need a multiple of {}{}", size,
                            dims_text(options.dims), sample_name(*options.type), plane,
                            options.skip_bytes > 0
                                ? fmt::format(" after {} skipped bytes", options.skip_bytes)
                                : ""),
                "check --dims and --type");
  }
  return static_cast<std::int64_t>(
      std::min<std::uint64_t>(samples / plane, std::uint64_t{kMostSamples} + 1));
}

Volume raw_volume(const SourceOptions& options, std::int64_t nz) {
  Volume volume;
  volume.format = "raw";
  volume.lattice.box.hi = {static_cast<std::int32_t>(options.dims[0] - 1),
                           static_cast<std::int32_t>(options.dims[1] - 1),
                           static_cast<std::int32_t>(nz - 1)};
  volume.lattice.to_world = placed(Affine{}, options);
  volume.type = *options.type;
  volume.endian = options.endian;
  return volume;
}

std::unique_ptr<SlabReader> open_single(const std::string& path, const SourceOptions& options) {
  const bool known = options.dims.size() == 3;
  MappedFile file(path, known ? *volume_bytes(options.dims[0], options.dims[1], options.dims[2],
                                              *options.type) +
                                    options.skip_bytes
                              : MappedFile::kUnlimited);
  const std::int64_t nz = known ? options.dims[2] : counted_planes(file, options);
  if (nz < 2 || nz > kMostSamples) {
    throw Error(ErrorKind::input, file.place(),
                fmt::format("{} planes of {} {}, but 2 to {} were expected", nz,
                            dims_text(options.dims), sample_name(*options.type), kMostSamples));
  }
  const std::vector<std::int64_t> dims{options.dims[0], options.dims[1], nz};
  const std::uint64_t needed = *volume_bytes(dims[0], dims[1], nz, *options.type);
  if (file.bytes().size() != needed + options.skip_bytes) {
    wrong_size(file, dims, options, needed);
  }
  std::vector<PlaneFile> files;
  files.push_back({std::move(file), options.skip_bytes});
  return std::make_unique<MappedPlanes>(raw_volume(options, nz), std::move(files),
                                        static_cast<std::int32_t>(nz));
}

std::unique_ptr<SlabReader> open_series(const InputFiles& inputs, const SourceOptions& options) {
  const auto n_files = static_cast<std::int64_t>(inputs.paths.size());
  if (options.dims.size() == 3 && options.dims[2] != n_files) {
    throw Error(ErrorKind::input, inputs.place,
                fmt::format("{} slices, but {} needs {}", n_files, dims_text(options.dims),
                            options.dims[2]),
                "check --dims");
  }
  const std::vector<std::int64_t> dims{options.dims[0], options.dims[1]};
  const std::uint64_t needed = *volume_bytes(dims[0], dims[1], 1, *options.type);
  std::vector<PlaneFile> files;
  files.reserve(inputs.paths.size());
  for (const std::string& path : inputs.paths) {
    MappedFile file(path);
    if (file.bytes().size() != needed + options.skip_bytes) {
      wrong_size(file, dims, options, needed);
    }
    files.push_back({std::move(file), options.skip_bytes});
  }
  return std::make_unique<MappedPlanes>(raw_volume(options, n_files), std::move(files), 1);
}

}  // namespace

std::unique_ptr<SlabReader> open_raw(const InputFiles& inputs, const SourceOptions& options) {
  check_typed(options, inputs.place);
  if (options.grid) {
    throw Error(ErrorKind::usage, "--grid", "raw data has no grids");
  }
  return inputs.paths.size() == 1 ? open_single(inputs.paths.front(), options)
                                  : open_series(inputs, options);
}

}  // namespace mc::source
