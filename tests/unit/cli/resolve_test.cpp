// SPDX-License-Identifier: MIT
#include "cli/arguments/resolve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/arguments/command_line.hpp"
#include "support/usage_error.hpp"

namespace mc::cli {
namespace {

using testing::ElementsAre;
using tests::usage_error;

ExtractArgs parsed(std::vector<std::string> words) {
  ExtractArgs args;
  args.common.typed = words;
  parse_words("extract", options_of(args), &args.source.inputs, std::move(words));
  return args;
}

ExtractPlan plan_of(std::vector<std::string> words) { return resolve(parsed(std::move(words))); }

/// What resolve() says of "v.vdb -o m.ply" with these words added.
std::string refused(std::vector<std::string> words) {
  words.insert(words.begin(), {"v.vdb", "-o", "m.ply"});
  return usage_error([&] { plan_of(words); });
}

TEST(CommandLine, TakesNegativeNumbersAsValues) {
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"--iso", "-300.5", "v.vdb"}, {"--iso=-300.5", "v.vdb"}, {"v.vdb", "--iso", "-300.5"}}) {
    const ExtractArgs args = parsed(words);
    EXPECT_EQ(args.surface.iso, "-300.5");
    EXPECT_THAT(args.source.inputs, ElementsAre("v.vdb"));
  }
  EXPECT_EQ(parsed({"--origin", "-1,-2,-3", "v.vdb"}).source.origin, "-1,-2,-3");
}

TEST(CommandLine, TakesAnyNameAsInput) {
  EXPECT_THAT(parsed({"check", "-", "info"}).source.inputs, ElementsAre("check", "-", "info"));
  EXPECT_THAT(parsed({"--", "--iso", "-x"}).source.inputs, ElementsAre("--iso", "-x"));
  EXPECT_EQ(parsed({"v.vdb", "-o", "-"}).output, "-");
}

TEST(CommandLine, CountsFlags) {
  const ExtractArgs args = parsed({"-vv", "-q", "--force", "v.vdb"});
  EXPECT_EQ(args.common.verbose, 2);
  EXPECT_EQ(args.common.quiet, 1);
  EXPECT_TRUE(args.out.force);
  EXPECT_FALSE(args.out.ascii);
}

TEST(CommandLine, RefusesInOurWords) {
  EXPECT_EQ(usage_error([] {
              parsed({"v.vdb", "--isso", "3"});
            }),
            "--isso: unknown option of mc extract; did you mean --iso?");
  EXPECT_EQ(usage_error([] {
              parsed({"v.vdb", "-z"});
            }),
            "-z: unknown option of mc extract; see mc extract --help");
  EXPECT_EQ(usage_error([] { parsed({"v.vdb", "--iso"}); }), "--iso: no value: expected V[,V...]");
  EXPECT_EQ(usage_error([] {
              parsed({"v.vdb", "--iso=", "3"});
            }),
            "--iso: no value: expected V[,V...]");
  EXPECT_EQ(usage_error([] {
              parsed({"v.vdb", "--iso", "1", "--iso", "2"});
            }),
            "--iso: given more than once: expected one value");
  EXPECT_EQ(usage_error([] { parsed({"v.vdb", "--force=yes"}); }), "--force: takes no value");
}

TEST(CommandLine, QuotesForAShell) {
  EXPECT_EQ(shell_text(std::vector<std::string>{"a b.raw", "--dims", "2,2,2", "it's", ""}),
            "'a b.raw' --dims 2,2,2 'it'\\''s' ''");
}

TEST(Resolve, FillsDefaults) {
  const ExtractPlan plan = plan_of({"v.vdb", "-o", "m.ply"});
  EXPECT_EQ(plan.format, "ply");
  EXPECT_TRUE(plan.convert.surface.isos.empty());
  EXPECT_FALSE(plan.convert.surface.inside);
  EXPECT_FALSE(plan.convert.surface.border);
  EXPECT_FALSE(plan.convert.normals);
  EXPECT_EQ(plan.convert.extract.min_edge, 1.0 / 1024);
  EXPECT_FALSE(plan.convert.extract.measure);
  ASSERT_EQ(plan.jobs.size(), 1U);
  EXPECT_EQ(plan.jobs[0].output, "m.ply");
  EXPECT_FALSE(plan_of({"v.vdb", "-o", "m.stl"}).convert.normals);
}

