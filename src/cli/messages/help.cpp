// SPDX-License-Identifier: MIT
#include "cli/messages/help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text.hpp"
#include "cli/arguments/args.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/values.hpp"
#include "cli/invocation.hpp"
#include "mc/base.hpp"

// One page a command: usage, what it does, options from the table, examples.

namespace mc::cli {

namespace {

struct Page {
  std::string_view name;
  std::string_view usage;
  std::string_view summary;
  std::string_view text;
  std::string_view examples;
};

constexpr std::array<Page, 7> kPages{{
    {"extract", "mc extract INPUT... -o OUTPUT", "volume to triangle mesh",
     "Meshes the surface where the values of a volume pass --iso. INPUT is a VDB or NRRD\n"
     "file, a mc-volume spec (.json), raw data (with --dims and --type), raw slices, or -\n"
     "for stdin. Several INPUTs are slices of one volume, but with --out-dir each is a\n"
     "volume of its own.\n",
     "  mc extract smoke.vdb -o smoke.glb\n"
     "  mc extract head.raw --dims 256,256,128 --type u16 --iso 900 -o head.ply\n"
     "  mc extract scan.nrrd --iso otsu --border closed -o scan.stl\n"
     "  mc extract *.vdb --out-dir meshes --to ply --report -\n"},
    {"edit", "mc edit INPUT --script EDITS -o OUTPUT...", "brush edits, then mesh or volume",
     "Changes a volume by a script of brush edits (.json of format mc-edits, or JSON Lines; -\n"
     "is stdin, each line acted on as it comes) and writes meshes and volumes, or the chunks of\n"
     "the surface that each edit reaches.\n",
     "  mc edit terrain.json --script tunnel.json -o tunnel.glb\n"
     "  mc edit scan.vdb --script edits.jsonl -o scan2.vdb -o scan2.ply\n"
     "  mc edit world.vdb --script - --emit chunks --chunk-dir chunks --journal world.jsonl\n"},
    {"sample", "mc sample INPUT -o VOLUME", "any input to a volume file",
     "Writes the samples of a volume, or of a mc-volume spec, as .vdb, .nrrd, .raw or\n"
     "OpenEXR slices; with --slice one plane of them as a picture.\n",
     "  mc sample terrain.json -o terrain.vdb\n"
     "  mc sample terrain.json --slice z=0 -o terrain.png\n"
     "  mc sample smoke.vdb --region 0,0,0:63,63,63 -o part.nrrd\n"},
    {"info", "mc info INPUT... [--json]", "what is in a volume",
     "Lists the grids of each INPUT: type, dimensions, spacing, range, percentiles and the\n"
     "iso that mc extract would take.\n",
     "  mc info smoke.vdb\n"
     "  mc info head.raw --dims 256,256,128 --type u16 --json\n"},
    {"check", "mc check MESH... [--json] [--closed]", "is a mesh closed, manifold, oriented",
     "Reads PLY, OBJ, STL, glTF and GLB meshes and counts what is wrong with them. Ends\n"
     "with status 7 when one has a defect.\n",
     "  mc check head.ply\n"
     "  mc check --closed --json part.stl\n"},
    {"bench", "mc bench [OPTION]...", "how fast this machine extracts",
     "Times the library call on volumes in memory, warm, beside what memory allows: the\n"
     "terrain of the demo, four fields, and the bandwidth of reading and writing. Every\n"
     "mesh is checked before it is timed. Needs no files.\n",
     "  mc bench\n"
     "  mc bench --size 512 --fields gyroid,noise --normals gradient\n"
     "  mc bench --type u8 --threads 1,2,4 --json\n"
     "  mc bench --noise\n"},
    {"completion", "mc completion SHELL [NAME]", "what bash, zsh or fish complete",
     "Prints a script that lets a shell complete commands, options and their values. NAME is\n"
     "the program's, where it is installed by another than mc.\n",
     "  source <(mc completion bash)\n"
     "  mc completion fish > ~/.config/fish/completions/mc.fish\n"},
}};

/// What else `mc help` can tell of.
struct Topic {
  std::string_view name;
  std::string_view text;
};

constexpr std::array<Topic, 3> kTopics{{
    {"mc-volume",
     "mc-volume: a procedural volume in one JSON file; all of it in mc-volume(5)\n\n"
     "  { \"format\": \"mc-volume\", \"version\": 1, \"convention\": \"density\",\n"
     "    \"grid\": { \"cells\": [64, 64, 64], \"spacing\": 1 }, \"border\": \"closed\",\n"
     "    \"field\": { \"type\": \"difference\", \"smooth\": 2,\n"
     "      \"a\": { \"type\": \"box\", \"center\": [32, 32, 32], \"size\": [40, 40, 40] },\n"
     "      \"b\": { \"type\": \"sphere\", \"center\": [52, 52, 52], \"radius\": 18 } } }\n"},
    {"mc-edits",
     "mc-edits: a script of brush edits, one a line; all of it in mc-edits(5)\n\n"
     "  {\"format\":\"mc-edits\",\"version\":1,\"defaults\":{\"falloff\":\"smoothstep\"}}\n"
     "  "
     "{\"op\":\"add\",\"shape\":{\"type\":\"sphere\",\"center\":[64,30,64],\"radius\":6},"
     "\"strength\":2}\n"
     "  {\"op\":\"subtract\",\"shape\":{\"type\":\"capsule\",\"radius\":[3,1.5]},\"strength\":5,\n"
     "   \"path\":{\"points\":[[10,20,10],[40,18,30]],\"mode\":\"sweep\"}}\n"
     "  {\"op\":\"undo\"}\n"},
    {"formats",
     "Inputs   .vdb; .nrrd and .nhdr (raw encoding); .json of format mc-volume; raw files and\n"
     "         slices with --dims and --type, or with a .nhdr beside them; slices in .exr or\n"
     "         .png, or an .exr of several parts\n"
     "Meshes   .ply .obj .stl .glb .gltf (with a .bin)\n"
     "Volumes  .vdb .nrrd .raw (with a .nhdr), slices.####.exr\n"
     "Pictures .png .exr (mc sample --slice)\n\n"
     "An input is told by --from, then by --dims with --type, then by its content, then by its\n"
     "extension; an output by --to, then by its extension.\n"},
}};

const Page* page_of(std::string_view command) {
  const auto at = std::find_if(kPages.begin(), kPages.end(),
                               [&](const Page& page) { return page.name == command; });
  return at == kPages.end() ? nullptr : &*at;
}

}  // namespace

void with_options(std::string_view command,
                  const std::function<void(const std::vector<Option>&)>& f) {
  if (command == "extract") {
    ExtractArgs args;
    return f(options_of(args));
  }
  if (command == "edit") {
    EditArgs args;
    return f(options_of(args));
  }
  if (command == "sample") {
    SampleArgs args;
    return f(options_of(args));
  }
  if (command == "info") {
    InfoArgs args;
    return f(options_of(args));
  }
  if (command == "check") {
    CheckArgs args;
    return f(options_of(args));
  }
  if (command == "bench") {
    BenchArgs args;
    return f(options_of(args));
  }
  if (command == "completion") {
    CompletionArgs args;
    return f(options_of(args));
  }
  TopArgs args;
  return f(options_of(args));
}

namespace {

std::string option_label(const Option& option) {
  const auto names = option_names(option);
  std::string label = names.front().starts_with("--") ? "    " : "";
  label += fmt::format("{}", fmt::join(names, ", "));
  if (!option.value.empty()) label += fmt::format(" {}", option.value);
  return label;
}

std::string options_text(const std::vector<Option>& options, bool all) {
  constexpr std::size_t kColumn = 26;
  std::string text;
  for (const Option& option : options) {
    if (!all && !option.basic) continue;
    const std::string label = option_label(option);
    // A label too long for its column gets a line of its own.
    text += label.size() + 2 > kColumn
                ? fmt::format("  {}\n  {:{}}{}\n", label, "", kColumn, option.help)
                : fmt::format("  {:{}}{}\n", label, kColumn, option.help);
  }
  return text;
}

std::string program_text(bool verbose) {
  std::string text =
      "mc turns scalar volumes into triangle meshes.\n\n"
      "Usage: mc COMMAND ... | mc --version [-v] | mc help [TOPIC]\n\n"
      "Commands:\n";
  for (const Page& page : kPages) text += fmt::format("  {:12}{}\n", page.name, page.summary);
  text += "\nOptions:\n";
  with_options("", [&](const std::vector<Option>& o) { text += options_text(o, verbose); });
  text += "\nOther topics of mc help: mc-volume, mc-edits, formats\n";
  text +=
      "\nExample:\n"
      "  mc extract smoke.vdb -o smoke.glb\n\n"
      "Exit status: 0 done, 1 internal fault, 2 usage, 3 input, 4 output, 5 no surface,\n"
      "6 over a limit, 7 check found a defect. See mc(1) and mc COMMAND --help.\n";
  return text;
}

[[noreturn]] void refuse_topic(std::string_view topic) {
  const auto names = command_names();
  const std::string near = suggestion(topic, names);
  throw Error(ErrorKind::usage, topic,
              fmt::format("no such command: expected {}", base::enumerate(names)), near);
}

/// One option name a line, for the test that compares the manual pages.
std::string bare_options(std::string_view command) {
  std::string text;
  with_options(command, [&](const std::vector<Option>& options) {
    for (const Option& option : options) {
      for (const std::string_view name : option_names(option)) text += fmt::format("{}\n", name);
    }
  });
  return text;
}

}  // namespace

std::string_view topic_text(std::string_view topic) {
  const auto known = std::ranges::find(kTopics, topic, &Topic::name);
  return known == kTopics.end() ? std::string_view{} : known->text;
}

std::vector<std::string_view> command_names() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kPages) + 1);
  for (const Page& page : kPages) names.push_back(page.name);
  names.emplace_back("help");
  return names;
}

