// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "mc/source.hpp"
#include "support/packed_bytes.hpp"
#include "support/source_files.hpp"

namespace mc {
namespace {

using test::counting_bytes;
using test::error_of_open;
using test::Folder;
using test::open;
using test::slabs;

constexpr const char* kHead = "NRRD0004\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n";

std::string header(const std::string& more) { return kHead + more; }

/// The placement that a header of an u8 volume gives.
Volume volume_for(const Folder& folder, const std::string& fields) {
  const Source source =
      open({folder.file("v.nrrd", header("type: uchar\n" + fields + "\n") + counting_bytes(24))});
  return volume_of(source.reader);
}

TEST(Nrrd, AttachedSamplesFollowTheEmptyLine) {
  const Folder folder;
  const std::string file = folder.file(
      "v.dat", header("# a comment\r\nTYPE: unsigned short\r\nendian: big\r\nkey:=value\r\n\r\n") +
                   counting_bytes(48));
  const Source source = open({file});
  const Volume& volume = volume_of(source.reader);
  EXPECT_EQ(volume.format, "nrrd");
  EXPECT_EQ(volume.type, SampleType::u16);
  EXPECT_EQ(volume.endian, std::endian::big);
  EXPECT_EQ(volume.lattice.dims(), (Index3{2, 3, 4}));
  EXPECT_EQ(test::all_bytes(slabs(source)), counting_bytes(48));
}

TEST(Nrrd, EveryTypeName) {
  const Folder folder;
  const std::vector<std::pair<const char*, SampleType>> names{{"signed char", SampleType::i8},
                                                              {"uint8_t", SampleType::u8},
                                                              {"signed short int", SampleType::i16},
                                                              {"ushort", SampleType::u16},
                                                              {"int", SampleType::i32},
                                                              {"unsigned int", SampleType::u32},
                                                              {"long long", SampleType::i64},
                                                              {"float16", SampleType::f16},
                                                              {"float", SampleType::f32},
                                                              {"double", SampleType::f64}};
  for (const auto& [name, type] : names) {
    const std::string bytes = counting_bytes(24 * sample_size(type));
    const Source source = open({folder.file(
        "v.nrrd", header(std::string("type: ") + name + "\nendian: little\n\n") + bytes)});
    EXPECT_EQ(volume_of(source.reader).type, type) << name;
    EXPECT_EQ(test::all_bytes(slabs(source)), bytes) << name;
  }
}

TEST(Nrrd, DetachedFilesAreRelativeToTheHeader) {
  const Folder folder;
  const std::string data = folder.file("v.bin", "a line\nxyz" + counting_bytes(24));
  const std::string one = folder.file(
      "one.nhdr", header("type: uint8\nline skip: 1\nbyte skip: 3\ndata file: v.bin\n"));
  EXPECT_EQ(test::all_bytes(slabs(open({one}))), counting_bytes(24));
  const std::string last =
      folder.file("last.nhdr", header("type: uint8\nbyteskip: -1\ndatafile: v.bin\n"));
  EXPECT_EQ(test::all_bytes(slabs(open({last}))), counting_bytes(24));
}

TEST(Nrrd, ListsAndPatternsOfFiles) {
  const Folder folder;
  const std::string bytes = counting_bytes(24);
  for (std::size_t k = 0; k < 4; ++k) {
    (void)folder.file("s" + std::to_string(8 + k), bytes.substr(6 * k, 6));
    (void)folder.file("p0" + std::to_string(9 - k) + ".b", bytes.substr(6 * k, 6));
  }
  (void)folder.file("low", bytes.substr(0, 12));
  (void)folder.file("high", bytes.substr(12));
  const auto read = [&](const std::string& data) {
    return test::all_bytes(
        slabs(open({folder.file("v.nhdr", header("type: uint8\ndata file: " + data))})));
  };
  EXPECT_EQ(read("s%d 8 11 1\n"), bytes);
  EXPECT_EQ(read("p%02d.b 9 6 -1 2\n"), bytes);
  EXPECT_EQ(read("LIST\ns8\ns9\ns10\ns11\n"), bytes);
  EXPECT_EQ(read("LIST 3\nlow\nhigh\n"), bytes);
}

TEST(Nrrd, WrongListsAreRefused) {
  const Folder folder;
  const auto error = [&](const std::string& data) {
    const std::string file = folder.file("v.nhdr", header("type: uint8\ndata file: " + data));
    return error_of_open({file}).substr(2 + file.size());
  };
  EXPECT_EQ(error("s%d 1 9 1\n"), ": data file: 9 files do not make 4 planes");
  EXPECT_EQ(error("s%d 1 4 0\n"), ": data file: -1 files do not make 4 planes");
  EXPECT_EQ(error("s%s 1 4 1\n"), ": data file: \"s%s\": one %d was expected");
  EXPECT_EQ(error("s%d%n 1 4 1\n"), ": data file: \"s%d%n\": one %d was expected");
  EXPECT_EQ(error("s%d 1 4 1 1\n"), ": data file: files of 1 axes each, but 2 or 3 were expected");
  EXPECT_EQ(error("LIST\na\nb\n"), ": data file: 2 files do not make 4 planes");
}

TEST(Nrrd, SpacingsAndAxisMinima) {
  const Folder folder;
  EXPECT_EQ(volume_for(folder, "spacings: 1 2 3\n").lattice.to_world,
            Affine::scale_translate({1, 2, 3}, {0, 0, 0}));
  EXPECT_EQ(volume_for(folder, "spacings: 1 nan 3\naxis mins: 4 5 6\n").lattice.to_world,
            Affine::scale_translate({1, 1, 3}, {4, 5, 6}));
  EXPECT_EQ(volume_for(folder,
                       "axis mins: 0 0 0\naxis maxs: 2 2 8\n"
                       "centerings: cell node cell\n")
                .lattice.to_world,
            Affine::scale_translate({1, 1, 2}, {0.5, 0, 1}));
  EXPECT_EQ(volume_for(folder, "units: \"mm\" \"mm\" \"mm\"\n").units, Units::mm);
}

TEST(Nrrd, SpacesBecomeFrames) {
  const Folder folder;
  const std::string directions =
      "space directions: (1,2,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";
  const Affine as_written{{1, 0, 0, 10, 2, 3, 0, 20, 0, 0, 4, 30}};
  const Volume lps = volume_for(folder, "space: left-posterior-superior\n" + directions);
  EXPECT_EQ(lps.frame, Frame::lps);
  EXPECT_EQ(lps.units, Units::mm);
  EXPECT_EQ(lps.lattice.to_world, as_written);
  const Volume ras = volume_for(folder, "space: RAS\n" + directions);
  EXPECT_EQ(ras.frame, Frame::ras);
  EXPECT_EQ(ras.lattice.to_world, as_written);
  const Volume las = volume_for(folder, "space: LAS\n" + directions);
  EXPECT_EQ(las.frame, Frame::ras);
  EXPECT_EQ(las.lattice.to_world, (Affine{{-1, 0, 0, -10, 2, 3, 0, 20, 0, 0, 4, 30}}));
  const Volume none = volume_for(folder, "space dimension: 3\n" + directions);
  EXPECT_EQ(none.frame, Frame::none);
  EXPECT_EQ(none.units, Units::unknown);
  EXPECT_EQ(none.lattice.to_world, as_written);
}

TEST(Nrrd, OptionsOverridePlacement) {
  const Folder folder;
  SourceOptions options;
  options.spacing = Vec3{10, 6, 8};
  options.origin = Vec3{7, 8, 9};
  const Source source =
      open({folder.file("v.nrrd", header("type: uchar\nspace: RAS\n"
                                         "space directions: (3,4,0) (0,-3,0) (0,0,4)\n\n") +
                                      counting_bytes(24))},
           options);
  EXPECT_EQ(volume_of(source.reader).lattice.to_world,
            (Affine{{6, 0, 0, 7, 8, -6, 0, 8, 0, 0, 8, 9}}));
}

TEST(Nrrd, ALeadingAxisOfOneSampleIsDropped) {
  const Folder folder;
  const Source source = open({folder.file(
      "v.nrrd",
      "NRRD0005\ntype: uchar\ndimension: 4\nsizes: 1 2 3 4\nkinds: vector domain domain "
      "domain\nspace: RAS\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nencoding: "
      "raw\n\n" +
          counting_bytes(24))});
  EXPECT_EQ(volume_of(source.reader).lattice.dims(), (Index3{2, 3, 4}));
}

TEST(Nrrd, RefusesByName) {
  const Folder folder;
  const auto error = [&](const std::string& text) {
    const std::string file = folder.file("v.nrrd", text);
    return error_of_open({file}).substr(2 + file.size());
  };
  EXPECT_EQ(error("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: bzip2\n\n"),
            ":5: encoding: \"bzip2\" samples are not supported by this version, only raw and gzip; "
            "convert the file, for example with: unu save -f nrrd -e raw -i IN -o OUT");
  EXPECT_EQ(error(header("type: uint64\n\n")),
            ":5: type: samples of type \"uint64\" cannot be read: 8- to 64-bit integers (not "
            "unsigned 64-bit), float and double can");
  EXPECT_EQ(error(header("type: short\n\n")),
            ": endian: missing, but short has more than one byte");
  EXPECT_EQ(error("NRRD0004\ntype: uchar\ndimension: 2\nsizes: 2 2\nencoding: raw\n\n"),
            ":3: dimension: 2 axes (2 2), but a volume of three was expected");
  EXPECT_EQ(error("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nkinds: RGB-color domain "
                  "domain\nencoding: raw\n\n"),
            ":5: kinds: an axis of kind RGB-color, but only scalar volumes can be read");
  EXPECT_EQ(error("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 2\nencoding: raw\n\n"),
            ":4: sizes: 1 samples along an axis, but 2 to 2147483647 were expected");
  EXPECT_EQ(error(header("type: uchar\nspace: LPST\n\n") + counting_bytes(24)),
            ":6: space: \"lpst\": a space of three axes was expected, such as "
            "right-anterior-superior");
  EXPECT_EQ(error(header("type: uchar\ntype: uchar\n\n")), ":6: type is given twice");
  EXPECT_EQ(error(header("no colon\n\n")), ":5: \"no colon\": \"field: value\" was expected");
  EXPECT_EQ(error("NRRD0009\n\n"), ":1: NRRD0001 to NRRD0005 was expected");
  EXPECT_EQ(error(header("type: uchar\n")),
            ": the header of a NRRD file does not end; the file is damaged or cut off");
  EXPECT_EQ(error(header("type: uchar\nspacings: 1 0 1\n\n") + counting_bytes(24)),
            ": the map from samples to the world is singular or not finite");
  EXPECT_EQ(error(header("type: uchar\n\n") + counting_bytes(23)),
            ": 23 bytes of samples, but 2x3x4 u8 needs 24 in this file; the file is cut off or the "
            "header's sizes and type are wrong");
}

TEST(Nrrd, HugeSizesAreAnErrorAndNoAllocation) {
  const Folder folder;
  const std::string file = folder.file(
      "v.nrrd",
      "NRRD0004\ntype: double\nendian: little\ndimension: 3\nsizes: 2147483647 2147483647 "
      "2147483647\nencoding: raw\n\n");
  EXPECT_EQ(error_of_open({file}), "3 " + file + ": sizes: more bytes than 64 bits can count");
}

TEST(NrrdReal, SlicesByPatternAreTheSlicesByGlob) {
  const std::string folder = test::shared_volume("raw-headsq-slices");
  MC_NEEDS_VOLUME(folder);
  const Source by_header = open({folder + "/quarter.nhdr"});
  const Volume& volume = volume_of(by_header.reader);
  EXPECT_EQ(volume.lattice.dims(), (Index3{64, 64, 93}));
  EXPECT_EQ(volume.type, SampleType::i16);
  EXPECT_EQ(volume.frame, Frame::none);
  EXPECT_EQ(volume.lattice.to_world, Affine::scale_translate({3.2, 3.2, 1.5}, {0, 0, 0}));
  SourceOptions options;
  options.dims = {64, 64};
  options.type = SampleType::i16;
  const Source by_glob = open({folder + "/quarter.[0-9]*"}, options);
  EXPECT_EQ(test::all_bytes(slabs(by_glob)), test::all_bytes(slabs(by_header)));
}

#if MC_WITH_GZIP

TEST(NrrdGzip, AttachedDetachedAndInParts) {
  const Folder folder;
  const std::string bytes = counting_bytes(24);
  const std::string head = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: gzip\n";
  const auto open_all = [&](const std::string& name, const std::string& text) {
    return test::all_bytes(slabs(open({folder.file(name, text)})));
  };
  EXPECT_EQ(open_all("v.nrrd", head + "\n" + test::gzip_bytes(bytes)), bytes);
  EXPECT_EQ(open_all("s.nrrd", head + "byte skip: 3\nline skip: 2\n\na\nb\n" +
                                   test::gzip_bytes("abc" + bytes)),
            bytes);
  std::ignore = folder.file("v.gz", test::gzip_bytes(bytes));
  EXPECT_EQ(open_all("v.nhdr", head + "data file: v.gz\n"), bytes);
  for (std::size_t n = 0; n < 2; ++n) {
    std::ignore =
        folder.file("part" + std::to_string(n), test::gzip_bytes(bytes.substr(12 * n, 12)));
  }
  EXPECT_EQ(open_all("p.nhdr", head + "data file: LIST 3\npart0\npart1\n"), bytes);
}

TEST(NrrdGzip, DamageIsFound) {
  const Folder folder;
  const auto error = [&](const std::string& fields, const std::string& data) {
    const std::string file = folder.file(
        "v.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: gzip\n" + fields +
                      "\n" + data);
    return error_of_open({file}).substr(2 + file.size());
  };
  const std::string packed = test::gzip_bytes(counting_bytes(24));
  EXPECT_EQ(error("", test::gzip_bytes(counting_bytes(23))),
            ": 23 bytes of samples, but 2x3x4 u8 needs 24 in this file; the file is cut off or the "
            "header's sizes and type are wrong");
  constexpr const char* kRemedy = "; the file is cut off or was changed";
  EXPECT_EQ(error("", packed.substr(0, 20)),
            std::string(": damaged gzip data: it ends early") + kRemedy);
  EXPECT_EQ(error("", packed.substr(0, packed.size() - 1)),
            std::string(": damaged gzip data: it ends early") + kRemedy);
  std::string wrong = packed;
  wrong[packed.size() - 7] ^= 1;
  EXPECT_EQ(error("", wrong), std::string(": damaged gzip data: incorrect data check") + kRemedy);
  EXPECT_EQ(error("", counting_bytes(24)),
            std::string(": damaged gzip data: incorrect header check") + kRemedy);
  EXPECT_EQ(error("byte skip: -1\n", packed),
            ":6: byte skip: a whole number, at least 0, was expected");
}

TEST(NrrdReal, ACompressedBunny) {
  const std::string file = test::shared_volume("nrrd-bunny-ct-gz/bunnyPadded.nrrd");
  MC_NEEDS_VOLUME(file);
  const Source bunny = open({file});
  EXPECT_EQ(volume_of(bunny.reader).lattice.dims(), (Index3{258, 258, 182}));
  const std::string bytes = test::all_bytes(slabs(bunny));
  EXPECT_EQ(std::ranges::count_if(bytes, [](char c) { return c != 0 && c != 10 && c != '\xff'; }),
            0);
}

#endif

}  // namespace
}  // namespace mc