TEST(Resolve, ReadsIsoLists) {
  const ExtractPlan plan = plan_of({"v.vdb", "-o", "m.glb", "--iso", "-1.5,otsu,p99.5"});
  ASSERT_EQ(plan.convert.surface.isos.size(), 3U);
  EXPECT_EQ(plan.convert.surface.isos[0].value, -1.5);
  EXPECT_EQ(plan.convert.surface.isos[1].kind, IsoChoice::Kind::otsu);
  EXPECT_EQ(plan.convert.surface.isos[2].kind, IsoChoice::Kind::percentile);
  EXPECT_EQ(plan.convert.surface.isos[2].value, 99.5);
}

TEST(Resolve, TakesRulesForComponents) {
  const auto rule = [](const char* text) {
    return plan_of({"v.vdb", "-o", "m.ply", "--keep", text}).convert.keep;
  };
  EXPECT_EQ(rule("largest"), KeepRule{});
  EXPECT_EQ(rule("12"), (KeepRule{.n = 12}));
  EXPECT_EQ(rule("volume>=1.5"), (KeepRule{.by = KeepRule::By::volume, .min_size = 1.5}));
  EXPECT_EQ(rule("area>=0"), (KeepRule{.by = KeepRule::By::area}));
  EXPECT_FALSE(plan_of({"v.vdb", "-o", "m.ply"}).convert.keep);
}

