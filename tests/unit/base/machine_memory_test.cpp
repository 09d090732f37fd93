// SPDX-License-Identifier: MIT
#include "base/machine_memory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

namespace mc::base {
namespace {

namespace fs = std::filesystem;

/// A folder of control groups.
class Groups : public testing::Test {
 protected:
  void SetUp() override {
    root_ =
        fs::path(testing::TempDir()) /
        ("groups-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  [[nodiscard]] std::uint64_t limit(const std::string& groups) const {
    return group_limit_bytes(groups, root_.string());
  }

 private:
  fs::path root_;
};

constexpr std::uint64_t kNone = ~std::uint64_t{0};

TEST_F(Groups, OfVersion2BoundTheirChildren) {
  write("a/memory.max", "3000000\n");
  write("a/b/memory.max", "max\n");
  write("a/c/memory.max", "2000000\n");
  EXPECT_EQ(limit("0::/a/b\n"), 3000000U);
  EXPECT_EQ(limit("0::/a/c\n"), 2000000U);
  EXPECT_EQ(limit("0::/\n"), kNone);
}

TEST_F(Groups, OfVersion1HaveAFolderForEachController) {
  write("memory/x/memory.limit_in_bytes", "5000000\n");
  write("memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(limit("5:cpu,cpuacct:/x\n4:memory:/x\n0::/\n"), 5000000U);
  EXPECT_EQ(limit("3:hugetlb,memory:/y/z"), 9223372036854771712U);
  EXPECT_EQ(limit("5:cpu:/x\n"), kNone);
}

TEST_F(Groups, OfAContainerAreAtTheRoot) {
  write("memory.max", "7000000\n");
  EXPECT_EQ(limit("0::/docker/0123abcd\n"), 7000000U);
}

TEST_F(Groups, ThatMakeNoSenseAreNoLimit) {
  for (const char* text : {"", "\n\n", "::", "nonsense", "4:memory:", "0:::/../..\n"}) {
    EXPECT_EQ(limit(text), kNone) << text;
  }
}

TEST(MachineMemory, IsWhatTheDefaultBudgetIsAQuarterOf) {
  EXPECT_GT(machine_bytes(), 1U << 20U);
  EXPECT_LE(default_budget_bytes(), 1U << 30U);
  EXPECT_LE(default_budget_bytes(), machine_bytes() / 4);
}

TEST(MachineMemory, CountsWhatIsTouched) {
  constexpr std::size_t kBytes = 64U << 20U;
  const std::uint64_t before = resident_bytes();
  std::vector<char> touched(kBytes, 1);
  EXPECT_GT(resident_bytes(), before + kBytes / 2);
  EXPECT_EQ(touched.back(), 1);
}

}  // namespace
}  // namespace mc::base
