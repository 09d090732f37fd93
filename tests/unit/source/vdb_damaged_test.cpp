// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_VDB

#include <openvdb/openvdb.h>

#include <chrono>
#include <random>

#include "support/source_files.hpp"
#include "support/vdb_grids.hpp"

// Cut, flipped and lying VDB files: one input error each, and quickly.

namespace mc {
namespace {

using test::error_of_open;
using test::Folder;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string noise_file(const Folder& folder) {
  auto noisy = test::noise_grid<openvdb::FloatGrid>(3);
  auto vec = openvdb::Vec3SGrid::create();
  vec->setName("vel");
  vec->tree().setValueOn({0, 0, 0}, openvdb::Vec3s(1));
  noisy->setName("n");
  noisy->insertMeta("author", openvdb::StringMetadata("nobody"));
  test::write_grids(folder.path("whole.vdb"), {noisy, vec});
  return test::read_bytes(folder.path("whole.vdb"));
}

TEST(VdbDamaged, EveryCutIsAnInputErrorAndQuick) {
  openvdb::initialize();
  const Folder folder;
  const std::string bytes = noise_file(folder);
  for (std::size_t n = 0; n < 50; ++n) {
    // Half of the cuts go through the first KiB, where the headers are.
    const std::size_t at = n < 25 ? 1 + n * 40 : 1001 + (n - 25) * (bytes.size() - 1002) / 24;
    const std::string file = folder.file("cut.vdb", std::string_view(bytes).substr(0, at));
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(error_of_open({file}).substr(0, 2 + file.size()), "3 " + file) << at;
    EXPECT_LT(seconds_since(start), 2.0) << at;
  }
}

TEST(VdbDamaged, FlippedBytesNeverCrash) {
  openvdb::initialize();
  const Folder folder;
  const std::string bytes = noise_file(folder);
  std::mt19937 random(11);
  int n_errors = 0;
  for (int n = 0; n < 120; ++n) {
    std::string flipped = bytes;
    const std::size_t within = n % 2 == 0 ? 1500 : bytes.size();
    flipped[random() % within] = static_cast<char>(random());
    const std::string file = folder.file("flipped.vdb", flipped);
    const auto start = std::chrono::steady_clock::now();
    const std::string error = error_of_open({file});
    EXPECT_TRUE(error == "no error" || error[0] == '3' || error[0] == '6') << error;
    EXPECT_LT(seconds_since(start), 2.0) << n;
    n_errors += error == "no error" ? 0 : 1;
  }
  EXPECT_GT(n_errors, 0);
}

TEST(VdbDamaged, LengthsThatTheFileDoesNotHold) {
  openvdb::initialize();
  const Folder folder;
  std::string bytes = noise_file(folder);
  // The length of the first grid's unique name follows the header, no file metadata, and the count.
  const std::size_t at = bytes.find(std::string("\1\0\0\0n", 5));
  ASSERT_NE(at, std::string::npos);
  bytes[at + 3] = '\x7F';
  const std::string file = folder.file("long.vdb", bytes);
  EXPECT_EQ(error_of_open({file}),
            "3 " + file + ": cut off after " + std::to_string(bytes.size()) +
                " bytes, within the list of grids; fetch or write the file again");
}

}  // namespace
}  // namespace mc

#endif
