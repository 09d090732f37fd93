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
#include "source/source_input.hpp"
#include "source/stream/streamed_planes.hpp"

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

/// `n_bytes` are there; or more, of which nobody has seen the end.
[[noreturn]] void wrong_size(const std::string& place, std::uint64_t n_bytes, bool at_least,
                             const std::vector<std::int64_t>& dims, const SourceOptions& options) {
  const std::int64_t nz = dims.size() == 3 ? dims[2] : 1;
  const std::uint64_t needed = *volume_bytes(dims[0], dims[1], nz, *options.type);
  const bool skips = options.skip_bytes > 0;
  throw Error(ErrorKind::input, place,
              fmt::format("{}{} bytes, but {} {}{} needs {}", at_least ? "at least " : "", n_bytes,
                          dims_text(dims), sample_name(*options.type),
                          skips ? fmt::format(" after {} skipped bytes", options.skip_bytes) : "",
                          needed + options.skip_bytes),
              skips ? "check --dims, --type and --skip" : "check --dims and --type");
}

/// Opens file n, which holds `n_bytes`, the skipped ones among them. Samples that begin like packed
/// data but have the right size are samples.
InputFile open_sized(SourceInput& inputs, std::size_t n, std::uint64_t n_bytes) {
  InputFile file = take_file(inputs, n);
  const bool stored = file.packing() != Packing::none && file.stored_bytes() == n_bytes;
  return stored ? InputFile(inputs.paths()[n], InputFile::Bytes::stored) : std::move(file);
}

/// A file of known size; of a stream no more was read than one byte too many.
MappedFile map_sized(InputFile input, std::uint64_t n_bytes, const std::vector<std::int64_t>& dims,
                     const SourceOptions& options, Progress& progress,
                     MappedFile::Keep keep = MappedFile::Keep::mapping) {
  const bool stream = !input.mappable();
  MappedFile file(std::move(input), n_bytes, progress, keep);
  if (file.bytes().size() != n_bytes) {
    wrong_size(file.place(), file.bytes().size(), stream && file.bytes().size() == n_bytes + 1,
               dims, options);
  }
  return file;
}

/// Samples of a stream whose size is known.
class RawSamples final : public SampleStream {
 public:
  RawSamples(InputFile input, std::vector<std::int64_t> dims, SourceOptions options)
      : place_(input.place()), dims_(std::move(dims)), options_(std::move(options)) {
    stream_ = std::move(input).stream();
    n_read_ = pass_over(*stream_, options_.skip_bytes);
  }

  void read(std::span<std::byte> out) override {
    const std::size_t n = stream_->read(out);
    n_read_ += n;
    if (n < out.size()) wrong_size(place_, n_read_, false, dims_, options_);
  }
  void finish() override {
    std::byte more{};
    if (stream_->read({&more, 1}) != 0) wrong_size(place_, n_read_ + 1, true, dims_, options_);
  }
  [[nodiscard]] const std::string& place() const override { return place_; }

 private:
  std::string place_;
  std::vector<std::int64_t> dims_;
  SourceOptions options_;
  std::unique_ptr<ByteStream> stream_;
  std::uint64_t n_read_ = 0;
};

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
  volume.format = kRawFormat.name;
  volume.lattice.box.hi = {static_cast<std::int32_t>(options.dims[0] - 1),
                           static_cast<std::int32_t>(options.dims[1] - 1),
                           static_cast<std::int32_t>(nz - 1)};
  volume.lattice.to_world = placed(Affine{}, options);
  volume.type = *options.type;
  volume.endian = options.endian;
  return volume;
}

/// Of a volume whose sizes are typed.
VolumeReader open_sized_volume(SourceInput& inputs, const SourceOptions& options,
                               Progress& progress) {
  const std::vector<std::int64_t>& dims = options.dims;
  const std::uint64_t n_bytes =
      *volume_bytes(dims[0], dims[1], dims[2], *options.type) + options.skip_bytes;
  InputFile input = open_sized(inputs, 0, n_bytes);
  Volume volume = raw_volume(options, dims[2]);
  if (options.streams && !input.mappable()) {
    return std::make_unique<StreamedPlanes>(
        std::move(volume), std::make_unique<RawSamples>(std::move(input), dims, options));
  }
  std::vector<PlaneFile> files;
  files.push_back(
      {map_sized(std::move(input), n_bytes, dims, options, progress, MappedFile::Keep::open_file),
       options.skip_bytes});
  return std::make_unique<MappedPlanes>(std::move(volume), std::move(files),
                                        static_cast<std::int32_t>(dims[2]), options.reading);
}

/// Of a volume whose planes its size tells.
std::unique_ptr<SlabReader> open_counted_volume(SourceInput& inputs, const SourceOptions& options) {
  MappedFile file = map_file(inputs, 0, MappedFile::Keep::open_file);
  const std::int64_t nz = counted_planes(file, options);
  if (nz < 2 || nz > kMostSamples) {
    throw Error(ErrorKind::input, file.place(),
                fmt::format("{} planes of {} {}, but 2 to {} were expected", nz,
                            dims_text(options.dims), sample_name(*options.type), kMostSamples));
  }
  std::vector<PlaneFile> files;
  files.push_back({std::move(file), options.skip_bytes});
  return std::make_unique<MappedPlanes>(raw_volume(options, nz), std::move(files),
                                        static_cast<std::int32_t>(nz), options.reading);
}

std::unique_ptr<SlabReader> open_series(SourceInput& inputs, const SourceOptions& options,
                                        Progress& progress) {
  const auto n_files = static_cast<std::int64_t>(inputs.paths().size());
  if (options.dims.size() == 3 && options.dims[2] != n_files) {
    throw Error(ErrorKind::input, inputs.place(),
                fmt::format("{} slices, but {} needs {}", n_files, dims_text(options.dims),
                            options.dims[2]),
                "check --dims");
  }
  const std::vector<std::int64_t> dims{options.dims[0], options.dims[1]};
  const std::uint64_t n_bytes =
      *volume_bytes(dims[0], dims[1], 1, *options.type) + options.skip_bytes;
  std::vector<PlaneFile> files;
  files.reserve(inputs.paths().size());
  for (std::size_t n = 0; n < inputs.paths().size(); ++n) {
    files.push_back({map_sized(open_sized(inputs, n, n_bytes), n_bytes, dims, options, progress),
                     options.skip_bytes});
  }
  return std::make_unique<MappedPlanes>(raw_volume(options, n_files), std::move(files), 1);
}

}  // namespace

Source open_raw(SourceInput& input, const SourceOptions& options, Progress& progress) {
  check_typed(options, input.place());
  Source source;
  if (input.paths().size() > 1) {
    source.reader = open_series(input, options, progress);
  } else if (options.dims.size() == 3) {
    source.reader = open_sized_volume(input, options, progress);
  } else {
    source.reader = open_counted_volume(input, options);
  }
  return source;
}

}  // namespace mc::source