std::string_view command_summary(std::string_view command) {
  const Page* page = page_of(command);
  return page != nullptr ? page->summary : "this program's help";
}

std::string help_text(std::string_view command, bool verbose) {
  if (command.empty()) return program_text(verbose);
  const Page* page = page_of(command);
  if (page == nullptr) refuse_topic(command);
  std::string text = fmt::format("mc {}: {}\n\nUsage: {}\n\n{}\nOptions:\n", page->name,
                                 page->summary, page->usage, page->text);
  with_options(command, [&](const std::vector<Option>& o) { text += options_text(o, verbose); });
  if (!verbose) text += fmt::format("\nAll options: mc {} -v --help\n", page->name);
  text += fmt::format("\nExamples:\n{}", page->examples);
  return text;
}

int run_help(Invocation& /*invocation*/, std::vector<std::string> words) {
  const bool bare = !words.empty() && words.front() == "--options";
  if (bare) words.erase(words.begin());
  TopArgs args;
  std::vector<std::string> topics;
  if (!bare) {
    parse_words("help", options_of(args), &topics, std::move(words));
  } else {
    topics = std::move(words);
  }
  if (topics.size() > 1)
    throw Error(ErrorKind::usage, topics[1], "unexpected word after the topic");
  std::string topic = topics.empty() ? "" : topics.front();
  if (topic == "help") topic.clear();
  const std::string_view known = topic_text(topic);
  if (!known.empty() && !bare) {
    print_out(known);
    return 0;
  }
  if (bare && !topic.empty() && page_of(topic) == nullptr) refuse_topic(topic);
  print_out(bare ? bare_options(topic) : help_text(topic, args.common.verbose > 0));
  return 0;
}

}  // namespace mc::cli
