// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "mc/source.hpp"
#include "source/formats.hpp"
#include "source/open_named.hpp"
#include "source/placement.hpp"
#include "source/source_input.hpp"
#include "source/text.hpp"

// What an input is, and who reads it. Decided by --from, then by --dims with --type (raw), then by
// content, then by extension.

namespace mc::source {

namespace {

constexpr std::string_view kRawRemedy = "for raw data give --dims X,Y[,Z] and --type";

[[noreturn]] void unsupported(const SourceFormat& format, std::string_view place) {
  if (!format.refusal.empty()) {
    throw Error(ErrorKind::input, place, format.refusal);
  }
  throw Error(ErrorKind::input, place,
              fmt::format("{} is not supported by this version", format.display),
              "convert it to VDB, NRRD or raw first");
}

bool is_readable(const SourceFormat& format) { return format.open != nullptr; }

/// What the content of the first file says, then its name, that of a packed file without .gz or
/// .zst. Null: nothing.
const SourceFormat* recognised_format(SourceInput& input, const SourceOptions& options) {
  const SourceFormats further = options.further_formats;
  const SourceFormat* format = format_of_content(input, further);
  return format != nullptr
             ? format
             : format_of_extension(unpacked_extension_of(input.paths().front()), further);
}

/// Several files without --dims and --type: slices by the first of them. Else no volume, but the
/// first tells what is missing.
const SourceFormat& decide_by_series(SourceInput& input, const SourceOptions& options) {
  const SourceFormat* format = recognised_format(input, options);
  if (format != nullptr && format->several_files && !format->headerless) {
    return *format;
  }
  if (format != nullptr && !is_readable(*format)) {
    unsupported(*format, input.place());
  }
  if (input.state().files.from_folder) {
    throw Error(ErrorKind::input, input.place(), "a folder with no known file", kRawRemedy);
  }
  throw Error(
      ErrorKind::usage, input.place(),
      fmt::format("{} files, but only slices make one volume together", input.paths().size()),
      kRawRemedy);
}

/// Goes on with the header beside the input, if there is one. Returns its format.
const SourceFormat* take_sidecar(SourceInput& input, const SourceFormat& format,
                                 const SourceOptions& options) {
  if (format.sidecar.empty()) return nullptr;
  std::filesystem::path sidecar(input.paths().front());
  sidecar.replace_extension(format.sidecar);
  std::error_code ignored;
  if (!std::filesystem::exists(sidecar, ignored)) return nullptr;
  check_within(options.root, sidecar.string());
  input.state().files.paths.front() = sidecar.string();
  input.state().first.reset();
  first_file(input);
  return format_of_extension(format.sidecar, options.further_formats);
}

const SourceFormat& decide_by_file(SourceInput& input, const SourceOptions& options) {
  first_file(input).refuse_device();
  const bool wants_raw = !options.dims.empty() || options.type.has_value();
  const SourceFormat* format = recognised_format(input, options);
  if (format == nullptr && wants_raw) {
    return headerless_format(options.further_formats);
  }
  if (format == nullptr) {
    throw Error(ErrorKind::usage, input.place(),
                "neither its content nor its extension says what it is",
                fmt::format("name it by --from, or {}", kRawRemedy));
  }
  if (!is_readable(*format)) {
    unsupported(*format, input.place());
  }
  const SourceFormat* sidecar = wants_raw ? nullptr : take_sidecar(input, *format, options);
  return sidecar != nullptr ? *sidecar : *format;
}

const SourceFormat& decide_by_name(SourceInput& input, const SourceOptions& options) {
  const SourceFormat* format = find_source_format(options.from, options.further_formats);
  if (format == nullptr) {
    throw Error(
        ErrorKind::usage, "--from",
        fmt::format("{} is no kind of input", quoted_text(options.from)),
        fmt::format("choose one of {}", fmt::join(readable_names(options.further_formats), ", ")));
  }
  if (!is_readable(*format)) {
    unsupported(*format, input.place());
  }
  if (format->several_files) {
    return *format;
  }
  if (input.paths().size() > 1) {
    throw Error(
        ErrorKind::usage, input.place(),
        fmt::format("{} files, but --from {} reads one", input.paths().size(), options.from));
  }
  first_file(input);
  return *format;
}

const SourceFormat& decide(SourceInput& input, const SourceOptions& options) {
  if (!options.from.empty()) {
    return decide_by_name(input, options);
  }
  if (!options.dims.empty() && options.type) {
    return headerless_format(options.further_formats);
  }
  if (input.state().files.from_folder || input.paths().size() > 1) {
    return decide_by_series(input, options);
  }
  return decide_by_file(input, options);
}

/// Options that say what raw data is contradict a file that says it itself.
void check_options(const SourceInput& input, const SourceFormat& format,
                   const SourceOptions& options) {
  const auto refuse = [&](bool given, bool taken, std::string_view option, std::string_view what) {
    if (given && !taken) {
      throw Error(ErrorKind::usage, option,
                  fmt::format("is for {}, but {} is {}", what, input.place(), format.display));
    }
  };
  const SourceTakes& takes = format.takes;
  refuse(options.channel.has_value(), takes.channel, "--channel", "pictures");
  refuse(options.grid.has_value(), takes.grid, "--grid", "VDB files");
  refuse(!options.dims.empty(), takes.dims, "--dims", "raw data");
  refuse(options.type.has_value(), takes.type, "--type", "raw data");
  refuse(options.endian != std::endian::little, takes.endian, "--endian", "raw data");
  refuse(options.skip_bytes != 0, takes.skip, "--skip", "raw data");
}

Source open_decided(SourceInput& input, const SourceFormat& format, const SourceOptions& options,
                    Progress& progress) {
  Source source = format.open(input, options, progress);
  source.place = input.place();
  return source;
}

SourceInput input_of(std::span<const std::string> inputs, Progress& progress,
                     const SpecNesting* within = nullptr) {
  return SourceInput(std::make_unique<SourceInput::State>(
      SourceInput::State{expand_inputs(inputs, progress), progress, within}));
}

/// What a document's volume is: it has to say that, and its sizes, itself.
const SourceFormat& decide_by_content(SourceInput& input, const SourceOptions& options) {
  try {
    const SourceFormat& format = decide(input, options);
    if (!format.headerless) {
      return format;
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) {
      throw;
    }
  }
  throw Error(ErrorKind::input, input.place(), "does not say what volume it is",
              "give raw data a NRRD header (.nhdr) and name that");
}

}  // namespace

Source open_named(const std::string& path, const std::optional<std::string>& grid,
                  const SpecNesting& within) {
  SourceInput input = input_of({&path, 1}, silent_progress(), &within);
  for (const std::string& each : input.paths()) {
    check_within(within.root, each);
    check_regular(each);
  }
  SourceOptions options;
  options.root = within.root;
  options.further_formats = within.further_formats;
  options.memory_bytes = 2 * within.left * sizeof(float);  // so that half of it is left
  const SourceFormat& format = decide_by_content(input, options);
  if (grid && !format.takes.grid) {
    throw Error(ErrorKind::input, path, fmt::format("{} has no grids by name", format.display),
                "leave out \"grid\"");
  }
  options.grid = grid;
  return open_decided(input, format, options, silent_progress());
}

}  // namespace mc::source

namespace mc {

Source open_source(std::span<const std::string> inputs, const SourceOptions& options,
                   Progress& progress) {
  source::check_placement(options);
  SourceInput input = source::input_of(inputs, progress);
  const SourceFormat& format = source::decide(input, options);
  source::check_options(input, format, options);
  return source::open_decided(input, format, options, progress);
}

std::vector<GridDescription> describe_source(std::span<const std::string> inputs,
                                             const SourceOptions& options, Progress& progress) {
  source::check_placement(options);
  SourceInput input = source::input_of(inputs, progress);
  const SourceFormat& format = source::decide(input, options);
  source::check_options(input, format, options);
  if (format.describe != nullptr) {
    return format.describe(input, progress);
  }
  const Source opened = source::open_decided(input, format, options, progress);
  const Volume& volume = volume_of(opened.reader);
  return {{volume, sample_name(volume.type), ""}};
}

}  // namespace mc
