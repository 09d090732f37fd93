// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "base/checked.hpp"
#include "cli/arguments/format_lists.hpp"
#include "cli/arguments/resolve.hpp"
#include "cli/arguments/values.hpp"

// The options that every command which reads volumes shares.

namespace mc::cli {

namespace {

constexpr std::int64_t kMostSamplesAlongAxis = std::numeric_limits<std::int32_t>::max();

std::vector<std::int64_t> parse_dims(const std::string& text) {
  const auto parts = split(text, ',');
  if (parts.size() != 2 && parts.size() != 3) {
    throw Error(ErrorKind::usage, "--dims",
                fmt::format("'{}' has {} {}: expected X,Y,Z, or X,Y for slices", text, parts.size(),
                            parts.size() == 1 ? "number" : "numbers"));
  }
  std::vector<std::int64_t> dims;
  dims.reserve(parts.size());
  for (const std::string_view part : parts) {
    dims.push_back(parse_integer("--dims", part, 2, kMostSamplesAlongAxis));
  }
  return dims;
}

void check_volume_size(const SourceOptions& options) {
  if (options.dims.empty() || !options.type) return;
  std::uint64_t n_bytes = sample_size(*options.type);
  for (const std::int64_t extent : options.dims) {
    const auto product = base::checked_mul(n_bytes, static_cast<std::uint64_t>(extent));
    if (!product || *product > std::numeric_limits<std::int64_t>::max()) {
      throw Error(ErrorKind::usage, "--dims", "the volume has more than 2^63 bytes",
                  "check the numbers");
    }
    n_bytes = *product;
  }
}

Vec3 parse_spacing(const std::string& text) {
  const Vec3 spacing = parse_vector("--spacing", text);
  for (const double step : spacing) {
    if (!(step > 0)) {
      throw Error(ErrorKind::usage, "--spacing",
                  fmt::format("{} is out of range: expected more than 0", step));
    }
  }
  return spacing;
}

const SourceFormat* format_named(const Text& from) {
  if (!from) return nullptr;
  const Names names = source_names();
  if (std::ranges::find(names, *from) == names.end()) refuse_choice("--from", *from, names);
  return find_source_format(*from);
}

/// Options that say what raw data is. `named` is the format of --from, or null.
void check_raw_options(const SourceArgs& args, const SourceFormat* named) {
  const bool raw = args.dims || args.type || (named != nullptr && named->headerless);
  struct Given {
    std::string_view name;
    const Text& text;
    bool SourceTakes::*taken;
  };
  for (const Given& given : {Given{"--dims", args.dims, &SourceTakes::dims},
                             Given{"--type", args.type, &SourceTakes::type},
                             Given{"--endian", args.endian, &SourceTakes::endian},
                             Given{"--skip", args.skip, &SourceTakes::skip}}) {
    if (given.text && named != nullptr && !(named->takes.*given.taken)) {
      throw Error(ErrorKind::usage, given.name,
                  fmt::format("is for raw data, but --from says {}", named->name));
    }
    if (given.text && !raw) {
      throw Error(ErrorKind::usage, given.name,
                  "is for raw data: expected --dims and --type with it");
    }
  }
  if (raw && !args.dims) {
    throw Error(ErrorKind::usage, "--dims", "missing: raw data needs --dims and --type",
                "give --dims X,Y,Z");
  }
  if (raw && !args.type) {
    throw Error(ErrorKind::usage, "--type", "missing: raw data needs --dims and --type",
                "give --type u8, i8, u16, i16, u32, i32, f16, f32 or f64");
  }
  if (raw && args.grid) {
    throw Error(ErrorKind::usage, "--grid", "is for VDB files: raw data has no grids");
  }
}

/// MC_READ: for tests and measurements.
Reading reading_of_environment() {
  const char* name = std::getenv("MC_READ");
  if (name == nullptr || *name == '\0') return Reading::fastest;
  static constexpr std::array<std::pair<std::string_view, Reading>, 2> kReadings{
      {{"map", Reading::mapped}, {"copy", Reading::copied}}};
  return parse_choice("MC_READ", name, kReadings);
}

}  // namespace

SampleType parse_type(const std::string& text) {
  // i64 exists inside (VDB's int64 grids) but is no raw type of the command line.
  static constexpr std::array<std::pair<std::string_view, SampleType>, 9> kTypes{
      {{"u8", SampleType::u8},
       {"i8", SampleType::i8},
       {"u16", SampleType::u16},
       {"i16", SampleType::i16},
       {"u32", SampleType::u32},
       {"i32", SampleType::i32},
       {"f16", SampleType::f16},
       {"f32", SampleType::f32},
       {"f64", SampleType::f64}}};
  return parse_choice("--type", text, kTypes);
}

SourceOptions resolve_source(const SourceArgs& args) {
  SourceOptions options;
  const SourceFormat* named = format_named(args.from);
  if (named != nullptr) options.from = named->name;
  check_raw_options(args, named);
  options.grid = args.grid;
  options.channel = args.channel;
  if (args.dims) options.dims = parse_dims(*args.dims);
  if (args.type) options.type = parse_type(*args.type);
  check_volume_size(options);
  if (args.endian) {
    static constexpr std::array<std::pair<std::string_view, std::endian>, 2> kOrders{
        {{"little", std::endian::little}, {"big", std::endian::big}}};
    options.endian = parse_choice("--endian", *args.endian, kOrders);
  }
  if (args.skip) {
    options.skip_bytes = static_cast<std::uint64_t>(
        parse_integer("--skip", *args.skip, 0, std::numeric_limits<std::int64_t>::max()));
  }
  if (args.spacing) options.spacing = parse_spacing(*args.spacing);
  if (args.root) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(*args.root, ignored)) {
      throw Error(ErrorKind::usage, "--root", fmt::format("'{}': expected a folder", *args.root));
    }
    options.root = *args.root;
  }
  if (args.origin) options.origin = parse_vector("--origin", *args.origin);
  options.reading = reading_of_environment();
  return options;
}

CommonOptions resolve_common(const CommonArgs& args) {
  CommonOptions options;
  options.quiet = args.quiet > 0;
  options.verbose = args.verbose > 0;
  if (options.quiet && options.verbose) {
    throw Error(ErrorKind::usage, "--quiet", "contradicts --verbose", "give one of them");
  }
  if (args.progress) {
    static constexpr std::array<std::pair<std::string_view, ProgressMode>, 4> kModes{
        {{"auto", ProgressMode::automatic},
         {"always", ProgressMode::always},
         {"never", ProgressMode::never},
         {"json", ProgressMode::json}}};
    options.progress = parse_choice("--progress", *args.progress, kModes);
  }
  if (args.threads) {
    options.threads = static_cast<int>(parse_integer("--threads", *args.threads, 1, 4096));
  }
  return options;
}

}  // namespace mc::cli
