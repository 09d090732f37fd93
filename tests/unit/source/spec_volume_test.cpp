// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "source/spec/read_volume.hpp"
#include "source/spec/spec_files.hpp"
#include "support/memory_readers.hpp"
#include "support/source_files.hpp"
#if MC_WITH_VDB
#include "support/vdb_grids.hpp"
#endif

// Volumes that documents name: how they are found, opened and made dense, and the full text of
// every fault.

namespace mc {
namespace {

using test::counting_bytes;
using test::error_of_open;
using test::Folder;

/// A document of one volume, on a line, with its path at column 107.
std::string document(const std::string& keys, const std::string& grid = "[3, 2, 2]") {
  return R"({"format": "mc-volume", "version": 1, "grid": {"samples": )" + grid +
         R"(}, "field": {"type": "volume", "path": )" + keys + "}}";
}

std::string nrrd(const std::string& placement) {
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n" + placement + "\n" +
         counting_bytes(12);
}

std::vector<float> samples_of(const std::string& path) {
  const Source source = test::open({path});
  const std::string bytes = test::all_bytes(test::slabs(source));
  std::vector<float> out(bytes.size() / sizeof(float));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

std::vector<float> counting(std::size_t n) {
  std::vector<float> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<float>(i);
  return out;
}

TEST(SpecVolume, LiesBesideItsDocument) {
  const Folder folder;
  std::filesystem::create_directory(folder.path("maps"));
  static_cast<void>(folder.file("maps/v.nrrd", nrrd("spacings: 1 1 1\n")));
  EXPECT_EQ(samples_of(folder.file("a.json", document(R"("maps/v.nrrd")"))), counting(12));
  EXPECT_EQ(samples_of(folder.file("b.json", document("\"" + folder.path("maps/v.nrrd") +
                                                      R"(", "filter": "nearest")"))),
            counting(12));
}

TEST(SpecVolume, LiesWhereItsPlacementSays) {
  const Folder folder;
  // i runs down from x = 2, j along z, k along y.
  static_cast<void>(folder.file("v.nrrd", nrrd("space dimension: 3\nspace directions: (-1,0,0) "
                                               "(0,0,1) (0,1,0)\nspace origin: (2,0,0)\n")));
  EXPECT_EQ(samples_of(folder.file("a.json", document(R"("v.nrrd")"))),
            (std::vector<float>{2, 1, 0, 8, 7, 6, 5, 4, 3, 11, 10, 9}));
}

TEST(SpecVolume, OutsideIsAsTheDocumentSays) {
  const Folder folder;
  static_cast<void>(folder.file("v.nrrd", nrrd("spacings: 1 1 1\n")));
  const auto last = [&](const std::string& keys) {
    return samples_of(folder.file("a.json", document(keys, "[9, 2, 2]"))).back();
  };
  EXPECT_EQ(last(R"("v.nrrd")"), 11);
  EXPECT_EQ(last(R"("v.nrrd", "outside": -7.5)"), -7.5F);
}

TEST(SpecVolume, MayBeADocument) {
  const Folder folder;
  static_cast<void>(folder.file("inner.json", R"({"format": "mc-volume", "version": 1,
      "grid": {"samples": [3, 2, 2]}, "field": {"type": "add", "inputs":
      ["x", {"type": "mul", "inputs": ["y", 3]}, {"type": "mul", "inputs": ["z", 6]}]}})"));
  EXPECT_EQ(samples_of(folder.file("a.json", document(R"("inner.json")"))), counting(12));
}

TEST(SpecVolume, NamedTwiceIsReadOnce) {
  const Folder folder;
  static_cast<void>(folder.file("v.nrrd", nrrd("spacings: 1 1 1\n")));
  source::SpecFiles files(folder.path("a.json"), {});
  const auto volume = files.volume("v.nrrd", std::nullopt);
  EXPECT_EQ(files.volume("./v.nrrd", std::nullopt), volume);
}

TEST(SpecVolume, SparseOnesBecomeDense) {
  std::vector<float> values(16 * 16 * 16, 3);
  values[(5 * 16 + 4) * 16 + 9] = -1;
  auto leaves =
      std::make_unique<test::MemoryLeaves>(values, Index3{16, 16, 16}, Index3{-8, 0, 8}, 3.0F,
                                           Affine::scale_translate({0.5, 0.5, 0.5}, {1, 2, 3}));
  const IndexBox box = leaves->volume().lattice.box;
  const SampledVolume volume = source::read_volume(std::move(leaves), "v");
  EXPECT_EQ(volume.background, 3.0F);
  EXPECT_EQ(volume.dims, (Index3{static_cast<std::int32_t>(box.extent(0)),
                                 static_cast<std::int32_t>(box.extent(1)),
                                 static_cast<std::int32_t>(box.extent(2))}));
  // Sample (9, 4, 5) of the array has index (1, 4, 13), and its place in the world is this.
  const Vec3 at = volume.to_index({1.5, 4, 9.5});
  const auto index = [&](std::size_t axis) { return static_cast<std::size_t>(at[axis]); };
  EXPECT_EQ(at, (Vec3{double(1 - box.lo[0]), double(4 - box.lo[1]), double(13 - box.lo[2])}));
  const auto n = [&](std::size_t axis) { return static_cast<std::size_t>(volume.dims[axis]); };
  EXPECT_EQ(volume.samples[(index(2) * n(1) + index(1)) * n(0) + index(0)], -1);
  EXPECT_EQ(std::ranges::count(volume.samples, -1.0F), 1);
}

template <class T>
void expect_floats(std::endian endian) {
  std::vector<T> values(5 * 3 * 21);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<T>(i % 100);
  const VolumeReader reader = std::make_unique<test::MemorySlabs>(
      values, Index3{5, 3, 21},
      test::MemorySlabs::Layout{.to_world = {}, .endian = endian, .row_padding = 3});
  const SampledVolume volume = source::read_volume(reader, "v");
  ASSERT_EQ(volume.samples.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(volume.samples[i], static_cast<float>(i % 100)) << i;
  }
  EXPECT_EQ(volume.background, std::nullopt);
}

TEST(SpecVolume, EveryTypeBecomesFloat) {
  for (const std::endian endian : {std::endian::little, std::endian::big}) {
    expect_floats<std::uint8_t>(endian);
    expect_floats<std::int16_t>(endian);
    expect_floats<std::uint32_t>(endian);
    expect_floats<std::int64_t>(endian);
    expect_floats<float>(endian);
    expect_floats<double>(endian);
  }
}

TEST(SpecVolume, NeedsAMapThatCanBeInverted) {
  const VolumeReader reader = std::make_unique<test::MemorySlabs>(
      std::vector<float>(8), Index3{2, 2, 2}, Affine::scale_translate({1, 0, 1}, {0, 0, 0}));
  EXPECT_EQ(test::error_of([&] { source::read_volume(reader, "v"); }),
            "3 v: its map from samples to the world cannot be inverted");
}

class SpecVolumeFaults : public testing::Test {
 protected:
  /// What is said of the path "NAME" in a.json, without the document's place.
  std::string fault_of(const std::string& keys,
                       std::uint64_t memory_bytes = SourceOptions{}.memory_bytes) const {
    const std::string path = folder_.file("a.json", document(keys));
    SourceOptions options;
    options.memory_bytes = memory_bytes;
    const std::string text = error_of_open({path}, options);
    const std::string head = path + ":1:107: /field/path: cannot be read: ";
    if (text.starts_with("2 " + head)) return text.substr(2 + head.size());
    return text.starts_with("6 " + head) ? "limit: " + text.substr(2 + head.size()) : text;
  }
  [[nodiscard]] std::string at(std::string_view name) const { return folder_.path(name); }

  Folder folder_;
};

TEST_F(SpecVolumeFaults, OfRawData) {
  static_cast<void>(folder_.file("v.raw", counting_bytes(12)));
  static_cast<void>(folder_.file("v.dat", counting_bytes(12)));
  const std::string fault =
      ": does not say what volume it is; give raw data a NRRD header (.nhdr) and name that";
  EXPECT_EQ(fault_of(R"("v.raw")"), at("v.raw") + fault);
  EXPECT_EQ(fault_of(R"("v.dat")"), at("v.dat") + fault);
  EXPECT_EQ(fault_of(R"("v.*")"), at("v.*") + fault);
}

TEST_F(SpecVolumeFaults, OfGrids) {
  static_cast<void>(folder_.file("v.nrrd", nrrd("")));
  EXPECT_EQ(fault_of(R"("v.nrrd", "grid": "density")"),
            at("v.nrrd") + ": NRRD has no grids by name; leave out \"grid\"");
}

#if MC_WITH_VDB
TEST_F(SpecVolumeFaults, OfSeveralGrids) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  for (const char* name : {"density", "heat", "density"}) {
    grids.push_back(test::noise_grid<openvdb::FloatGrid>(0));
    grids.back()->setName(name);
  }
  test::write_grids(at("v.vdb"), grids);
  EXPECT_EQ(fault_of(R"("v.vdb")"),
            at("v.vdb") +
                R"(: holds several grids: "density[0]", "heat", "density[1]"; name one as "grid")");
  EXPECT_EQ(fault_of(R"("v.vdb", "grid": "heat")"), "no error");
}
#endif

TEST_F(SpecVolumeFaults, OfKeys) {
  static_cast<void>(folder_.file("v.nrrd", nrrd("")));
  const std::string head = "2 " + at("a.json") + ":1:";
  EXPECT_EQ(fault_of(R"("v.nrrd", "outside": "far")"),
            head + "128: /field/outside: is \"far\": expected a number within +-3.4e38 (float32)");
  EXPECT_EQ(fault_of(R"("v.nrrd", "filter": "cubic")"),
            head + "127: /field/filter: is \"cubic\": expected one of \"nearest\", \"linear\"");
  EXPECT_EQ(fault_of(R"("v.nrrd", "size": 3)"),
            head +
                "117: /field/size: unknown key of a node of type \"volume\"; expected one of "
                "\"type\", \"path\", \"grid\", \"outside\", \"filter\"");
}

TEST_F(SpecVolumeFaults, OfWhatIsNoVolume) {
  static_cast<void>(folder_.file("m.ply", "ply\n"));
  EXPECT_EQ(fault_of(R"("m.ply")"), at("m.ply") + ": a mesh, but a volume was expected");
  static_cast<void>(folder_.file("cut.nrrd", nrrd("").substr(0, 70)));
  EXPECT_TRUE(fault_of(R"("cut.nrrd")").starts_with(at("cut.nrrd")));
}

TEST_F(SpecVolumeFaults, OfTooManySamples) {
  static_cast<void>(folder_.file("b.json", R"({"format": "mc-volume", "version": 1,
      "grid": {"samples": [1000000000, 1000, 2]}, "field": 1})"));
  const std::string fault =
      "limit: " + at("b.json") + ": brings the samples that this document reads above ";
  const std::string remedy = "; raise --memory, of which they may take half";
  EXPECT_EQ(fault_of(R"("b.json")"), fault + "134217728" + remedy);
  EXPECT_EQ(fault_of(R"("b.json")", std::uint64_t{1} << 40), fault + "268435456");
}

TEST_F(SpecVolumeFaults, OfTooLittleMemory) {
  static_cast<void>(folder_.file("v.nrrd", nrrd("")));
  EXPECT_EQ(fault_of(R"("v.nrrd")", 2 * 12 * sizeof(float)), "no error");
  EXPECT_EQ(fault_of(R"("v.nrrd")", 2 * 11 * sizeof(float)),
            "limit: " + at("v.nrrd") +
                ": brings the samples that this document reads above 11; raise --memory, of which "
                "they may take half");
  // A document in a document has what is left.
  static_cast<void>(folder_.file("c.json", document(R"("v.nrrd")")));
  EXPECT_EQ(fault_of(R"("c.json")", 2 * 12 * sizeof(float)), "no error");
}

TEST(SpecVolume, SaysWhatItHolds) {
  const Folder folder;
  static_cast<void>(folder.file("v.nrrd", nrrd("")));
  const Source source = test::open({folder.file("a.json", document(R"("v.nrrd")"))});
  EXPECT_EQ(test::slabs(source).held_bytes(), 12 * sizeof(float));
}

TEST_F(SpecVolumeFaults, OfRings) {
  EXPECT_EQ(fault_of(R"("a.json")"),
            at("a.json") + ": closes a ring of documents; name volumes that do not need this one");
  std::filesystem::create_directory(at("x"));
  static_cast<void>(folder_.file("b.json", document(R"("x/../c.json")")));
  static_cast<void>(folder_.file("c.json", document(R"("a.json")")));
  const std::string again = ":1:107: /field/path: cannot be read: ";
  EXPECT_EQ(fault_of(R"("b.json")"),
            at("b.json") + again + at("x/../c.json") + again + at("x/../a.json") +
                ": closes a ring of documents; name volumes that do not need this one");
}

TEST_F(SpecVolumeFaults, OfDocumentsInDocuments) {
  for (int n = 1; n < 9; ++n) {
    const std::string next = "\"" + std::to_string(n + 1) + ".json\"";
    static_cast<void>(folder_.file(std::to_string(n) + ".json", document(next)));
  }
  static_cast<void>(folder_.file("9.json", document("\"v.nrrd\"")));
  static_cast<void>(folder_.file("v.nrrd", nrrd("spacings: 1 1 1\n")));
  EXPECT_EQ(samples_of(folder_.path("2.json")), counting(12));
  EXPECT_TRUE(error_of_open({folder_.path("1.json")})
                  .ends_with(at("9.json") + ": is one more than the 8 documents that may stand in "
                                            "each other; sample one of them to a file"));
}

TEST_F(SpecVolumeFaults, OfTheDocumentInside) {
  static_cast<void>(folder_.file("b.json", "{\"format\": 1}"));
  EXPECT_TRUE(fault_of(R"("b.json")").starts_with(at("b.json") + ":1:"));
}

}  // namespace
}  // namespace mc
