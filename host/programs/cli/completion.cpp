#include "cli/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <dolp/dolp.hpp>

#include "base/text.hpp"

namespace dolp::cli {
namespace {

using Words = std::vector<std::string>;

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<const CLI::Option*> named_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

/// "--output", "-o".
Words names_of(const CLI::Option& option) {
  Words names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

/// The words that an option's value may be; none where it may be anything.
Words choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  Words words;
  for (std::size_t from = open + 1; from < close;) {
    const std::size_t to = std::min(type.find(',', from), close);
    words.push_back(type.substr(from, to - from));
    from = to + 1;
  }
  return words;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

std::string bash_completion(const CLI::App& app) {
  Words commands;
  std::string options, values;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
    Words names;
    for (const CLI::Option* option : named_options(*command)) {
      const Words own = names_of(*option);
      names.insert(names.end(), own.begin(), own.end());
      const Words choices = choices_of(*option);
      if (choices.empty()) continue;
      for (const std::string& name : own) {
        values += fmt::format("    {}:{}) words={} ;;\n", command->get_name(), name,
                              shell_quoted(fmt::format("{}", fmt::join(choices, " "))));
      }
    }
    options += fmt::format("    {}:-*) words={} ;;\n", command->get_name(),
                           shell_quoted(fmt::format("{}", fmt::join(names, " "))));
  }
  return fmt::format(R"(# bash completion of dolp
_dolp() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words=
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '{}' -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}}:$previous in
{}  esac
  [[ -n $words ]] || case ${{COMP_WORDS[1]}}:$current in
{}  esac
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -o filenames -F _dolp dolp
)",
                     fmt::join(commands, " "), values, options);
}

std::string zsh_completion(const CLI::App& app) {
  // Colons and brackets end a description.
  const auto description = [](const std::string& text, std::string_view specials) {
    std::string result;
    for (const char c : text) {
      if (specials.find(c) != std::string_view::npos) result += '\\';
      result += c;
    }
    return result;
  };
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands +=
        fmt::format("  {}\n", shell_quoted(command->get_name() + ":" + description(command->get_description(), ":")));
    std::string lines;
    for (const CLI::Option* option : named_options(*command)) {
      const Words choices = choices_of(*option);
      const std::string value = !takes_value(*option) ? ""
                                : choices.empty()     ? ":value:_files"
                                                      : fmt::format(":value:({})", fmt::join(choices, " "));
      for (const std::string& name : names_of(*option)) {
        lines += " \\\n      " +
                 shell_quoted(fmt::format("*{}[{}]{}", name, description(option->get_description(), "[]:\\"), value));
      }
    }
    cases += fmt::format("  {})\n    _arguments{} \\\n      '*:file:_files'\n    ;;\n", command->get_name(), lines);
  }
  return fmt::format(R"(#compdef dolp
local -a commands=(
{})
if ((CURRENT == 2)); then
  _describe command commands
  return
fi
local command=$words[2]
shift words
((CURRENT--))
case $command in
{}esac
)",
                     commands, cases);
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion of dolp\n";
  for (const CLI::App* command : app.get_subcommands({})) {
    text += fmt::format("complete -c dolp -n __fish_use_subcommand -f -a {} -d {}\n", command->get_name(),
                        shell_quoted(command->get_description()));
  }
  for (const CLI::App* command : app.get_subcommands({})) {
    for (const CLI::Option* option : named_options(*command)) {
      std::string names;
      for (const std::string& name : option->get_lnames()) names += " -l " + name;
      for (const std::string& name : option->get_snames()) names += " -s " + name;
      const Words choices = choices_of(*option);
      const std::string value = !takes_value(*option) ? ""
                                : choices.empty()     ? " -r"
                                                      : fmt::format(" -x -a '{}'", fmt::join(choices, " "));
      text += fmt::format("complete -c dolp -n '__fish_seen_subcommand_from {}'{}{} -d {}\n", command->get_name(),
                          names, value, shell_quoted(option->get_description()));
    }
  }
  return text;
}

/// Text that roff takes as it is.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (safe.starts_with('.') || safe.starts_with('\'')) safe.insert(0, "\\&");
  return replaced(safe, "\n", "\n.br\n");
}

std::string manual_options(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name() == "--help,-h" || option->get_name() == "-h,--help") continue;
    const bool is_positional = option->get_positional();
    const std::string name =
        is_positional ? option->get_name(true) : fmt::format("{}", fmt::join(names_of(*option), ", "));
    const std::string type = is_positional || !takes_value(*option) ? "" : " " + option->get_type_name();
    text += fmt::format(".TP\n.B {}\n{}\n", roff(name + type), roff(option->get_description()));
  }
  return text;
}

std::string manual_page(const CLI::App& app) {
  std::string commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands += fmt::format(".SS {}\n{}.\n{}", roff("dolp " + command->get_name()), roff(command->get_description()),
                            manual_options(*command));
    if (!command->get_footer().empty()) commands += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(command->get_footer()));
  }
  return fmt::format(
      ".TH DOLP 1 \"\" \"dolp {}\" \"User Commands\"\n.SH NAME\ndolp \\- infrared degree of linear polarisation of "
      "rough "
      "surfaces\n.SH SYNOPSIS\n.B dolp\n.I COMMAND\n[\\fIARGUMENTS\\fR]\n.SH COMMANDS\n{}"
      ".SH EXIT STATUS\n0 done; 1 an accuracy was missed that was asked for; 2 bad input; 3 no usable device; 4 a file "
      "could not be read or written; 5 an internal error; 6 out of memory; 130 interrupted.\n",
      version(), commands);
}

}  // namespace

std::string completion_text(const CLI::App& app, const std::string& form) {
  if (form == "bash") return bash_completion(app);
  if (form == "zsh") return zsh_completion(app);
  if (form == "fish") return fish_completion(app);
  return manual_page(app);
}

}  // namespace dolp::cli
