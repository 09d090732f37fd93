// SPDX-License-Identifier: MIT
#include "source/nrrd/nrrd.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "field/volume_names.hpp"
#include "source/mapped_planes.hpp"
#include "source/nrrd/fields.hpp"
#include "source/nrrd/header.hpp"
#include "source/placement.hpp"
#include "source/text.hpp"

namespace mc::source {

namespace {

namespace fs = std::filesystem;

/// Names of all data files, and how many planes each holds.
struct DataFiles {
  std::vector<std::string> names;
  std::int32_t planes_per_file = 0;
};

[[noreturn]] void wrong_files(const std::string& place, std::string_view fault) {
  throw Error(ErrorKind::input, place, fmt::format("data file: {}", fault));
}

/// How many names a pattern yields, before any is made. -1: not countable.
std::int64_t count_pattern(const NrrdDataFiles& files) {
  constexpr std::int64_t kFarthest = std::int64_t{1} << 40U;
  const auto near = [](std::int64_t n) { return -kFarthest < n && n < kFarthest; };
  if (!near(files.first) || !near(files.last) || !near(files.step) || files.step == 0) {
    return -1;
  }
  const std::int64_t steps = (files.last - files.first) / files.step;
  return steps < 0 ? 0 : steps + 1;
}

DataFiles list_files(const NrrdHeader& header, const std::string& place) {
  const NrrdDataFiles& named = *header.data_files;
  const bool pattern = !named.pattern.empty();
  const std::int32_t nz = header.dims[2];
  const std::int64_t n_files =
      pattern ? count_pattern(named) : static_cast<std::int64_t>(named.names.size());
  const std::int64_t axes = header.leading_axis ? 4 : 3;
  // One name alone holds everything; of several, each holds one plane unless it says it has more.
  const bool single = !pattern && n_files == 1 && !named.axes_per_file;
  const std::int64_t subdim = named.axes_per_file.value_or(single ? axes : axes - 1);
  if (subdim != axes && subdim != axes - 1) {
    wrong_files(place, fmt::format("files of {} axes each, but {} or {} were expected", subdim,
                                   axes - 1, axes));
  }
  const bool fits = subdim == axes ? n_files > 0 && nz % n_files == 0 : n_files == nz;
  if (!fits) {
    wrong_files(place, fmt::format("{} files do not make {} planes", n_files, nz));
  }
  DataFiles out;
  out.planes_per_file = static_cast<std::int32_t>(nz / n_files);
  out.names = named.names;
  if (pattern) {
    auto names = expand_nrrd_pattern(named);
    if (!names) {
      wrong_files(place, fmt::format("{}: one %d was expected", quoted_text(named.pattern)));
    }
    out.names = std::move(*names);
  }
  return out;
}

/// Where samples begin in `file`, whose own header (if it has one) ends at `start`.
std::size_t samples_at(const MappedFile& file, std::size_t start, std::uint64_t needed,
                       const NrrdHeader& header, Progress& progress) {
  const std::string_view text = file.text();
  const auto short_by = [&](std::uint64_t found) {
    const Index3& d = header.dims;
    return Error(ErrorKind::input, file.place(),
                 fmt::format("{} bytes of samples, but {}x{}x{} {} needs {} in this file", found,
                             d[0], d[1], d[2], sample_name(*header.type), needed),
                 "the file is cut off or the header's sizes and type are wrong");
  };
  std::size_t at = start;
  for (std::int64_t n = 0; n < header.skip_lines; ++n) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) {
      throw Error(ErrorKind::input, file.place(),
                  fmt::format("{} lines to skip, but it has only {}", header.skip_lines, n));
    }
    at = end + 1;
  }
  std::uint64_t left = text.size() - at;
  if (header.skip_bytes < 0) {
    if (left < needed) {
      throw short_by(left);
    }
    return text.size() - static_cast<std::size_t>(needed);
  }
  const auto skip = static_cast<std::uint64_t>(header.skip_bytes);
  left = left < skip ? 0 : left - skip;
  if (left < needed) {
    throw short_by(left);
  }
  if (left > needed) {
    progress.warn(
        fmt::format("{}: {} bytes after the samples are ignored", file.place(), left - needed));
  }
  return at + static_cast<std::size_t>(skip);
}

