// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "support/source_files.hpp"

namespace mc {
namespace {

using test::counting_bytes;
using test::error_of_open;
using test::Folder;
using test::open;
using test::slabs;

SourceOptions raw(std::vector<std::int64_t> dims, SampleType type) {
  SourceOptions options;
  options.dims = std::move(dims);
  options.type = type;
  return options;
}

TEST(Raw, EveryTypeIsHandedOutAsItLies) {
  const Folder folder;
  for (const char* name : {"u8", "i8", "u16", "i16", "u32", "i32", "i64", "f16", "f32", "f64"}) {
    const SampleType type = *sample_type_named(name);
    const std::string bytes = counting_bytes(2 * 3 * 4 * sample_size(type));
    const Source source = open({folder.file(name, bytes)}, raw({2, 3, 4}, type));
    const Volume& volume = volume_of(source.reader);
    EXPECT_EQ(volume.type, type);
    EXPECT_EQ(volume.format, "raw");
    EXPECT_EQ(volume.endian, std::endian::little);
    EXPECT_EQ(volume.lattice.dims(), (Index3{2, 3, 4}));
    EXPECT_EQ(test::all_bytes(slabs(source)), bytes) << name;
  }
}

TEST(Raw, SlabsPointIntoTheMapping) {
  const Folder folder;
  const Source source =
      open({folder.file("v", counting_bytes(2 * 3 * 4))}, raw({2, 3, 4}, SampleType::u8));
  Slab slab;
  slabs(source).read(1, 3, slab);
  EXPECT_EQ(slab.k0, 1);
  EXPECT_EQ(slab.row_stride_bytes, 2U);
  ASSERT_EQ(slab.planes.size(), 2U);
  EXPECT_EQ(slab.planes[1] - slab.planes[0], 6);
  EXPECT_EQ(slab.planes[0][0], std::byte{6});
  EXPECT_TRUE(slab.storage.empty());
  EXPECT_TRUE(slabs(source).rereads_cheaply());
}

TEST(Raw, EndianSkipAndPlacement) {
  const Folder folder;
  SourceOptions options = raw({2, 2, 2}, SampleType::u16);
  options.endian = std::endian::big;
  options.skip_bytes = 5;
  options.spacing = Vec3{1, 2, 3};
  options.origin = Vec3{10, 20, 30};
  const Source source = open({folder.file("v", "12345" + counting_bytes(16))}, options);
  EXPECT_EQ(volume_of(source.reader).endian, std::endian::big);
  EXPECT_EQ(test::all_bytes(slabs(source)), counting_bytes(16));
  EXPECT_EQ(volume_of(source.reader).lattice.to_world({1, 1, 1}), (Vec3{11, 22, 33}));
}

TEST(Raw, PlanesAreCountedWhereTheyAreNotTyped) {
  const Folder folder;
  const std::string file = folder.file("v", counting_bytes(2 * 3 * 5));
  EXPECT_EQ(volume_of(open({file}, raw({2, 3}, SampleType::u8)).reader).lattice.dims(),
            (Index3{2, 3, 5}));
  EXPECT_EQ(
      error_of_open({file}, raw({4, 3}, SampleType::u8)),
      "3 " + file + ": 30 bytes, but 4x3 u8 planes need a multiple of 12; check --dims and --type");
  EXPECT_EQ(error_of_open({file}, raw({5, 6}, SampleType::u8)),
            "3 " + file + ": 1 planes of 5x6 u8, but 2 to 2147483647 were expected");
}

TEST(Raw, WrongSizeGivesBothFigures) {
  const Folder folder;
  const std::string file = folder.file("head.raw", counting_bytes(20));
  EXPECT_EQ(error_of_open({file}, raw({2, 3, 4}, SampleType::u16)),
            "3 " + file + ": 20 bytes, but 2x3x4 u16 needs 48; check --dims and --type");
  SourceOptions skipping = raw({2, 3, 3}, SampleType::u8);
  skipping.skip_bytes = 4;
  EXPECT_EQ(error_of_open({file}, skipping),
            "3 " + file +
                ": 20 bytes, but 2x3x3 u8 after 4 skipped bytes needs 22; check --dims, --type "
                "and --skip");
}

TEST(Raw, DimsOutOfRangeAreUsage) {
  const Folder folder;
  const std::string file = folder.file("v", counting_bytes(20));
  const auto error = [&](std::vector<std::int64_t> dims) {
    return error_of_open({file}, raw(std::move(dims), SampleType::f64));
  };
  EXPECT_EQ(error({0, 4, 4}),
            "2 --dims: 0x4x4: 2 to 2147483647 samples along each axis were expected");
  EXPECT_EQ(error({4, -4, 4}),
            "2 --dims: 4x-4x4: 2 to 2147483647 samples along each axis were expected");
  EXPECT_EQ(error({4, 4, 1}),
            "2 --dims: 4x4x1: 2 to 2147483647 samples along each axis were expected");
  EXPECT_EQ(error({2147483647, 2147483647, 4}),
            "2 --dims: 2147483647x2147483647x4 f64: more bytes than 64 bits can count");
  EXPECT_EQ(error({4}), "2 --dims: 1 numbers, but two or three were expected");
}

TEST(Raw, SaysWhatItNeeds) {
  const Folder folder;
  const std::string file = folder.file("v.raw", counting_bytes(20));
  EXPECT_EQ(error_of_open({file}),
            "2 " + file +
                ": raw data says nothing of itself; give --dims X,Y[,Z] and --type "
                "u8|i8|u16|i16|u32|i32|f16|f32|f64");
}

TEST(RawSeries, IsInNaturalOrder) {
  const Folder folder;
  std::vector<std::string> files;
  for (const char* n : {"10", "2", "1"}) {
    files.push_back(folder.file(std::string("s.") + n, std::string(4, n[0]) + n));
  }
  SourceOptions options = raw({2, 2}, SampleType::u8);
  for (std::string& file : files) {  // all four bytes long
    std::filesystem::resize_file(file, 4);
  }
  const std::string expected = "111122221111";
  EXPECT_EQ(test::all_bytes(slabs(open(files, options))), expected);
  EXPECT_EQ(test::all_bytes(slabs(open({folder.path("s.*")}, options))), expected);
  EXPECT_EQ(test::all_bytes(slabs(open({folder.path("")}, options))), expected);
  options.dims = {2, 2, 3};
  EXPECT_EQ(volume_of(open(files, options).reader).lattice.dims(), (Index3{2, 2, 3}));
  options.dims = {2, 2, 4};
  EXPECT_EQ(error_of_open(files, options),
            "3 " + files[0] + ": 3 slices, but 2x2x4 needs 4; check --dims");
}

TEST(RawSeries, NamesTheSliceOfTheWrongSize) {
  const Folder folder;
  const std::string a = folder.file("a", "1234");
  const std::string b = folder.file("b", "123");
  EXPECT_EQ(error_of_open({a, b}, raw({2, 2}, SampleType::u8)),
            "3 " + b + ": 3 bytes, but 2x2 u8 needs 4; check --dims and --type");
  EXPECT_EQ(error_of_open({a, a}, raw({2, 2}, SampleType::u8)),
            "2 " + a + ": named twice; give each slice once");
  const std::string none = folder.path("z*");
  EXPECT_EQ(error_of_open({none}, raw({2, 2}, SampleType::u8)),
            "3 " + none + ": no such file, and no file matches the pattern");
}

TEST(RawSeries, LeavesOutWhatDescribesIt) {
  const Folder folder;
  const std::string a = folder.file("s.1", "1111");
  const std::string b = folder.file("s.2", "2222");
  const std::string header = folder.file("s.nhdr", "a header");
  const Source source = open({folder.path("s.*")}, raw({2, 2}, SampleType::u8));
  EXPECT_EQ(test::all_bytes(slabs(source)), "11112222");
}

TEST(RawSidecar, IsReadByItWithoutOptions) {
  const Folder folder;
  const std::string file = folder.file("v.raw", counting_bytes(16));
  const std::string header =
      folder.file("v.nhdr",
                  "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nendian: big\n"
                  "spacings: 2 2 2\ndata file: v.raw\n");
  const Source source = open({file});
  EXPECT_EQ(volume_of(source.reader).format, "nrrd");
  EXPECT_EQ(volume_of(source.reader).type, SampleType::u16);
  EXPECT_EQ(test::all_bytes(slabs(source)), counting_bytes(16));
  EXPECT_EQ(volume_of(open({file}, raw({4, 2, 2}, SampleType::u8)).reader).format, "raw");
}

}  // namespace
}  // namespace mc
