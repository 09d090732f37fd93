// SPDX-License-Identifier: MIT
#include "cli/arguments/values.hpp"
#include "base/machine_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/usage_error.hpp"

namespace mc::cli {
namespace {

using testing::ElementsAre;
using tests::usage_error;

TEST(Values, ReadsNumbersInTheCLocale) {
  EXPECT_EQ(parse_number("--iso", "-300.5"), -300.5);
  EXPECT_EQ(parse_number("--iso", "+2e3"), 2000);
  EXPECT_EQ(parse_number("--iso", ".5"), 0.5);
}

TEST(Values, RefusesWhatIsNoNumber) {
  EXPECT_EQ(usage_error([] { parse_number("--iso", "1,5x"); }), "--iso: '1,5x' is no number");
  EXPECT_EQ(usage_error([] { parse_number("--iso", ""); }), "--iso: '' is no number");
  EXPECT_EQ(usage_error([] { parse_number("--iso", "+-1"); }), "--iso: '+-1' is no number");
  EXPECT_EQ(usage_error([] { parse_number("--iso", "inf"); }),
            "--iso: 'inf' is not finite: expected a number");
  EXPECT_EQ(usage_error([] { parse_number("--iso", "1e999"); }),
            "--iso: '1e999' does not fit a double");
}

TEST(Values, NamesTheRange) {
  EXPECT_EQ(usage_error([] { parse_number_within("--min-edge", "0.6", 0, 0.5); }),
            "--min-edge: 0.6 is out of range: expected 0 to 0.5");
  EXPECT_EQ(usage_error([] { parse_integer("--threads", "0", 1, 4096); }),
            "--threads: 0 is out of range: expected 1 to 4096");
  EXPECT_EQ(usage_error([] { parse_integer("--skip", "99999999999999999999", 0, 10); }),
            "--skip: 99999999999999999999 is out of range: expected 0 to 10");
  EXPECT_EQ(usage_error([] { parse_integer("--skip", "1.5", 0, 10); }),
            "--skip: '1.5' is no whole number");
}

TEST(Values, ReadsVectors) {
  EXPECT_EQ(parse_vector("--origin", "-1,-2.5,+3"), (Vec3{-1, -2.5, 3}));
  EXPECT_EQ(usage_error([] { parse_vector("--origin", "1,2"); }),
            "--origin: '1,2' has 2 numbers: expected three, X,Y,Z");
}

TEST(Values, ReadsRegions) {
  EXPECT_EQ(parse_region("--region", "-8,0,1:7,1,2"), (IndexBox{{-8, 0, 1}, {7, 1, 2}}));
  EXPECT_EQ(usage_error([] { parse_region("--region", "0,0,0:3,0,3"); }),
            "--region: 0..0 along j is too short (1): expected at least 2 samples; both ends are "
            "inclusive");
  EXPECT_EQ(usage_error([] { parse_region("--region", "0,0,0"); }),
            "--region: '0,0,0' is no region: expected I0,J0,K0:I1,J1,K1");
}

TEST(Values, ReadsAndShowsSizes) {
  EXPECT_EQ(parse_size("--memory", "512MiB"), 512ULL << 20);
  EXPECT_EQ(parse_size("--memory", "2G"), 2ULL << 30);
  EXPECT_EQ(parse_size("--memory", "100"), 100U);
  EXPECT_EQ(usage_error([] { parse_size("--memory", "12 parsecs"); }),
            "--memory: '12 parsecs' is no size: expected a whole number and B, KiB, MiB or GiB");
  EXPECT_EQ(usage_error([] { parse_size("--memory", "99999999999TiB"); }),
            "--memory: '99999999999TiB' is no size: expected a whole number and B, KiB, MiB or "
            "GiB");
  EXPECT_EQ(base::size_text(1000), "1000 B");
  EXPECT_EQ(base::size_text(1536), "1.5 KiB");
}

TEST(Values, SplitsKeepingEmptyParts) {
  EXPECT_THAT(split("a,,b", ','), ElementsAre("a", "", "b"));
  EXPECT_THAT(split("", ','), ElementsAre(""));
}

TEST(Values, FindsTheNearestName) {
  const std::vector<std::string_view> known{"extract", "sample", "info", "check"};
  EXPECT_EQ(nearest_name("extrakt", known), "extract");
  EXPECT_EQ(nearest_name("chekc", known), "check");
  EXPECT_EQ(nearest_name("xyzzy", known), "");
}

}  // namespace
}  // namespace mc::cli
