// SPDX-License-Identifier: MIT
#include "source/script/script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "fuzz/replay_script.hpp"
#include "mc/base.hpp"
#include "source/mapped_file.hpp"
#include "support/places.hpp"

// The mc-edits reader: what scripts mean.

namespace mc::tests {
namespace {

using source::RecordKind;
using source::Script;
using source::ScriptRecord;
using testing::ElementsAre;

const std::string kHeader = R"({"format": "mc-edits", "version": 1})"
                            "\n";

std::vector<ScriptRecord> records_of(const std::string& text) {
  Script script("e.jsonl", text);
  std::vector<ScriptRecord> records;
  while (auto record = script.next()) records.push_back(std::move(*record));
  return records;
}

Edit edit_of(const std::string& line) {
  const auto records = records_of(kHeader + line);
  EXPECT_EQ(records.size(), 1U);
  return records.empty() ? Edit{} : records.front().edit;
}

std::vector<std::string> faults_of(const std::string& text) {
  try {
    Script script("e.json", text);
    script.check([](const ScriptRecord&) {});
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.lines();
  }
}

TEST(Script, AddIsSoftAndOfStrengthOne) {
  const Edit edit =
      edit_of(R"({"op":"add","shape":{"type":"sphere","center":[1,2,3],"radius":4}})");
  EXPECT_EQ(edit.op, EditOp::add);
  EXPECT_EQ(edit.shape.center, (Vec3{1, 2, 3}));
  EXPECT_EQ(edit.shape.radius, 4);
  EXPECT_EQ(edit.falloff.type, FalloffType::smoothstep);
  EXPECT_EQ(edit.falloff.inner, 0);
  EXPECT_EQ(edit.strength, 1);
  EXPECT_EQ(edit.steps, 1U);
  EXPECT_FALSE(edit.path || edit.mirror || edit.radial || edit.mask);
}

TEST(Script, CsgHasNoFalloff) {
  const Edit edit = edit_of(
      R"({"op":"subtract","blend":"csg","smooth":1.5,"shape":{"type":"box","center":[90,10,90],)"
      R"("size":[8,4,8],"rotate":[0,90,0]},"mirror":"x"})");
  EXPECT_EQ(edit.blend, Blend::csg);
  EXPECT_EQ(edit.smooth, 1.5);
  EXPECT_EQ(edit.falloff.type, FalloffType::none);
  EXPECT_EQ(edit.shape.size, (Vec3{8, 4, 8}));
  EXPECT_EQ(edit.shape.turn.m, (std::array<double, 9>{0, 0, 1, 0, 1, 0, -1, 0, 0}));
  ASSERT_TRUE(edit.mirror);
  EXPECT_EQ(edit.mirror->axes, (std::array<bool, 3>{true, false, false}));
}

TEST(Script, RateTimesDurationIsSteps) {
  const auto records =
      records_of(R"({"format":"mc-edits","version":1,"dt":0.02,"clamp":[0,1]})"
                 "\n"
                 R"({"op":"add","shape":{"type":"sphere","radius":1},"rate":2,"duration":0.5})");
  EXPECT_EQ(records[0].edit.steps, 25U);
  EXPECT_DOUBLE_EQ(records[0].edit.strength, 0.04);
  EXPECT_EQ(records[0].edit.clamp, (std::array<double, 2>{0, 1}));
}

TEST(Script, DefaultsAreTakenWhereARecordSaysNothing) {
  const auto records = records_of(
      R"({"format":"mc-edits","version":1,"defaults":{"falloff":"hard","strength":3,"mirror":"xz",)"
      R"("iterations":7}})"
      "\n"
      R"({"op":"add","shape":{"type":"sphere","radius":1}})"
      "\n"
      R"({"op":"add","shape":{"type":"sphere","radius":1},"rate":1,"duration":1,"falloff":"tip"})"
      "\n"
      R"({"op":"fill","value":1})"
      "\n");
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0].edit.falloff.type, FalloffType::hard);
  EXPECT_EQ(records[0].edit.strength, 3);
  EXPECT_TRUE(records[0].edit.mirror);
  EXPECT_EQ(records[0].text,
            R"({"op":"add","shape":{"type":"sphere","radius":1},"falloff":"hard","mirror":"xz",)"
            R"("strength":3})");
  EXPECT_EQ(records[1].edit.falloff.type, FalloffType::tip);
  EXPECT_EQ(records[1].edit.steps, 50U);
  EXPECT_EQ(records[2].text, R"({"op":"fill","value":1})");
}

