// SPDX-License-Identifier: MIT
#include "source/formats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>

#include "base/text.hpp"
#include "source/input_files.hpp"
#include "support/memory_readers.hpp"
#include "support/source_files.hpp"

// The rows of formats that are read, those of the library and one of an embedder.

namespace mc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  std::istringstream in{std::string(text)};
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

TEST(SourceFormats, NamesAndExtensionsAreUnique) {
  std::set<std::string> names, extensions;
  for (const SourceFormat* format : source_formats()) {
    if (!format->name.empty()) {
      EXPECT_TRUE(names.emplace(format->name).second) << format->name;
    }
    for (const std::string& word : words_of(format->extensions)) {
      EXPECT_TRUE(extensions.insert(word).second) << word;
      EXPECT_EQ(word, base::lower_case(word));
    }
  }
}

TEST(SourceFormats, RowsAreComplete) {
  for (const SourceFormat* format : source_formats()) {
    EXPECT_FALSE(format->display.empty()) << format->name;
    EXPECT_FALSE(format->extensions.empty()) << format->name;
    EXPECT_TRUE(format->built_in || !format->package.empty()) << format->name;
    EXPECT_TRUE(format->headerless || format->recognise != nullptr) << format->name;
    if (format->open == nullptr) continue;
    EXPECT_FALSE(format->name.empty()) << format->display;
    EXPECT_EQ(find_source_format(format->name), format);
  }
  EXPECT_EQ(find_source_format(""), nullptr);
  EXPECT_EQ(find_source_format("vdbb"), nullptr);
}

TEST(SourceFormats, ExtensionsFindTheirRow) {
  for (const SourceFormat* format : source_formats()) {
    for (const std::string& word : words_of(format->extensions)) {
      EXPECT_EQ(source::format_of_extension(word, {}), format) << word;
    }
  }
  EXPECT_EQ(source::format_of_extension("", {}), nullptr);
  EXPECT_EQ(source::format_of_extension("rrd", {}), nullptr);
}

TEST(SourceFormats, ReadableOnesAreListedInOrder) {
  EXPECT_THAT(source::readable_names({}), ElementsAre("vdb", "raw", "nrrd", "spec", "exr", "png"));
}

TEST(SourceFormats, FewBytesAreRecognisedByAtMostOne) {
  for (const std::string& head :
       {std::string(), std::string("N"), std::string("{"), std::string(512, '\0'),
        std::string("ply\n"), std::string("glTF"), std::string("NRRD0005"), std::string("MM\0*", 4),
        std::string("NDims = 3\n"), std::string(128, ' ') + "DICM",
        std::string("\x76\x2f\x31\x01")}) {
    int n_yes = 0;
    for (const SourceFormat* format : source_formats()) {
      n_yes += format->recognise != nullptr && format->recognise(head) == Recognition::yes ? 1 : 0;
    }
    EXPECT_EQ(n_yes, head.size() < 4 || head.size() == 512 ? 0 : 1) << head;
  }
}

TEST(SourceFormats, UnsureFormatsSeeMore) {
  const SourceFormat& spec = *find_source_format("spec");
  EXPECT_EQ(spec.recognise("{"), Recognition::unsure);
  EXPECT_EQ(spec.recognise("x"), Recognition::no);
  const test::Folder folder;
  const std::string document = test::read_bytes(test::source_file("data/specs/sphere.json"));
  const std::size_t first = document.find('{') + 1;
  const std::string late = "{" + std::string(2000, ' ') + document.substr(first);
  EXPECT_EQ(volume_of(test::open({folder.file("late", late)}).reader).format, "spec");
  const std::string other = folder.file("other", "{" + std::string(2000, ' ') + "}");
  EXPECT_EQ(test::error_of_open({other}).substr(0, other.size() + 30),
            "2 " + other + ": neither its content nor it");
}

// An embedder's format: "CUBE", two digits a side, then samples of one byte.
Recognition recognise_cube(std::string_view head) {
  return head.starts_with("CUBE") ? Recognition::yes : Recognition::no;
}

Source open_cube(SourceInput& input, const SourceOptions& options, Progress& /*progress*/) {
  const auto stream = input.stream();
  std::array<std::byte, 6> head{};
  stream->read(head);
  const auto digit = [&](std::size_t n) { return std::to_integer<int>(head[n]) - '0'; };
  const std::int32_t n = 10 * digit(4) + digit(5);
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(n * n * n));
  const std::size_t n_read = stream->read(std::as_writable_bytes(std::span(samples)));
  if (n_read < samples.size()) throw Error(ErrorKind::input, input.place(), "is cut off");
  auto reader = std::make_unique<test::MemorySlabs>(samples, Index3{n, n, n}, placed({}, options));
  reader->edit().format = "cube";
  Source source;
  source.reader = std::move(reader);
  return source;
}

