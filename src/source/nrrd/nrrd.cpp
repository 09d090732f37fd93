// SPDX-License-Identifier: MIT
#include "source/nrrd/nrrd.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "field/volume_names.hpp"
#include "source/input_files.hpp"
#include "source/magic.hpp"
#include "source/mapped_planes.hpp"
#include "source/nrrd/fields.hpp"
#include "source/nrrd/header.hpp"
#include "source/nrrd/nrrd_samples.hpp"
#include "source/placement.hpp"
#include "source/source_input.hpp"
#include "source/text.hpp"

namespace mc::source {

namespace {

namespace fs = std::filesystem;

/// How many data files there are, how many planes each holds, and what they are called. Names are
/// made when they are wanted: a header may ask for more of them than there is memory.
struct DataFiles {
  std::size_t n_files = 0;
  std::int32_t planes_per_file = 0;
  std::function<std::string(std::size_t n)> name;
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
  out.n_files = static_cast<std::size_t>(n_files);
  out.planes_per_file = static_cast<std::int32_t>(nz / n_files);
  if (!pattern) {
    out.name = [names = named.names](std::size_t n) { return names[n]; };
    return out;
  }
  const std::optional<NrrdPattern> parsed = NrrdPattern::parse(named.pattern);
  if (!parsed) {
    wrong_files(place, fmt::format("{}: one %d was expected", quoted_text(named.pattern)));
  }
  out.name = [parsed = *parsed, first = named.first, step = named.step](std::size_t n) {
    return parsed.name(first + static_cast<std::int64_t>(n) * step);
  };
  return out;
}

/// Where samples begin in `file`, whose own header (if it has one) ends at `start`.
std::size_t samples_at(const MappedFile& file, std::size_t start, std::uint64_t needed,
                       const NrrdHeader& header, Progress& progress) {
  const std::string_view text = file.text();
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
      throw nrrd_cut_off(header, file.place(), left, needed);
    }
    return text.size() - static_cast<std::size_t>(needed);
  }
  const auto skip = static_cast<std::uint64_t>(header.skip_bytes);
  left = left < skip ? 0 : left - skip;
  if (left < needed) {
    throw nrrd_cut_off(header, file.place(), left, needed);
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
  volume.format = kNrrdFormat.name;
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

/// The header's text and some of what follows it, as far as the header may reach.
std::string_view head_of(InputFile& file) {
  std::string_view head;
  for (std::size_t n = 4096; n <= 4 * NrrdFields::kMostBytes; n *= 4) {
    head = file.head(n);
    const bool ends = head.find("\n\n") != std::string_view::npos ||
                      head.find("\n\r\n") != std::string_view::npos;
    const bool lists = head.find("LIST") != std::string_view::npos;  // which may hold empty lines
    if ((ends && !lists) || head.size() < n) break;
  }
  return head;
}

VolumeReader streamed(const Volume& volume, std::unique_ptr<NrrdSamples> samples,
                      const SourceOptions& options, Progress& progress) {
  auto stream = std::make_unique<StreamedPlanes>(volume, std::move(samples));
  if (!options.streams) return stream->spool(progress);
  return stream;
}

/// Samples behind the header. Where they have to be kept, so does all of stdin: it may be opened
/// again.
VolumeReader open_attached(InputFile file, const NrrdHeader& header, const Volume& volume,
                           std::uint64_t n_bytes, const SourceOptions& options,
                           Progress& progress) {
  const bool seeks = header.skip_bytes < 0;
  const bool mapped = !header.gzipped && (file.mappable() || seeks || !options.streams);
  if (mapped) {
    MappedFile whole(std::move(file), MappedFile::kUnlimited, progress,
                     MappedFile::Keep::open_file);
    const std::size_t at = samples_at(whole, header.size_bytes, n_bytes, header, progress);
    std::vector<PlaneFile> files;
    files.push_back({std::move(whole), at});
    return std::make_unique<MappedPlanes>(volume, std::move(files), header.dims[2],
                                          options.reading);
  }
  if (!options.streams && file.is_stdin() && !file.mappable()) {
    const MappedFile kept(std::move(file), MappedFile::kUnlimited, progress);
    file = InputFile("-");
  }
  NrrdPart part{file.place(), std::move(file).stream()};
  pass_over(*part.bytes, header.size_bytes);
  auto only = std::make_shared<NrrdPart>(std::move(part));
  const auto open = [only](std::size_t /*n*/) { return std::move(*only); };
  return streamed(volume, std::make_unique<NrrdSamples>(header, 1, n_bytes, open, progress),
                  options, progress);
}

VolumeReader open_detached(const NrrdHeader& header, const std::string& place, const Volume& volume,
                           std::uint64_t n_bytes, const SourceOptions& options,
                           Progress& progress) {
  const DataFiles data = list_files(header, place);
  const std::uint64_t part_bytes = n_bytes / data.n_files;
  const fs::path folder = place == "<stdin>" ? fs::path() : fs::path(place).parent_path();
  const auto open = [name = data.name, folder, root = options.root](std::size_t n) {
    const fs::path path = folder.empty() ? fs::path(".") / name(n) : folder / name(n);
    check_within(root, path.string());
    check_regular(path.string());
    return InputFile(path.string(), InputFile::Bytes::stored);  // what is packed the header says
  };
  if (header.gzipped) {
    const auto open_part = [open](std::size_t n) {
      InputFile file = open(n);
      return NrrdPart{file.place(), std::move(file).stream()};
    };
    return streamed(
        volume,
        std::make_unique<NrrdSamples>(header, data.n_files, part_bytes, open_part, progress),
        options, progress);
  }
  using Keep = MappedFile::Keep;
  const Keep keep = data.n_files == 1 ? Keep::open_file : Keep::mapping;
  std::vector<PlaneFile> files;
  for (std::size_t n = 0; n < data.n_files; ++n) {
    MappedFile file(open(n), MappedFile::kUnlimited, progress, keep);
    const std::size_t at = samples_at(file, 0, part_bytes, header, progress);
    files.push_back({std::move(file), at});
  }
  return std::make_unique<MappedPlanes>(volume, std::move(files), data.planes_per_file,
                                        options.reading);
}

}  // namespace

Recognition recognise_nrrd(std::string_view head) { return recognised(has_magic(head, "NRRD000")); }

Source open_nrrd(SourceInput& input, const SourceOptions& options, Progress& progress) {
  InputFile file = take_file(input);
  const std::string place = file.place();
  const NrrdHeader header = parse_nrrd_header(head_of(file), place);
  for (const std::string& field : header.unknown_fields) {
    progress.warn(fmt::format("{}: unknown field {} is ignored", place, field));
  }
  const Volume volume = nrrd_volume(header, options, place);
  const auto n_bytes = volume_bytes(header.dims[0], header.dims[1], header.dims[2], *header.type);
  if (!n_bytes) {
    throw Error(ErrorKind::input, place, "sizes: more bytes than 64 bits can count");
  }
  Source source;
  source.reader = header.data_files
                      ? open_detached(header, place, volume, *n_bytes, options, progress)
                      : open_attached(std::move(file), header, volume, *n_bytes, options, progress);
  return source;
}

}  // namespace mc::source