TEST(Script, ARecordsDurationTakesTheDefaultRate) {
  const auto records =
      records_of(R"({"format":"mc-edits","version":1,"dt":0.1,"defaults":{"rate":2,"duration":1}})"
                 "\n"
                 R"({"op":"add","shape":{"type":"sphere","radius":1},"duration":0.5})"
                 "\n"
                 R"({"op":"add","shape":{"type":"sphere","radius":1},"strength":7})");
  EXPECT_EQ(records[0].edit.steps, 5U);
  EXPECT_DOUBLE_EQ(records[0].edit.strength, 0.2);
  EXPECT_EQ(records[1].edit.steps, 1U);
  EXPECT_EQ(records[1].edit.strength, 7);
}

TEST(Script, AStampLiesWhereItsPlaceSays) {
  const std::string file = test::source_file("data/scripts/crater.json");
  const Edit edit = edit_of(R"({"op":"stamp","file":")" + file +
                            R"(","translate":[10,20,30],"scale":[2,4,8],"rotate":[0,0,90],)"
                            R"("pivot":[1,0,0],"carve":true})");
  EXPECT_EQ(edit.blend, Blend::csg);
  EXPECT_EQ(edit.falloff.type, FalloffType::none);
  EXPECT_TRUE(edit.stamp_carves && edit.stamp_above);
  ASSERT_TRUE(edit.stamp);
  // The pivot comes to lie at translate; a step along x of the stamp is now one along y, twice as
  // long.
  const auto index_of = [&](const Vec3& p) { return edit.stamp_to_index(p); };
  const Vec3 pivot = index_of({10, 20, 30});
  EXPECT_NEAR(pivot[0], (1 + 2.4) / 0.1, 1e-9);
  EXPECT_NEAR(pivot[1], 1.6 / 0.1, 1e-9);
  EXPECT_NEAR(pivot[2], 2.4 / 0.1, 1e-9);
  const Vec3 along = index_of({10, 22, 30});
  EXPECT_NEAR(along[0] - pivot[0], 10, 1e-9);
  EXPECT_NEAR(along[1] - pivot[1], 0, 1e-9);
}

TEST(Script, StampsOfOneFileShareItsSamples) {
  const std::string record = R"({"op":"stamp","file":")" +
                             test::source_file("data/scripts/crater.json") + R"(","translate":[)";
  const auto records = records_of(kHeader + record + "1,2,3]}\n" + record + "4,5,6]}\n");
  EXPECT_EQ(records[0].edit.stamp, records[1].edit.stamp);
  EXPECT_NE(records[0].edit.stamp_to_index({}), records[1].edit.stamp_to_index({}));
}

TEST(Script, ADocumentAndItsLinesMeanTheSame) {
  const std::string one = R"({"op":"group","name":"eye","edits":[{"op":"fill","value":2},)"
                          R"({"op":"revert","shape":{"type":"plane"}}]})";
  const std::string two = R"({"op":"undo","count":3})";
  const std::string three = R"({"op":"write","path":"a{n}.ply"})";
  const auto lines = records_of(kHeader + one + "\n\n" + two + "\r\n" + three);
  const auto document = records_of(R"({"format":"mc-edits","version":1,"edits":[)"
                                   "\n" +
                                   one + ",\n" + two + "," + three + "]}\n");
  for (const auto& records : {lines, document}) {
    ASSERT_EQ(records.size(), 3U);
    EXPECT_EQ(records[0].kind, RecordKind::group);
    EXPECT_EQ(records[0].name, "eye");
    ASSERT_EQ(records[0].members.size(), 2U);
    EXPECT_EQ(records[0].members[0].edit.value, 2);
    EXPECT_EQ(records[0].text, one);
    EXPECT_EQ(records[1].kind, RecordKind::undo);
    EXPECT_EQ(records[1].count, 3U);
    EXPECT_EQ(records[2].path, "a{n}.ply");
    EXPECT_EQ(records[2].number, 3U);
  }
}

TEST(Script, NamedNodesServeEveryRecord) {
  const auto records = records_of(
      R"({"format":"mc-edits","version":1,"seed":4,"nodes":{"bumps":{"type":"perlin"}}})"
      "\n"
      R"({"op":"noise","noise":"bumps","shape":{"type":"sphere","radius":1},"mask":0.5})"
      "\n"
      R"({"op":"add","shape":{"type":"node","field":{"type":"torus","radius":2,"tube":1},)"
      R"("bounds":[[-3,-1,-3],[3,1,3]],"center":[5,5,5]}})");
  EXPECT_TRUE(records[0].edit.noise);
  EXPECT_TRUE(records[0].edit.mask);
  EXPECT_TRUE(records[1].edit.shape.field);
  EXPECT_EQ(records[1].edit.shape.bounds[1], (Vec3{3, 1, 3}));
}

TEST(Script, ABadRecordLeavesThoseAfterItReadable) {
  const std::string text = kHeader + "{\"op\":\"fill\"}\n{\"op\":\"fill\",\"value\":1}\n";
  Script script("e.jsonl", text);
  try {
    script.next();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "e.jsonl:2:1: record 1: has no \"value\": a record of op \"fill\" needs it");
  }
  EXPECT_EQ(script.next()->number, 2U);
  EXPECT_FALSE(script.next());
}