constexpr SourceFormat kCube{.name = "cube",
                             .display = "a cube",
                             .extensions = "cube cub",
                             .recognise = recognise_cube,
                             .open = open_cube};
constexpr std::array<const SourceFormat*, 1> kFurther{&kCube};

SourceOptions further() {
  SourceOptions options;
  options.further_formats = kFurther;
  return options;
}

TEST(FurtherSource, IsRecognisedByContentNameAndOption) {
  const test::Folder folder;
  const std::string bytes = "CUBE02" + test::counting_bytes(8);
  SourceOptions options = further();
  options.spacing = Vec3{1, 2, 3};
  const Source by_content = test::open({folder.file("v.raw", bytes)}, options);
  EXPECT_EQ(by_content.place, folder.path("v.raw"));
  EXPECT_EQ(test::all_bytes(test::slabs(by_content)), test::counting_bytes(8));
  EXPECT_EQ(volume_of(by_content.reader).lattice.to_world, Affine::scale_translate({1, 2, 3}, {}));

  const std::string damaged = folder.file("v.cub", "CUBA02");
  EXPECT_EQ(test::error_of_open({damaged}, further()), "3 " + damaged + ": is cut off");
  options.from = "cube";
  EXPECT_EQ(volume_of(test::open({folder.file("v", bytes)}, options).reader).format, "cube");
}

TEST(FurtherSource, IsListedInMessages) {
  const test::Folder folder;
  SourceOptions options = further();
  options.from = "tube";
  EXPECT_EQ(test::error_of_open({folder.file("v", "x")}, options),
            "2 --from: \"tube\" is no kind of input; choose one of vdb, raw, nrrd, spec, exr, png, "
            "cube");
  options.from = "";
  options.skip_bytes = 1;
  const std::string file = folder.file("a", "CUBE02");
  EXPECT_EQ(test::error_of_open({file}, options),
            "2 --skip: is for raw data, but " + file + " is a cube");
}

TEST(FurtherSource, TakesTheNameOfOneThatIsOnlyRefused) {
  static constexpr SourceFormat kNifti{
      .name = "nifti", .display = "my NIfTI", .extensions = "nii", .open = open_cube};
  static constexpr SourceFormat kVdb{
      .name = "vdb", .display = "my VDB", .extensions = "", .open = open_cube};
  static constexpr std::array<const SourceFormat*, 2> kRows{&kNifti, &kVdb};
  EXPECT_EQ(find_source_format("nifti", kRows), &kNifti);
  EXPECT_EQ(source::format_of_extension("nii", kRows), &kNifti);
  EXPECT_EQ(find_source_format("vdb", kRows), find_source_format("vdb"));
}

TEST(FurtherSource, IsAVolumeOfADocument) {
  const test::Folder folder;
  (void)folder.file("v.cube", "CUBE02" + test::counting_bytes(8));
  const std::string document = folder.file("v.json", R"({"format": "mc-volume", "version": 1,
    "convention": "density", "grid": {"cells": [4, 4, 4], "spacing": 1},
    "field": {"type": "volume", "path": "v.cube"}})");
  EXPECT_EQ(test::error_of_open({document}, further()), "no error");
  EXPECT_THAT(test::error_of_open({document}), HasSubstr("v.cube"));
}

// A format that maps its files, and puts them into an order of its own.
Source open_last_first(SourceInput& input, const SourceOptions& /*options*/,
                       Progress& /*progress*/) {
  std::vector<std::uint8_t> samples;
  for (std::size_t n = input.paths().size(); n-- > 0;) {
    const auto file = input.map(n);
    for (const std::byte b : file->bytes().subspan(1))
      samples.push_back(std::to_integer<std::uint8_t>(b));
  }
  Source source;
  source.reader = std::make_unique<test::MemorySlabs>(samples, Index3{2, 2, 3});
  return source;
}

TEST(FurtherSource, OrdersItsOwnSlices) {
  static constexpr SourceFormat kSlices{.name = "slices",
                                        .display = "slices",
                                        .extensions = "slc",
                                        .recognise =
                                            [](std::string_view head) {
                                              return head.starts_with('~') ? Recognition::yes
                                                                           : Recognition::no;
                                            },
                                        .several_files = true,
                                        .open = open_last_first};
  static constexpr std::array<const SourceFormat*, 1> kRows{&kSlices};
  const test::Folder folder;
  for (const char* name : {"10", "9", "1"}) {
    (void)folder.file(name, "~" + std::string(4, name[std::strlen(name) - 1]));
  }
  SourceOptions options;
  options.further_formats = kRows;
  EXPECT_EQ(test::all_bytes(test::slabs(test::open({folder.path("")}, options))), "000099991111");
}

}  // namespace
}  // namespace mc
