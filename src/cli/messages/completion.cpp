// SPDX-License-Identifier: MIT
#include "cli/messages/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "cli/arguments/args.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/values.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "mc/base.hpp"

// The same in three languages: which command, then its options; after an option that has a list of
// values these, after others files.

namespace mc::cli {

namespace {

constexpr std::array<std::string_view, 3> kShells{"bash", "zsh", "fish"};

/// A command as shells see it; the program before any command has no name.
struct Command {
  std::string_view name, summary;
  std::string_view words;  ///< it takes instead of files, with blanks between
  std::vector<Option> options;
};

std::vector<Command> all_commands() {
  std::vector<Command> all;
  const auto add = [&](std::string_view name) {
    Command command{name, command_summary(name), {}, {}};
    if (name == "completion") command.words = "bash zsh fish";
    if (name == "help")
      command.words = "extract edit sample info check bench mc-volume mc-edits formats";
    with_options(name, [&](const std::vector<Option>& options) { command.options = options; });
    all.push_back(std::move(command));
  };
  add("");
  for (const std::string_view name : command_names()) add(name);
  return all;
}

bool takes_folder(const Option& option) { return option.value == "DIR"; }

std::string joined_names(const std::vector<Command>& commands) {
  std::vector<std::string_view> names;
  for (const Command& command : commands) {
    if (!command.name.empty()) names.push_back(command.name);
  }
  return fmt::format("{}", fmt::join(names, " "));
}

/// Text between single quotes; `quote` stands for a quote in it.
std::string quoted(std::string_view text, std::string_view quote) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += quote;
    } else {
      out += c;
    }
  }
  return out + "'";
}

// bash

std::string bash_values(const Command& command) {
  std::string text;
  for (const Option& option : command.options) {
    if (option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string_view name : option_names(option)) {
      patterns.push_back(fmt::format("{}:{}", command.name, name));
    }
    const std::string action = !option.values.empty() ? fmt::format("words='{}'", option.values)
                               : takes_folder(option)
                                   ? std::string("COMPREPLY=($(compgen -d -- \"$cur\"))")
                                   : std::string(":");
    text += fmt::format("    {}) {} ;;\n", fmt::join(patterns, "|"), action);
  }
  return text;
}

std::string bash_options(const Command& command) {
  std::vector<std::string_view> names;
  for (const Option& option : command.options) {
    for (const std::string_view name : option_names(option)) names.push_back(name);
  }
  return fmt::format("{}", fmt::join(names, " "));
}

/// Where no word is offered, -o default lets readline offer files.
std::string bash_script(std::string_view program, const std::vector<Command>& commands) {
  std::string values, words;
  for (const Command& command : commands) {
    values += bash_values(command);
    words += fmt::format("      {}:-*) words='{}' ;;\n", command.name, bash_options(command));
    if (command.name.empty()) {
      words += fmt::format("      :*) words='{}' ;;\n", joined_names(commands));
    } else if (!command.words.empty()) {
      words += fmt::format("      {}:*) words='{}' ;;\n", command.name, command.words);
    }
  }
  return fmt::format(
      "# bash completion for {0}, made by: {0} completion bash\n"
      "_{0}() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} word words=\n"
      "  local command=\n"
      "  COMPREPLY=()\n"
      "  # Bash takes --option=value apart at the sign.\n"
      "  if [[ $cur == = ]]; then\n"
      "    cur=\n"
      "  elif [[ $prev == = ]]; then\n"
      "    prev=${{COMP_WORDS[COMP_CWORD-2]}}\n"
      "  fi\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
      "    [[ $word == -* ]] || {{ command=$word; break; }}\n"
      "  done\n"
      "  case $command:$prev in\n"
      "{1}"
      "    *) case $command:$cur in\n"
      "{2}"
      "    esac ;;\n"
      "  esac\n"
      "  if [[ $words ]]; then COMPREPLY=($(compgen -W \"$words\" -- \"$cur\")); fi\n"
      "}}\n"
      "complete -o default -F _{0} {0}\n",
      program, values, words);
}

// zsh

/// A description between brackets, or in a list with colons.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("[]:\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_value(const Option& option) {
  if (option.value.empty()) return {};
  const std::string action = !option.values.empty() ? fmt::format("({})", option.values)
                             : takes_folder(option) ? std::string("_files -/")
                                                    : std::string("_files");
  return fmt::format(":{}:{}", zsh_text(option.value), action);
}

std::string zsh_options(const Command& command) {
  std::string text;
  for (const Option& option : command.options) {
    for (const std::string_view name : option_names(option)) {
      const std::string_view joint = option.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
      const std::string spec =
          fmt::format("{}{}[{}]{}", name, joint, zsh_text(option.help), zsh_value(option));
      text += fmt::format(" \\\n        {}", quoted(spec, "'\\''"));
    }
  }
  return text;
}

