// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "support/source_files.hpp"

namespace mc {
namespace {

using test::counting_bytes;
using test::error_of_open;
using test::Folder;

TEST(Registry, MissingAndEmptyFiles) {
  const Folder folder;
  const std::string missing = folder.path("none.vdb");
  EXPECT_EQ(error_of_open({missing}), "3 " + missing + ": cannot open: No such file or directory");
  const std::string empty = folder.file("empty.vdb", "");
  EXPECT_EQ(error_of_open({empty}), "3 " + empty + ": is empty");
  EXPECT_EQ(error_of_open({}), "2 no input; name a file, a folder or - for stdin");
}

TEST(Registry, ContentDecidesBeforeTheName) {
  const Folder folder;
  const std::string file = folder.file(
      "v.vdb", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n12345678");
  EXPECT_EQ(volume_of(test::open({file}).reader).format, "nrrd");
}

TEST(Registry, KnownKindsThatAreNotSupported) {
  const Folder folder;
  const auto error = [&](std::string_view name, const std::string& bytes) {
    const std::string file = folder.file(name, bytes);
    return error_of_open({file}).substr(2 + file.size());
  };
  constexpr const char* kRemedy =
      " is not supported by this version; convert it to VDB, NRRD or raw first";
  EXPECT_EQ(error("scan", std::string(128, '\0') + "DICM..."), std::string(": DICOM") + kRemedy);
#if MC_WITH_EXR
  EXPECT_EQ(error("a", "\x76\x2f\x31\x01..."),
            ": damaged OpenEXR file: Unable to read magic and version flags");
#endif
#if MC_WITH_PNG
  EXPECT_EQ(error("b", "\x89PNG\r\n\x1a\n"), ": damaged PNG: the file ends too soon");
#endif
  EXPECT_EQ(error("c", std::string("II*\0", 4)), std::string(": TIFF") + kRemedy);
  EXPECT_EQ(error("d", "ObjectType = Image\n"), std::string(": MetaImage") + kRemedy);
  EXPECT_EQ(error("e.nii.gz", "\x1f\x8b\x08..."), std::string(": NIfTI") + kRemedy);
  EXPECT_EQ(error("f.dcm", "..."), std::string(": DICOM") + kRemedy);
  EXPECT_EQ(error("g", std::string(344, '\0') + std::string("n+1\0", 4)),
            std::string(": NIfTI") + kRemedy);
  EXPECT_EQ(error("m.stl", "solid"), ": a mesh, but a volume was expected");
}

TEST(Registry, FromNamesTheKind) {
  const Folder folder;
  const std::string file = folder.file("v", "12345678");
  SourceOptions options;
  options.from = "dicom";
  EXPECT_EQ(error_of_open({file}, options),
            "3 " + file +
                ": DICOM is not supported by this version; convert it to VDB, NRRD or raw first");
  options.from = "vdbb";
  EXPECT_EQ(error_of_open({file}, options),
            "2 --from: \"vdbb\" is no kind of input; choose one of vdb, raw, nrrd, spec, exr, png");
  options.from = "nrrd";
  EXPECT_EQ(
      error_of_open({file}, options),
      "3 " + file + ": the header of a NRRD file does not end; the file is damaged or cut off");
  options.from = "vdb";
  EXPECT_EQ(error_of_open({file}, options),
            "3 " + file + ": not a VDB file: it does not begin with the magic number");
  options.from = "raw";
  options.dims = {2, 2, 2};
  options.type = SampleType::u8;
  EXPECT_EQ(test::all_bytes(test::slabs(test::open({file}, options))), "12345678");
}

TEST(Registry, UnknownKindsAreUsage) {
  const Folder folder;
  const std::string file = folder.file("v.xyz", "12345678");
  EXPECT_EQ(
      error_of_open({file}),
      "2 " + file +
          ": neither its content nor its extension says what it is; name it by --from, or for "
          "raw data give --dims X,Y[,Z] and --type");
  SourceOptions options;
  options.dims = {2, 2, 2};
  EXPECT_EQ(error_of_open({file}, options).substr(0, 40),
            ("2 " + file + ": raw data says nothing").substr(0, 40));
}

TEST(Registry, FoldersAndSeveralFiles) {
  const Folder folder;
  const std::string a = folder.file("a.xyz", "1234");
  const std::string b = folder.file("b.xyz", "1234");
  EXPECT_EQ(error_of_open({folder.path("")}),
            "3 " + folder.path("") +
                ": a folder with no known file; for raw data give --dims X,Y[,Z] and --type");
  EXPECT_EQ(error_of_open({a, b}),
            "2 " + a +
                ": 2 files, but only slices make one volume together; for raw data give --dims "
                "X,Y[,Z] and --type");
  const Folder scans;
  (void)scans.file("IM1", std::string(128, '\0') + "DICM");
  (void)scans.file("IM2", std::string(128, '\0') + "DICM");
  EXPECT_EQ(error_of_open({scans.path("")}),
            "3 " + scans.path("") +
                ": DICOM is not supported by this version; convert it to VDB, NRRD or raw first");
  const Folder none;
  EXPECT_EQ(error_of_open({none.path("")}), "3 " + none.path("") + ": a folder with no known file");
}

TEST(Registry, OptionsThatContradictTheFile) {
  const Folder folder;
  const std::string file = folder.file(
      "v.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n12345678");
  SourceOptions options;
  options.skip_bytes = 4;
  EXPECT_EQ(error_of_open({file}, options), "2 --skip: is for raw data, but " + file + " is NRRD");
  options = {};
  options.grid = "density";
  EXPECT_EQ(error_of_open({file}, options), "2 --grid: is for VDB files, but " + file + " is NRRD");
  options = {};
  options.spacing = Vec3{1, 0, 1};
  EXPECT_EQ(error_of_open({file}, options),
            "2 --spacing: three finite numbers above 0 were expected");
  options = {};
  options.origin = Vec3{1, std::numeric_limits<double>::quiet_NaN(), 1};
  EXPECT_EQ(error_of_open({file}, options), "2 --origin: three finite numbers were expected");
}

TEST(Registry, SpecsAreKnownByContentAndCanBePlaced) {
  const Folder folder;
  const std::string file =
      folder.file("sphere", test::read_bytes(test::source_file("data/specs/sphere.json")));
  EXPECT_EQ(volume_of(test::open({file}).reader).format, "spec");
  SourceOptions options;
  options.spacing = Vec3{1, 2, 3};
  options.origin = Vec3{4, 5, 6};
  EXPECT_EQ(volume_of(test::open({file}, options).reader).lattice.to_world,
            Affine::scale_translate({1, 2, 3}, {4, 5, 6}));
}

TEST(Registry, DescribesDenseFiles) {
  const Folder folder;
  const std::vector<std::string> inputs{folder.file(
      "v.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n12345678")};
  const auto grids = describe_source(inputs, {}, silent_progress());
  ASSERT_EQ(grids.size(), 1U);
  EXPECT_EQ(grids[0].type_name, "u8");
  EXPECT_EQ(grids[0].refused, "");
  EXPECT_EQ(grids[0].volume.lattice.dims(), (Index3{2, 2, 2}));
}

}  // namespace
}  // namespace mc
