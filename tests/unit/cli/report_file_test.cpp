// SPDX-License-Identifier: MIT
#include "cli/messages/report_file.hpp"

#include <gtest/gtest.h>

#include "cli/invocation.hpp"
#include "support/source_files.hpp"

namespace mc::cli {
namespace {

using test::Folder;
using test::read_bytes;

TEST(ReportFile, OfARunThatIsAskedToStopIsNotMade) {
  const Folder folder;
  const std::string volume =
      folder.file("v.raw", std::string(13, '\0') + '\1' + std::string(13, '\0'));
  const std::string report = folder.file("r.json", "old");
  const std::vector<std::string> words{
      volume,     "--dims", "3,3,3", "--type", "u8", "--iso", "0.5", "-o", folder.path("m.obj"),
      "--report", report,   "-q"};
  Invocation stopped;
  stopped.stop.request_stop();
  run_extract(stopped, words);
  EXPECT_EQ(read_bytes(report), "old");
  EXPECT_FALSE(std::filesystem::exists(folder.path("m.obj")));

  Invocation free;
  EXPECT_EQ(run_extract(free, words), 0);
  EXPECT_EQ(read_bytes(report).substr(0, 7), R"({"mc":")");
  EXPECT_TRUE(std::filesystem::exists(folder.path("m.obj")));
}

}  // namespace
}  // namespace mc::cli
