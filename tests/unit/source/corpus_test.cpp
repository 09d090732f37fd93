// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "support/fuzz_images.hpp"
#include "support/fuzz_streams.hpp"
#include "support/fuzz_volumes.hpp"
#include "support/source_files.hpp"

// Every file that ever stood for a fault of a reader, or for a kind of file, is read again.

namespace mc {
namespace {

/// The names of the files of data/corpus/KIND that `read` finds readable.
template <class F>
std::vector<std::string> readable(const std::string& kind, F&& read) {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_file("data/corpus/" + kind))) {
    const std::string bytes = test::read_bytes(entry.path().string());
    if (read(std::as_bytes(std::span(bytes)))) {
      names.push_back(entry.path().filename().string());
    }
  }
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> readable(const std::string& kind) {
  return readable(kind, [&](auto bytes) { return test::open_and_read(kind, bytes); });
}

TEST(Corpus, Nrrd) {
  std::vector<std::string> names{"attached_big_i16.nrrd", "attached_u8.nrrd"};
#if MC_WITH_GZIP
  names.insert(names.end(), {"gzip_of_more.nrrd", "gzip_u8.nrrd", "packed_container.nrrd.gz"});
#endif
  EXPECT_EQ(readable("nrrd"), names);
}

#if MC_WITH_VDB
TEST(Corpus, Vdb) {
  EXPECT_EQ(readable("vdb"),
            (std::vector<std::string>{"bool_zip.vdb", "float_level_set.vdb", "half_and_vectors.vdb",
                                      "stream_no_offsets.vdb"}));
}
#endif

TEST(Corpus, Raw) { EXPECT_EQ(readable("raw"), std::vector<std::string>{"u8_2x3.raw"}); }

// One picture alone is not a volume, whatever it holds.
TEST(Corpus, Stream) {
  std::vector<std::string> names{"good-everything.json", "plain.nrrd"};
#if MC_WITH_GZIP
  names.push_back("packed.nrrd.gz");
#endif
#if MC_WITH_ZSTD
  names.insert(names.end(), {"followed.nrrd.zst", "packed.nrrd.zst"});
#endif
#if MC_WITH_VDB
  names.push_back("bool_zip.vdb");
#endif
  std::ranges::sort(names);
  EXPECT_EQ(readable("stream", test::stream_and_read), names);
}

#if MC_WITH_EXR
TEST(Corpus, Exr) {
  EXPECT_EQ(
      readable("exr",
               [](auto bytes) { return test::open_and_decode(source::ImageKind::exr, bytes); }),
      (std::vector<std::string>{"parts_uint.exr", "scan_half_zip.exr", "tiles_float.exr",
                                "zip_called_b44.exr"}));  // by chance whole B44 blocks
}
#endif

#if MC_WITH_PNG
TEST(Corpus, Png) {
  EXPECT_EQ(
      readable("png",
               [](auto bytes) { return test::open_and_decode(source::ImageKind::png, bytes); }),
      (std::vector<std::string>{"grey16.png", "interlaced.png", "palette2.png", "rgba8.png"}));
}
#endif

}  // namespace
}  // namespace mc
