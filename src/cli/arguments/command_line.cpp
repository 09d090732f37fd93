// SPDX-License-Identifier: MIT
#include "cli/arguments/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/arguments/values.hpp"
#include "mc/base.hpp"

// CLI11 2.1.2 splits the words; nothing else of it is used. Subcommands, help, defaults and
// conversions are ours, since CLI11 would take `check` for a command where it is a file's name, and
// `-300.5` for an option where it is a list's first number.

namespace mc::cli {

namespace {

void bind(CLI::App& app, const Option& option) {
  const std::string names(option.names);
  if (Text* const* text = std::get_if<Text*>(&option.target)) {
    app.add_option_function<std::string>(
        names, [target = *text](const std::string& value) { *target = value; });
  } else if (Texts* const* texts = std::get_if<Texts*>(&option.target)) {
    app.add_option_function<std::vector<std::string>>(
           names, [target = *texts](const std::vector<std::string>& values) { *target = values; })
        ->allow_extra_args(false);
  } else if (bool* const* flag = std::get_if<bool*>(&option.target)) {
    app.add_flag_callback(names, [target = *flag] { *target = true; });
  } else {
    int* const target = std::get<int*>(option.target);
    app.add_flag_function(names, [target](std::int64_t n) { *target = static_cast<int>(n); });
  }
}

/// The option that a CLI11 message is about: the text before its first colon or space.
std::string_view named_in(std::string_view message) {
  return message.substr(0, message.find_first_of(": "));
}

[[noreturn]] void refuse_unknown(std::string_view command, const std::string& word,
                                 std::span<const Option> options) {
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string_view> known;
  for (const Option& option : options) {
    const auto names = option_names(option);
    known.insert(known.end(), names.begin(), names.end());
  }
  // A single letter is near to every other; only long names are worth a guess.
  const std::string near = name.starts_with("--") ? suggestion(name, known) : std::string();
  const std::string where = command.empty() ? "mc" : fmt::format("mc {}", command);
  throw Error(ErrorKind::usage, name, fmt::format("unknown option of {}", where),
              near.empty() ? fmt::format("see {} --help", where) : near);
}

/// Words that CLI11 would take apart wrongly: `--flag=value` on a flag is refused here.
void refuse_flag_values(std::span<const Option> options, std::span<const std::string> words) {
  for (const std::string& word : words) {
    if (word == "--") return;
    const std::size_t equals = word.find('=');
    if (!word.starts_with("--") || equals == std::string::npos) continue;
    for (const Option& option : options) {
      const auto names = option_names(option);
      const bool named = std::find(names.begin(), names.end(),
                                   std::string_view(word).substr(0, equals)) != names.end();
      if (named && option.value.empty()) {
        throw Error(ErrorKind::usage, word.substr(0, equals), "takes no value");
      }
      if (named && equals + 1 == word.size()) {
        throw Error(ErrorKind::usage, word.substr(0, equals),
                    fmt::format("no value: expected {}", option.value));
      }
    }
  }
}

[[noreturn]] void refuse_mismatch(const std::string& message, std::span<const Option> options) {
  const std::string_view name = named_in(message);
  for (const Option& option : options) {
    const auto names = option_names(option);
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    if (message.find("missing") != std::string::npos ||
        message.find("requires") != std::string::npos) {
      throw Error(ErrorKind::usage, name, fmt::format("no value: expected {}", option.value));
    }
    throw Error(ErrorKind::usage, name, "given more than once: expected one value");
  }
  throw Error(ErrorKind::usage, {}, message);
}

bool plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         std::string_view("-_=+,./:@%").find(c) != std::string_view::npos;
}

}  // namespace

void parse_words(std::string_view command, std::span<const Option> options,
                 std::vector<std::string>* inputs, std::vector<std::string> words) {
  refuse_flag_values(options, words);
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  for (const Option& option : options) bind(app, option);
  if (inputs != nullptr) app.add_option("INPUT", *inputs);
  std::reverse(words.begin(), words.end());  // CLI11 takes them from the back
  try {
    app.parse(std::move(words));
  } catch (const CLI::ArgumentMismatch& e) {
    refuse_mismatch(e.what(), options);
  } catch (const CLI::ParseError& e) {
    throw Error(ErrorKind::usage, {}, e.what());
  }
  for (const std::string& word : app.remaining()) {
    if (word == "--") continue;
    if (word.starts_with('-') && word != "-") refuse_unknown(command, word, options);
    throw Error(ErrorKind::usage, word, "unexpected word: expected options only");
  }
}

std::vector<std::string_view> option_names(const Option& option) {
  return split(option.names, ',');
}

std::string shell_text(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) {
      if (c == '\'') {
        text += "'\\''";
      } else {
        text += c;
      }
    }
    text += '\'';
  }
  return text;
}

}  // namespace mc::cli
