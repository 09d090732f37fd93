// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <string>
#include <thread>
#include <vector>

#include "mc/sink.hpp"
#include "support/memory_readers.hpp"
#include "unit/sink/volume_support.hpp"

namespace mc {
namespace {

using namespace std::string_literals;
using test::bytes_of;
using test::MemoryLeaves;
using test::MemorySlabs;
using test::VolumeFolder;
using test::write_planes;
using test::write_volume;

template <class Run>
std::string message_of(ErrorKind kind, Run&& run) {
  try {
    run();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "no error";
}

TEST(NrrdSink, WritesHeaderAndSamplesByteForByte) {
  const VolumeFolder folder;
  MemorySlabs::Layout layout;
  layout.to_world = {{0.5, 0, 0, -10, 0, 0, 0.1, 20.25, 0, -2, 0, 1e-7}};
  layout.endian = std::endian::big;
  layout.row_padding = 3;
  MemorySlabs volume(std::vector<std::int16_t>{1, 2, 3, 4, 5, 6, 7, -8}, {2, 2, 2}, layout);
  volume.edit().frame = Frame::lps;
  SinkOptions options;
  options.provenance = {{"source", "head\nct"}, {"iso", "300"}};
  write_volume(folder / "v.nrrd", volume, options);
  EXPECT_EQ(bytes_of(folder / "v.nrrd"),
            "NRRD0005\n"
            "# source: head\\nct\n"
            "# iso: 300\n"
            "type: int16\n"
            "dimension: 3\n"
            "space: left-posterior-superior\n"
            "sizes: 2 2 2\n"
            "space directions: (0.5,0,0) (0,0,-2) (0,0.1,0)\n"
            "kinds: domain domain domain\n"
            "endian: big\n"
            "encoding: raw\n"
            "space units: \"mm\" \"mm\" \"mm\"\n"
            "space origin: (-10,20.25,1e-07)\n"
            "\n"
            "\0\1\0\2\0\3\0\4\0\5\0\6\0\7\xFF\xF8"s);
}

TEST(NrrdSink, KeepsWhatTheVolumeSaysOfItself) {
  const VolumeFolder folder;
  MemorySlabs volume(std::vector<std::uint8_t>{9}, {1, 1, 1});
  volume.edit().name = "a\\b";
  volume.edit().cls = VolumeClass::level_set;
  volume.edit().iso = 0.1;
  volume.edit().border = Border::closed;
  volume.edit().units = Units::m;
  write_volume(folder / "v.nrrd", volume);
  EXPECT_EQ(bytes_of(folder / "v.nrrd"),
            "NRRD0005\n"
            "type: uint8\n"
            "dimension: 3\n"
            "space dimension: 3\n"
            "sizes: 1 1 1\n"
            "space directions: (1,0,0) (0,1,0) (0,0,1)\n"
            "kinds: domain domain domain\n"
            "encoding: raw\n"
            "space units: \"m\" \"m\" \"m\"\n"
            "space origin: (0,0,0)\n"
            "mc name:=a\\\\b\n"
            "mc class:=level_set\n"
            "mc iso:=0.1\n"
            "mc border:=closed\n"
            "\n"
            "\t");
}

TEST(NrrdSink, WritesHalvesAsFloatsOfTheSameByteOrder) {
  for (const std::endian endian : {std::endian::little, std::endian::big}) {
    const VolumeFolder folder;
    MemorySlabs::Layout layout;
    layout.endian = endian;
    write_volume(folder / "v.nrrd",
                 MemorySlabs(std::vector<Half>{to_half(1.5F), to_half(-2.F)}, {2, 1, 1}, layout));
    const std::string bytes = bytes_of(folder / "v.nrrd");
    EXPECT_NE(bytes.find("type: float\n"), std::string::npos);
    const std::string samples = bytes.substr(bytes.find("\n\n") + 2);
    EXPECT_EQ(samples, endian == std::endian::little ? "\0\0\xC0\x3F\0\0\0\xC0"s
                                                     : "\x3F\xC0\0\0\xC0\0\0\0"s);
  }
}

TEST(NrrdSink, TakesSparseVolumesAsPlanesOfTheirBox) {
  const VolumeFolder folder;
  const std::vector<float> samples(512, 1.F);
  const MemoryLeaves sparse(samples, {8, 8, 8}, {8, 16, 24}, 0.F,
                            Affine::scale_translate({2, 2, 2}, {1, 0, 0}));
  const auto sink = open_volume_sink(folder / "v.nrrd", {});
  sink->begin(sparse.volume());
  EXPECT_FALSE(sink->write_sparse(sparse));
  write_planes(*dense_view(sparse, sparse.volume().lattice.box), *sink, 5);
  sink->finish();
  const std::string bytes = bytes_of(folder / "v.nrrd");
  EXPECT_NE(bytes.find("space origin: (17,32,48)\n"), std::string::npos);
  EXPECT_EQ(bytes.size() - bytes.find("\n\n") - 2, 512 * sizeof(float));
}

TEST(RawSink, PutsADetachedHeaderBeside) {
  const VolumeFolder folder;
  write_volume(folder / "head ct.raw",
               MemorySlabs(std::vector<std::uint8_t>{1, 2, 3, 4}, {2, 1, 2}));
  EXPECT_EQ(bytes_of(folder / "head ct.raw"), "\1\2\3\4");
  EXPECT_EQ(bytes_of(folder / "head ct.nhdr"),
            "NRRD0005\n"
            "type: uint8\n"
            "dimension: 3\n"
            "space dimension: 3\n"
            "sizes: 2 1 2\n"
            "space directions: (1,0,0) (0,1,0) (0,0,1)\n"
            "kinds: domain domain domain\n"
            "encoding: raw\n"
            "space origin: (0,0,0)\n"
            "data file: head ct.raw\n"
            "\n");
}

TEST(RawSink, GivesAPipeTheSamplesOnly) {
  const VolumeFolder folder;
  const std::string pipe = folder / "pipe.raw";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string got;
  {
    const std::jthread reader([&] { got = bytes_of(pipe); });
    write_volume(pipe, MemorySlabs(std::vector<std::uint8_t>{5, 6}, {2, 1, 1}));
  }
  EXPECT_EQ(got, "\5\6");
  EXPECT_FALSE(std::filesystem::exists(folder / "pipe.nhdr"));
}

TEST(VolumeSinks, LeaveNothingWhenNotFinished) {
  const VolumeFolder folder;
  const MemorySlabs volume(std::vector<float>{1, 2}, {1, 1, 2});
  for (const char* name : {"v.nrrd", "v.raw"}) {
    const auto sink = open_volume_sink(folder / name, {});
    sink->begin(volume.volume());
    Slab slab;
    volume.read(0, 1, slab);
    sink->write(slab);
    EXPECT_EQ(message_of(ErrorKind::internal, [&] { sink->finish(); }),
              folder / name + ": the volume was not written to its end");
  }
  EXPECT_TRUE(folder.empty());
}

TEST(VolumeSinks, RefuseWhatTheyCannotWrite) {
  const VolumeFolder folder;
  EXPECT_EQ(message_of(ErrorKind::usage, [] { open_volume_sink("a.ply", {}); }),
            "a.ply: ply holds meshes, but this is a volume; write vdb, nrrd, raw or exr");
  SinkOptions raw;
  raw.to = "raw";
  EXPECT_EQ(message_of(ErrorKind::usage, [&] { open_volume_sink("a.nhdr", raw); }),
            "a.nhdr: the samples and their header would be one file; name the samples NAME.raw");
  const MemorySlabs volume(std::vector<float>{1}, {1, 1, 1});
  write_volume(folder / "v.raw", volume);
  std::filesystem::remove(folder / "v.raw");
  EXPECT_EQ(message_of(ErrorKind::output, [&] { write_volume(folder / "v.raw", volume); }),
            folder / "v.nhdr" + ": exists; add --force to replace it");
  EXPECT_FALSE(std::filesystem::exists(folder / "v.raw"));
}

}  // namespace
}  // namespace mc