TEST(Script, AllFaultsOfAllLinesComeTogether) {
  EXPECT_THAT(
      faults_of(kHeader + "{\"op\":\"fill\"}\n{\"op\":\"fill\",\"value\":1}\n{\"op\":\n"
                          "{\"op\":\"undo\",\"count\":0, \"cuont\":1}"),
      ElementsAre("e.json:2:1: record 1: has no \"value\": a record of op \"fill\" needs it",
                  "e.json:4:7: record 3: not valid JSON: the text ends before it is complete",
                  "e.json:5:22: record 4: /count: is 0: expected an integer from 1 to 1000000000",
                  "e.json:5:25: record 4: /cuont: unknown key of a record of op \"undo\"; did you "
                  "mean \"count\"?"));
}

TEST(Script, AtMostTwentyFaultsAreTold) {
  std::string lines = kHeader;
  for (int n = 0; n < 30; ++n) lines += "{\"op\":\"fill\"}\n";
  const auto faults = faults_of(lines);
  ASSERT_EQ(faults.size(), 20U);
  EXPECT_EQ(faults.back(), "e.json: more faults; correct those above first");
}

TEST(Script, FaultsOfTheHeaderAndOfRecordsComeTogether) {
  EXPECT_THAT(
      faults_of(R"({"format":"mc-edits","version":2,"edits":[{"op":"fill"}]})"),
      ElementsAre("e.json:1:32: /version: is 2: expected 1",
                  "e.json:1:43: /edits/0: has no \"value\": a record of op \"fill\" needs it"));
}

TEST(Script, TextAfterADocumentIsAFault) {
  EXPECT_THAT(faults_of(R"({"format":"mc-edits","version":1,"edits":[]})"
                        "\n{}"),
              ElementsAre("e.json:2:1: text after the end of the document: expected nothing more"));
}

TEST(Script, OnlyAJournalMayEndTorn) {
  const std::string torn = R"({"op":"fill","value":1})"
                           "\n"
                           R"({"op":"fill","va)";
  EXPECT_EQ(faults_of(kHeader + torn).size(), 1U);
  const std::string text = R"({"format":"mc-edits","version":1,"journal":true})"
                           "\n" +
                           torn;
  Script journal("j.jsonl", text);
  EXPECT_TRUE(journal.next());
  EXPECT_FALSE(journal.next());
  EXPECT_EQ(journal.torn(), "j.jsonl:3");
}

TEST(Script, AJournalsHeaderNamesItsFolder) {
  Script script("/tmp/x/e.json", R"({"format":"mc-edits","version":1,"x-who":1,"dt":0.5,)"
                                 R"("defaults":{"falloff":"hard"},"space":"index"})");
  EXPECT_EQ(script.journal_header(),
            R"({"format":"mc-edits","version":1,"journal":true,"folder":"/tmp/x","dt":0.5,)"
            R"("space":"index"})");
}

TEST(Script, HashesAreSixteenDigits) {
  const auto records = records_of(
      kHeader +
      R"({"op":"fill","value":1,"before":"00000000000000ff","after":"ffffffffffffffff"})");
  EXPECT_EQ(records[0].before, 255U);
  EXPECT_EQ(records[0].after, ~std::uint64_t{0});
  EXPECT_EQ(records[0].text, R"({"op":"fill","value":1})");
}

TEST(Script, WritesCount) {
  EXPECT_EQ(source::path_of_write("step-{n:04}.glb", 7), "step-0007.glb");
  EXPECT_EQ(source::path_of_write("a{n}b{n:02}", 123), "a123b123");
  EXPECT_EQ(source::path_of_write("{m}{n:4}{n", 1), "{m}{n:4}{n");
}

TEST(Script, CorpusIsReplayed) {
  namespace fs = std::filesystem;
  int n_texts = 0;
  for (const auto& entry : fs::directory_iterator(test::source_file("data/corpus/script"))) {
    const std::string name = entry.path().filename().string();
    const source::MappedFile file(entry.path().string());
    EXPECT_EQ(replay_script(file.text()), name.starts_with("good-")) << name;
    ++n_texts;
  }
  EXPECT_GT(n_texts, 25);
}

/// The document's fault, and the text of it.
struct Fault {
  const char* record;
  const char* text;
};

TEST(Script, EveryFaultIsWorded) {
  const Fault kFaults[] = {
#include "unit/source/script_faults.inc"
  };
  for (const Fault& fault : kFaults) {
    const std::string document = R"({"format": "mc-edits", "version": 1, "x-": 0, "edits": [)" +
                                 std::string(fault.record) + "]}";
    EXPECT_THAT(faults_of(document), ElementsAre(fault.text)) << document;
  }
}

}  // namespace
}  // namespace mc::tests
