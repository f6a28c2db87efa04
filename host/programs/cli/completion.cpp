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

/// "KEY=WORD" of the keys of a scene, "KEY=" of those that have no words.
Words settings() {
  Words all;
  for (const Key& key : dolp::keys()) {
    if (key.layer > 1) continue;  // as the first
    if (key.words.empty()) all.push_back(key.key + '=');
    for (const std::string& word : key.words) all.push_back(key.key + '=' + word);
  }
  return all;
}

/// "KEY=" of the keys that a fit can vary or compare.
Words keys_of(bool (*is_wanted)(const Key&)) {
  Words all;
  for (const Key& key : dolp::keys()) {
    if (is_wanted(key) && key.layer <= 1) all.push_back(key.key + '=');
  }
  return all;
}

/// The words that an option's value may be; none where it may be anything.
Words choices_of(const CLI::Option& option) {
  const std::string name = option.get_name();
  if (name == "--set") return settings();
  if (name == "--vary") return keys_of([](const Key& key) { return key.type == Key::Type::kNumber; });
  if (name == "--compare") return keys_of([](const Key& key) { return !key.words.empty(); });
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
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words= begin= at=COMP_CWORD
  [[ $current != = ]] || {{ begin=$previous= current= at=COMP_CWORD-1; }}
  [[ $previous != = ]] || {{ begin=${{COMP_WORDS[COMP_CWORD - 2]}}= at=COMP_CWORD-2; }}  # bash cuts KEY=WORD in three
  [[ -z $begin ]] || previous=${{COMP_WORDS[at - 1]}}
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W '{}' -- "$current")
    return
  fi
  case ${{COMP_WORDS[1]}}:$previous in
{}  esac
  [[ -n $words ]] || case ${{COMP_WORDS[1]}}:$current in
{}  esac
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$begin$current")
    COMPREPLY=("${{COMPREPLY[@]#"$begin"}}")
    [[ ${{COMPREPLY[*]}} != *= ]] || compopt -o nospace 2>/dev/null
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

constexpr const char* kManualDescription = R"(.SH DESCRIPTION
.B dolp
computes the degree of linear polarisation of the infrared radiation that leaves a rough surface: its own emission plus
what it reflects. A scene, a TOML file, describes surface, radiation and accuracy; the results are lookup tables, lists
of points or Mueller matrices, each number with a bound of its numerical error and a status. The integrals run on a
Vulkan device, a GPU or the processor through Mesa's lavapipe.
)";

constexpr const char* kManualEnd = R"(.SH FILES
.TP
.I SCENE
TOML;
.B dolp keys
lists its keys. Files that it names are looked for beside it.
.TP
.I FILE.nc\fR, \fIFILE.csv\fR, \fIFILE.npy
tables, whole or absent. What an interrupted run has finished lies in
.I FILE.partial
until
.B \-\-resume
takes it up.
.TP
.I PREFIX/share/dolp
scenes to start from, materials, the sun, plot_table.py.
.SH ENVIRONMENT
.TP
.B VK_DRIVER_FILES
of the Vulkan loader: manifests of the drivers to use, for example that of lavapipe.
.TP
.B SLURM_ARRAY_TASK_ID\fR, \fBSLURM_ARRAY_TASK_MIN\fR, \fBSLURM_ARRAY_TASK_COUNT
what
.B \-\-shard auto
computes.
.TP
.B DOLP_VALIDATION
1: run with the Vulkan validation layer; its messages are errors.
.SH SEE ALSO
.BR ncdump (1),
.BR vulkaninfo (1);
.B dolp \-\-cite
says how to cite program and model.
)";

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
      "surfaces\n.SH SYNOPSIS\n.B dolp\n.I COMMAND\n[\\fIARGUMENTS\\fR]\n{}.SH COMMANDS\n{}"
      ".SH EXIT STATUS\n0 done; 1 an accuracy was missed that was asked for; 2 bad input; 3 no usable device; 4 a file "
      "could not be read or written; 5 an internal error; 6 out of memory; 130 interrupted.\n{}",
      version(), kManualDescription, commands, kManualEnd);
}

}  // namespace

std::string completion_text(const CLI::App& app, const std::string& form) {
  if (form == "bash") return bash_completion(app);
  if (form == "zsh") return zsh_completion(app);
  if (form == "fish") return fish_completion(app);
  return manual_page(app);
}

}  // namespace dolp::cli
