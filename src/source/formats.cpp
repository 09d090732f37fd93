// SPDX-License-Identifier: MIT
#include "source/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text.hpp"
#include "source/image/image_formats.hpp"
#include "source/known/known.hpp"
#include "source/mesh/mesh_format.hpp"
#include "source/nrrd/nrrd.hpp"
#include "source/raw/raw.hpp"
#include "source/spec/spec.hpp"
#include "source/vdb/vdb.hpp"

// The one list of formats that are read. Messages and help list them in this order. A file that two
// of them recognise goes to the first.

namespace mc::source {

namespace {

constexpr std::array<const SourceFormat*, 11> kFormats{
    &kVdbFormat, &kRawFormat, &kNrrdFormat, &kDicomFormat, &kNiftiFormat, &kSpecFormat,
    &kExrFormat, &kPngFormat, &kTiffFormat, &kMeshFormat,  &kMetaFormat};

template <class Matches>
const SourceFormat* find_format(SourceFormats further, Matches&& matches) {
  const auto known = std::ranges::find_if(kFormats, matches);
  if (known != kFormats.end() && (*known)->open != nullptr) return *known;
  const auto other = std::ranges::find_if(further, matches);
  if (other != further.end()) return *other;
  return known == kFormats.end() ? nullptr : *known;
}

}  // namespace

const SourceFormat* format_of_content(SourceInput& input, SourceFormats further) {
  const auto says = [](Recognition answer, std::string_view head) {
    return [=](const SourceFormat* format) {
      return format->recognise != nullptr && format->recognise(head) == answer;
    };
  };
  const std::string_view head = input.head(SourceFormat::kHeadBytes);
  if (const SourceFormat* found = find_format(further, says(Recognition::yes, head))) return found;
  if (find_format(further, says(Recognition::unsure, head)) == nullptr) return nullptr;
  return find_format(further, says(Recognition::yes, input.head(SourceFormat::kLongHeadBytes)));
}

const SourceFormat* format_of_extension(std::string_view extension, SourceFormats further) {
  return find_format(further, [&](const SourceFormat* format) {
    return base::has_word(format->extensions, extension);
  });
}

const SourceFormat& headerless_format(SourceFormats further) {
  return *find_format(further, [](const SourceFormat* format) { return format->headerless; });
}

std::vector<std::string_view> readable_names(SourceFormats further) {
  std::vector<std::string_view> names;
  for (const SourceFormats formats : {source_formats(), further}) {
    for (const SourceFormat* format : formats) {
      if (format->open != nullptr) names.push_back(format->name);
    }
  }
  return names;
}

void refuse_absent(const SourceFormat& format, std::string_view place) {
  throw Error(ErrorKind::input, place,
              fmt::format("this build of mc has no support for {} files", format.display),
              fmt::format("install the package {} and build again", format.package));
}

}  // namespace mc::source

namespace mc {

SourceFormats source_formats() { return source::kFormats; }

const SourceFormat* find_source_format(std::string_view name, SourceFormats further) {
  return name.empty() ? nullptr : source::find_format(further, [&](const SourceFormat* format) {
    return format->name == name;
  });
}

}  // namespace mc