TEST(Resolve, TakesGoalsOfSimplification) {
  const auto goal = [](const char* text) {
    return plan_of({"v.vdb", "-o", "m.ply", "--simplify", text}).convert.simplify;
  };
  using By = SimplifyGoal::By;
  EXPECT_EQ(goal("ratio=0.25"), (SimplifyGoal{.by = By::ratio, .ratio = 0.25}));
  EXPECT_EQ(goal("count=100000"), (SimplifyGoal{.by = By::count, .count = 100'000}));
  EXPECT_EQ(goal("error=0.1"), (SimplifyGoal{.by = By::error, .error = 0.1}));
  EXPECT_FALSE(plan_of({"v.vdb", "-o", "m.ply"}).convert.simplify);
}

TEST(Resolve, RefusesValues) {
  EXPECT_EQ(refused({"--simplify", "0.5"}),
            "--simplify: unknown value '0.5': expected ratio=R, count=N or error=E");
  EXPECT_EQ(refused({"--simplify", "ratio=2"}), "--simplify: 2 is out of range: expected 0 to 1");
  EXPECT_EQ(refused({"--simplify", "count=-1"}),
            "--simplify: -1 is out of range: expected 0 to 9223372036854775807");
  EXPECT_EQ(refused({"--simplify", "error=x"}), "--simplify: 'x' is no number");
  EXPECT_EQ(refused({"--keep", "smallest"}),
            "--keep: unknown value 'smallest': expected largest, a number, volume>=X or area>=X");
  EXPECT_EQ(refused({"--keep", "0"}),
            "--keep: 0 is out of range: expected 1 to 9223372036854775807");
  EXPECT_EQ(refused({"--keep", "volume>=-1"}), "--keep: -1 is out of range: expected 0 or more");
  EXPECT_EQ(refused({"--keep", "area>=x"}), "--keep: 'x' is no number");
  EXPECT_EQ(refused({"--iso", "otsi"}),
            "--iso: unknown value 'otsi': expected a number, otsu or pNN");
  EXPECT_EQ(refused({"--iso", "p101"}), "--iso: 101 is out of range: expected 0 to 100");
  EXPECT_EQ(refused({"--iso", "1,2"}),
            "--iso: 2 values, but ply holds one object a file; choose glb, gltf or obj, or extract "
            "them one by one");
  EXPECT_EQ(refused({"--border", "opne"}),
            "--border: unknown value 'opne': expected open or closed; did you mean open?");
  EXPECT_EQ(refused({"--topology", "trilinear"}),
            "--topology: trilinear is unknown to this version: expected faces");
  EXPECT_EQ(refused({"--min-edge", "0.75"}), "--min-edge: 0.75 is out of range: expected 0 to 0.5");
  EXPECT_EQ(refused({"--cutoff", "-1"}), "--cutoff: -1 is out of range: expected 0 or more");
  EXPECT_EQ(refused({"--type", "u128", "--dims", "2,2,2"}),
            "--type: unknown value 'u128': expected u8, i8, u16, i16, u32, i32, f16, f32 or f64; "
            "did you mean u8?");
  EXPECT_EQ(refused({"--type", "u8", "--dims", "2,1,2"}),
            "--dims: 1 is out of range: expected 2 to 2147483647");
  EXPECT_EQ(refused({"--type", "f64", "--dims", "2147483647,2147483647,2147483647"}),
            "--dims: the volume has more than 2^63 bytes; check the numbers");
  EXPECT_EQ(refused({"--spacing", "1,0,1"}), "--spacing: 0 is out of range: expected more than 0");
}

TEST(Resolve, RefusesContradictions) {
  EXPECT_EQ(refused({"--dims", "2,2,2"}),
            "--type: missing: raw data needs --dims and --type; give --type u8, i8, u16, i16, u32, "
            "i32, f16, f32 or f64");
  EXPECT_EQ(refused({"--endian", "big"}),
            "--endian: is for raw data: expected --dims and --type with it");
  EXPECT_EQ(refused({"--from", "vdb", "--type", "u8", "--dims", "2,2,2"}),
            "--dims: is for raw data, but --from says vdb");
  EXPECT_EQ(refused({"--frame", "ras", "--up", "z"}),
            "--up: is for sources without a frame, but --frame gives one");
  EXPECT_EQ(refused({"--interpolation", "midpoint", "--cutoff", "1"}),
            "--cutoff: means nothing with --interpolation midpoint");
  EXPECT_EQ(refused({"-q", "-v"}), "--quiet: contradicts --verbose; give one of them");
  EXPECT_EQ(refused({"--out-dir", "d"}), "--out-dir: contradicts --output; give one of them");
  EXPECT_EQ(usage_error([] {
              plan_of({"v.vdb", "-o", "m.glb", "--ascii"});
            }),
            "--ascii: is for ply and stl, not glb");
  EXPECT_EQ(usage_error([] {
              plan_of({"v.vdb", "-o", "m.stl", "--normals", "face"});
            }),
            "--normals: stl holds no vertex normals, only those of its facets; choose ply, obj, "
            "glb or gltf");
  EXPECT_EQ(usage_error([] {
              plan_of({"v.vdb", "-o", "-", "--to", "ply", "--report", "-"});
            }),
            "--report: cannot go to stdout with --output -; give another FILE");
  EXPECT_EQ(usage_error([] {
              plan_of({"-", "v.vdb", "-o", "m.ply"});
            }),
            "-: stdin must be the only input");
}

TEST(Resolve, ShowsTheWholeCommandWhereTheOutputIsMissing) {
  EXPECT_EQ(usage_error([] {
              plan_of({"my scan.raw", "--dims", "2,2,2", "--type", "u8"});
            }),
            "extract: no output: expected -o FILE; for example: mc extract 'my scan.raw' --dims "
            "2,2,2 --type u8 -o 'my scan.glb'");
}

TEST(Resolve, RefusesVolumeFormats) {
  EXPECT_EQ(usage_error([] {
              plan_of({"v.vdb", "-o", "m.nrrd"});
            }),
            "m.nrrd: nrrd holds a volume: expected ply, obj, stl, glb or gltf; use mc sample to "
            "write volumes");
}

TEST(Resolve, NamesTheOutputsOfABatch) {
  const ExtractPlan plan = plan_of({"a/x.vdb", "b/y.vdb", "--out-dir", "d", "--to", "ply"});
  ASSERT_EQ(plan.jobs.size(), 2U);
  EXPECT_EQ(plan.jobs[0].output, "d/x.ply");
  EXPECT_EQ(plan.jobs[1].output, "d/y.ply");
  EXPECT_THAT(plan.jobs[1].inputs, ElementsAre("b/y.vdb"));
  EXPECT_EQ(usage_error([] {
              plan_of({"a/x.vdb", "b/x.vdb", "--out-dir", "d", "--to", "ply"});
            }),
            "--out-dir: a/x.vdb and b/x.vdb would both be written to d/x.ply; convert them one by "
            "one");
}

TEST(Resolve, MeasuresOnlyForAReport) {
  EXPECT_TRUE(plan_of({"v.vdb", "-o", "m.ply", "--report", "r.json"}).convert.extract.measure);
}

}  // namespace
}  // namespace mc::cli
