// SPDX-License-Identifier: MIT
#include "cli/arguments/format_lists.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/messages/help.hpp"
#include "convert/chunk_writer.hpp"

namespace mc::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FormatLists, ComeInTheOrderOfTheRows) {
  EXPECT_THAT(mesh_names(), ElementsAre("ply", "obj", "stl", "glb", "gltf"));
  EXPECT_THAT(volume_names(), ElementsAre("vdb", "nrrd", "raw", "exr", "png"));
  EXPECT_THAT(sink::picture_names({}), ElementsAre("png", "exr"));
  EXPECT_THAT(sink::several_object_names(), ElementsAre("glb", "gltf", "obj"));
  EXPECT_EQ(sink::dotted(sink::picture_names({})), ".png or .exr");
  EXPECT_EQ(joined(source_names()), "vdb raw nrrd spec exr png");
  EXPECT_EQ(conversion::chunk_format().name, "glb");
}

TEST(FormatLists, HelpKnowsEveryExtension) {
  const auto expect_all = [](std::string_view extensions) {
    std::istringstream words{std::string(extensions)};
    for (std::string word; words >> word;) {
      EXPECT_THAT(std::string(topic_text("formats")), HasSubstr("." + word));
    }
  };
  for (const SourceFormat* format : source_formats()) {
    if (format->open != nullptr) expect_all(format->extensions);
  }
  for (const SinkFormat* format : sink_formats()) expect_all(format->extensions);
}

}  // namespace
}  // namespace mc::cli