/// Undoes the format's escapes in pairs: "\\n" and "\\\\".
std::string unescaped(std::string_view text) {
  std::string out;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool escape = text[n] == '\\' && n + 1 < text.size();
    if (escape) ++n;
    out += escape && text[n] == 'n' ? '\n' : text[n];
  }
  return out;
}

/// The pairs by which our own files keep what the format has no field for.
void set_own_pairs(const std::map<std::string, std::string, std::less<>>& pairs,
                   const std::string& place, Volume& volume) {
  const auto wrong = [&](std::string_view key, std::string_view value) {
    return Error(ErrorKind::input, place,
                 fmt::format("{}:={} is not a value that mc writes", key, quoted_text(value)),
                 "remove the line");
  };
  const auto value_of = [&](std::string_view key) -> std::optional<std::string> {
    const auto at = pairs.find(key);
    return at == pairs.end() ? std::nullopt : std::optional(at->second);
  };
  volume.name = unescaped(value_of("mc name").value_or(""));
  if (const auto text = value_of("mc class")) {
    const auto cls = field::class_named(*text);
    if (!cls) throw wrong("mc class", *text);
    volume.cls = *cls;
  }
  if (const auto text = value_of("mc border")) {
    volume.border = field::border_named(*text);
    if (!volume.border) throw wrong("mc border", *text);
  }
  if (const auto text = value_of("mc iso")) {
    const auto iso = parse_numbers(*text);
    if (!iso || iso->size() != 1 || !std::isfinite(iso->front())) throw wrong("mc iso", *text);
    volume.iso = iso->front();
  }
}

Volume nrrd_volume(const NrrdHeader& header, const SourceOptions& options,
                   const std::string& place) {
  Volume volume;
  volume.format = "nrrd";
  volume.lattice.box.hi = {header.dims[0] - 1, header.dims[1] - 1, header.dims[2] - 1};
  check_map(header.to_world, place);
  volume.lattice.to_world = placed(header.to_world, options);
  volume.type = *header.type;
  volume.endian = header.endian.value_or(std::endian::native);
  volume.frame = header.frame;
  volume.units = header.units;
  set_own_pairs(header.pairs, place, volume);
  return volume;
}

}  // namespace

std::unique_ptr<SlabReader> open_nrrd(MappedFile header_file, const SourceOptions& options,
                                      Progress& progress) {
  const std::string place = header_file.place();
  const NrrdHeader header = parse_nrrd_header(header_file.text(), place);
  for (const std::string& field : header.unknown_fields) {
    progress.warn(fmt::format("{}: unknown field {} is ignored", place, field));
  }
  const Volume volume = nrrd_volume(header, options, place);
  const auto total = volume_bytes(header.dims[0], header.dims[1], header.dims[2], *header.type);
  if (!total) {
    throw Error(ErrorKind::input, place, "sizes: more bytes than 64 bits can count");
  }
  std::vector<PlaneFile> files;
  if (!header.data_files) {
    const std::size_t at = samples_at(header_file, header.size_bytes, *total, header, progress);
    files.push_back({std::move(header_file), at});
    return std::make_unique<MappedPlanes>(volume, std::move(files), header.dims[2]);
  }
  const DataFiles data = list_files(header, place);
  const std::uint64_t needed = *total / data.names.size();
  const fs::path folder = place == "<stdin>" ? fs::path() : fs::path(place).parent_path();
  for (const std::string& name : data.names) {
    MappedFile file((folder.empty() ? fs::path(".") / name : folder / name).string());
    const std::size_t at = samples_at(file, 0, needed, header, progress);
    files.push_back({std::move(file), at});
  }
  return std::make_unique<MappedPlanes>(volume, std::move(files), data.planes_per_file);
}

}  // namespace mc::source
