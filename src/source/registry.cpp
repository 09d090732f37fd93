// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "mc/source.hpp"
#include "source/format.hpp"
#include "source/image/open_image.hpp"
#include "source/image/slices.hpp"
#include "source/input_files.hpp"
#include "source/mapped_file.hpp"
#include "source/nrrd/nrrd.hpp"
#include "source/open_named.hpp"
#include "source/placement.hpp"
#include "source/raw/raw.hpp"
#include "source/spec/spec.hpp"
#include "source/stream/input_file.hpp"
#include "source/text.hpp"
#include "source/vdb/vdb.hpp"

// What an input is, and who reads it. Decided by --from, then by --dims with --type (raw), then by
// content, then by extension.

namespace mc::source {

namespace {

constexpr std::string_view kRawRemedy = "for raw data give --dims X,Y[,Z] and --type";

struct Decision {
  Format format = Format::raw;
  std::optional<InputFile> file;  ///< of formats that are one file
};

[[noreturn]] void unsupported(Format format, std::string_view place) {
  if (format == Format::mesh) {
    throw Error(ErrorKind::input, place, "a mesh, but a volume was expected");
  }
  throw Error(ErrorKind::input, place,
              fmt::format("{} is not supported by this version", display_name(format)),
              "convert it to VDB, NRRD or raw first");
}

/// What the content says, then the name, that of a packed file without .gz or .zst.
std::optional<Format> recognised(InputFile& file, const std::string& path) {
  constexpr std::size_t kHead = 512, kDocumentHead = std::size_t{1} << 20U;
  std::optional<Format> format = format_of_content(file.head(kHead));
  if (!format && looks_like_json(file.head(kHead)) && looks_like_spec(file.head(kDocumentHead))) {
    format = Format::spec;
  }
  return format ? format : format_of_extension(unpacked_extension_of(path));
}

/// Several files without --dims and --type: pictures by the first of them. Else no volume, but the
/// first tells what is missing.
Decision decide_by_series(const InputFiles& inputs) {
  const std::string& first = inputs.paths.front();
  InputFile file(first);
  const std::optional<Format> format = recognised(file, first);
  if (format && is_image(*format)) {
    return {*format, std::nullopt};
  }
  if (format && !is_readable(*format)) {
    unsupported(*format, inputs.place);
  }
  if (inputs.from_folder) {
    throw Error(ErrorKind::input, inputs.place, "a folder with no known file", kRawRemedy);
  }
  throw Error(
      ErrorKind::usage, inputs.place,
      fmt::format("{} files, but only slices make one volume together", inputs.paths.size()),
      kRawRemedy);
}

Decision decide_by_file(const InputFiles& inputs, const SourceOptions& options) {
  const std::string& path = inputs.paths.front();
  InputFile file(path);
  file.refuse_device();
  const bool wants_raw = !options.dims.empty() || options.type.has_value();
  const std::optional<Format> format = recognised(file, path);
  if (!format && wants_raw) {
    return {};
  }
  if (!format) {
    throw Error(ErrorKind::usage, inputs.place,
                "neither its content nor its extension says what it is",
                fmt::format("name it by --from, or {}", kRawRemedy));
  }
  if (!is_readable(*format)) {
    unsupported(*format, inputs.place);
  }
  const std::filesystem::path sidecar = std::filesystem::path(path).replace_extension(".nhdr");
  std::error_code ignored;
  if (format == Format::raw && !wants_raw && std::filesystem::exists(sidecar, ignored)) {
    check_within(options.root, sidecar.string());
    return {Format::nrrd, InputFile(sidecar.string())};
  }
  return {*format, std::move(file)};
}

Decision decide(const InputFiles& inputs, const SourceOptions& options) {
  if (!options.from.empty()) {
    const std::optional<Format> format = format_named(options.from);
    if (!format) {
      throw Error(ErrorKind::usage, "--from",
                  fmt::format("{} is no kind of input", quoted_text(options.from)),
                  "choose one of vdb, raw, nrrd, spec, exr, png");
    }
    if (!is_readable(*format)) {
      unsupported(*format, inputs.place);
    }
    if (format == Format::raw) {
      return {};
    }
    if (is_image(*format)) {
      return {*format, std::nullopt};
    }
    if (inputs.paths.size() > 1) {
      throw Error(
          ErrorKind::usage, inputs.place,
          fmt::format("{} files, but --from {} reads one", inputs.paths.size(), options.from));
    }
    return {*format, InputFile(inputs.paths.front())};
  }
  if (!options.dims.empty() && options.type) {
    return {};
  }
  if (inputs.from_folder || inputs.paths.size() > 1) {
    return decide_by_series(inputs);
  }
  return decide_by_file(inputs, options);
}

/// Options that say what raw data is contradict a file that says it itself.
void check_options(const InputFiles& inputs, Format format, const SourceOptions& options) {
  const auto refuse = [&](bool given, std::string_view option, std::string_view what) {
    if (given) {
      throw Error(ErrorKind::usage, option,
                  fmt::format("is for {}, but {} is {}", what, inputs.place, display_name(format)));
    }
  };
  refuse(options.channel.has_value() && !is_image(format), "--channel", "pictures");
  refuse(options.grid.has_value() && format != Format::vdb, "--grid", "VDB files");
  if (format != Format::raw) {
    refuse(!options.dims.empty(), "--dims", "raw data");
    refuse(options.type.has_value(), "--type", "raw data");
    refuse(options.endian != std::endian::little, "--endian", "raw data");
    refuse(options.skip_bytes != 0, "--skip", "raw data");
  }
}

MappedFile mapped(Decision decision, Progress& progress) {
  return MappedFile(std::move(*decision.file), MappedFile::kUnlimited, progress);
}

/// From the bytes that told what it is, where there is one file only.
std::unique_ptr<SlabReader> open_pictures(const InputFiles& inputs, Decision decision,
                                          const SourceOptions& options, Progress& progress) {
  const Format format = decision.format;
  std::vector<MappedFile> files;
  if (decision.file) {
    files.push_back(mapped(std::move(decision), progress));
  } else {
    for (const std::string& path : inputs.paths) {
      files.emplace_back(InputFile(path), MappedFile::kUnlimited, progress);
    }
  }
  return open_slices(std::move(files), format, options, progress);
}

Source open_decided(const InputFiles& inputs, Decision decision, const SourceOptions& options,
                    Progress& progress, SpecNesting within = {}) {
  Source source;
  source.place = inputs.place;
  switch (decision.format) {
    case Format::nrrd:
      source.reader = open_nrrd(std::move(*decision.file), options, progress);
      break;
    case Format::vdb: {
      VdbSource vdb = open_vdb(mapped(std::move(decision), progress), options);
      source.reader = std::move(vdb.reader);
      source.other_grids = std::move(vdb.other_grids);
      break;
    }
    case Format::spec: {
      // From the bytes that told what it is: a FIFO gives them once.
      within.root = options.root;
      within.left = std::min(within.left, SpecNesting::most_samples(options.memory_bytes));
      const MappedFile file = mapped(std::move(decision), progress);
      std::unique_ptr<SlabReader> spec = open_spec_text(file.place(), file.text(), within);
      source.reader = places(options) ? placed_reader(std::move(spec), options) : std::move(spec);
      break;
    }
    case Format::exr:
    case Format::png:
      source.reader = open_pictures(inputs, std::move(decision), options, progress);
      break;
    default:
      source.reader = open_raw(inputs, options, progress);
  }
  return source;
}

/// What a document's volume is: it has to say that, and its sizes, itself.
Decision decide_by_content(const InputFiles& inputs, const SourceOptions& options) {
  try {
    Decision decision = decide(inputs, options);
    if (decision.format != Format::raw) {
      return decision;
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::usage) {
      throw;
    }
  }
  throw Error(ErrorKind::input, inputs.place, "does not say what volume it is",
              "give raw data a NRRD header (.nhdr) and name that");
}

}  // namespace

Source open_named(const std::string& path, const std::optional<std::string>& grid,
                  const SpecNesting& within) {
  const InputFiles inputs = expand_inputs({&path, 1}, silent_progress());
  for (const std::string& each : inputs.paths) {
    check_within(within.root, each);
    check_regular(each);
  }
  SourceOptions options;
  options.root = within.root;
  options.memory_bytes = 2 * within.left * sizeof(float);  // so that half of it is left
  Decision decision = decide_by_content(inputs, options);
  if (grid && decision.format != Format::vdb) {
    throw Error(ErrorKind::input, path,
                fmt::format("{} has no grids by name", display_name(decision.format)),
                "leave out \"grid\"");
  }
  options.grid = grid;
  return open_decided(inputs, std::move(decision), options, silent_progress(), within);
}

}  // namespace mc::source

namespace mc {

Source open_source(std::span<const std::string> inputs, const SourceOptions& options,
                   Progress& progress) {
  source::check_placement(options);
  const source::InputFiles files = source::expand_inputs(inputs, progress);
  source::Decision decision = source::decide(files, options);
  source::check_options(files, decision.format, options);
  return source::open_decided(files, std::move(decision), options, progress);
}

std::vector<GridDescription> describe_source(std::span<const std::string> inputs,
                                             const SourceOptions& options, Progress& progress) {
  source::check_placement(options);
  const source::InputFiles files = source::expand_inputs(inputs, progress);
  source::Decision decision = source::decide(files, options);
  source::check_options(files, decision.format, options);
  if (decision.format == source::Format::vdb) {
    return source::describe_vdb(source::mapped(std::move(decision), progress));
  }
  const Source opened = source::open_decided(files, std::move(decision), options, progress);
  const Volume& volume = volume_of(opened.reader);
  return {{volume, sample_name(volume.type), ""}};
}

}  // namespace mc