std::string zsh_script(std::string_view program, const std::vector<Command>& commands) {
  std::string described, cases;
  for (const Command& command : commands) {
    if (command.name.empty()) continue;
    described +=
        fmt::format("\n        {}",
                    quoted(fmt::format("{}:{}", command.name, zsh_text(command.summary)), "'\\''"));
    const std::string rest =
        command.words.empty() ? std::string("_files") : fmt::format("({})", command.words);
    cases += fmt::format("      {})\n        _arguments{} \\\n        '*:word:{}' && ret=0 ;;\n",
                         command.name, zsh_options(command), rest);
  }
  return fmt::format(
      "#compdef {0}\n"
      "# zsh completion for {0}, made by: {0} completion zsh\n"
      "_{0}() {{\n"
      "  local curcontext=$curcontext state line ret=1\n"
      "  typeset -A opt_args\n"
      "  _arguments -C{1} \\\n        '1: :->command' '*:: :->words' && ret=0\n"
      "  case $state in\n"
      "    command)\n"
      "      local -a commands=({2})\n"
      "      _describe -t commands command commands && ret=0 ;;\n"
      "    words)\n"
      "      curcontext=\"${{curcontext%:*:*}}:{0}-$words[1]:\"\n"
      "      case $words[1] in\n"
      "{3}"
      "      esac ;;\n"
      "  esac\n"
      "  return ret\n"
      "}}\n"
      "if [[ $funcstack[1] == _{0} ]]; then _{0} \"$@\"; else compdef _{0} {0}; fi\n",
      program, zsh_options(commands.front()), described, cases);
}

// fish

std::string fish_options(std::string_view program, const Command& command,
                         std::string_view condition) {
  std::string text;
  for (const Option& option : command.options) {
    std::string names;
    for (const std::string_view name : option_names(option)) {
      names += name.starts_with("--") ? fmt::format(" -l {}", name.substr(2))
                                      : fmt::format(" -s {}", name.substr(1));
    }
    const std::string value = option.value.empty()     ? std::string()
                              : !option.values.empty() ? fmt::format(" -x -a '{}'", option.values)
                              : takes_folder(option)
                                  ? std::string(" -x -a '(__fish_complete_directories)'")
                                  : std::string(" -r");
    text += fmt::format("complete -c {} -n '{}'{}{} -d {}\n", program, condition, names, value,
                        quoted(option.help, "\\'"));
  }
  return text;
}

std::string fish_script(std::string_view program, const std::vector<Command>& commands) {
  std::string text =
      fmt::format("# fish completion for {0}, made by: {0} completion fish\n", program);
  const std::string none =
      fmt::format("not __fish_seen_subcommand_from {}", joined_names(commands));
  for (const Command& command : commands) {
    if (command.name.empty()) {
      text += fish_options(program, command, none);
      continue;
    }
    text += fmt::format("complete -c {} -n '{}' -f -a {} -d {}\n", program, none, command.name,
                        quoted(command.summary, "\\'"));
    const std::string here = fmt::format("__fish_seen_subcommand_from {}", command.name);
    text += fish_options(program, command, here);
    if (!command.words.empty()) {
      text += fmt::format("complete -c {} -n '{}' -f -a '{}'\n", program, here, command.words);
    }
  }
  return text;
}

}  // namespace

std::string completion_script(std::string_view shell, std::string_view program) {
  const bool plain = !program.empty() && std::ranges::all_of(program, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_' || c == '.';
  });
  if (!plain) {
    throw Error(ErrorKind::usage, program,
                "cannot be a program's name: expected letters, digits, - _ and .");
  }
  const std::vector<Command> commands = all_commands();
  if (shell == "bash") return bash_script(program, commands);
  if (shell == "zsh") return zsh_script(program, commands);
  if (shell == "fish") return fish_script(program, commands);
  refuse_choice("completion", shell, kShells);
}

int run_completion(Invocation& /*invocation*/, std::vector<std::string> words) {
  CompletionArgs args;
  std::vector<std::string> given;
  parse_words("completion", options_of(args), &given, std::move(words));
  if (args.common.help) {
    print_out(help_text("completion", args.common.verbose > 0));
    return 0;
  }
  if (given.empty() || given.size() > 2) {
    throw Error(ErrorKind::usage, "completion",
                "expected a shell, bash, zsh or fish, and perhaps the program's name",
                "for example: mc completion bash");
  }
  print_out(completion_script(given.front(), given.size() == 2 ? given.back() : "mc"));
  return 0;
}

}  // namespace mc::cli
