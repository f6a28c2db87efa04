#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <dolp/dolp.hpp>
#include <string_view>

#include "base/text.hpp"
#include "cli/commands.hpp"
#include "terminal/embedded_texts.hpp"
#include "terminal/terminal.hpp"

namespace dolp::cli {
namespace {

using boost::algorithm::replace_all_copy;
using Words = std::vector<std::string>;

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

Words option_names(const CLI::Option& option) {  // for example "--output" and "-o"
  Words names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

/// Completions of the argument of --set, --vary or --compare.
Words settings_for(const std::string& option) {
  Words all;
  for (const Key& key : dolp::keys()) {
    if (key.layer > 1) continue;  // all films of a coating have the same keys; the first film is enough
    if (option == "--vary" && key.type != Key::Type::kNumber) continue;
    if (option == "--compare" && key.words.empty()) continue;
    if (key.words.empty() || option == "--compare") {
      all.push_back(key.key + '=');
    } else {
      for (const std::string& word : key.words) all.push_back(key.key + '=' + word);
    }
  }
  return all;
}

/// The words that an option allows as its value; empty if it allows any value.
Words option_choices(const CLI::Option& option) {
  const std::string name = option.get_name();
  if (name == "--set" || name == "--vary" || name == "--compare") return settings_for(name);
  const std::string type = option.get_type_name();  // for example "TEXT:{vulkan,cpu}"
  const std::size_t open = type.find('{');
  if (open == std::string::npos) return {};
  Words words;
  for (const std::string_view word : split(std::string_view(type).substr(open + 1, type.find('}') - open - 1), ','))
    words.emplace_back(word);
  return words;
}

/// A line for each word that may complete the last word of `line`: the word, a tab and a description. `line` has the
/// words after `dolp`. The shell scripts put a colon before its last word, because a shell may drop an empty word.
std::string completing_words(const CLI::App& app, const Words& line) {
  const std::string current = line.empty() ? "" : line.back().substr(1);
  std::string found;
  const auto add = [&](const std::string& word, const std::string& description) {
    if (word.starts_with(current)) found += fmt::format("{}\t{}\n", word, description);
  };
  const CLI::App* command = nullptr;
  for (const CLI::App* subcommand : app.get_subcommands({})) {
    if (line.size() < 2) add(subcommand->get_name(), subcommand->get_description());
    if (line.size() >= 2 && subcommand->get_name() == line.front()) command = subcommand;
  }
  if (command == nullptr) return found;
  const CLI::Option* const previous = command->get_option_no_throw(line[line.size() - 2]);
  if (previous != nullptr && takes_value(*previous)) {
    for (const std::string& word : option_choices(*previous)) add(word, "");
  } else if (current.starts_with('-')) {
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option_names(*option)) add(name, option->get_description());
    }
  }
  return found;
}

/// Escapes the characters that roff, the language of manual pages, would interpret.
std::string roff(const std::string& text) {
  std::string safe = replace_all_copy(replace_all_copy(text, "\\", "\\e"), "-", "\\-");
  if (safe.starts_with('.') || safe.starts_with('\'')) safe.insert(0, "\\&");
  return replace_all_copy(safe, "\n", "\n.br\n");
}

std::string manual_options(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    if (option == command.get_help_ptr()) continue;
    const bool is_positional = option->get_positional();
    const std::string name =
        is_positional ? option->get_name(true) : fmt::format("{}", fmt::join(option_names(*option), ", "));
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
      "surfaces\n.SH SYNOPSIS\n.B dolp\n.I COMMAND\n[\\fIARGUMENTS\\fR]\n{}.SH COMMANDS\n{}"
      ".SH EXIT STATUS\n0 done; 1 an accuracy was missed that was asked for; 2 bad input; 3 no usable device; 4 a "
      "file "
      "could not be read or written; 5 an internal error; 6 out of memory; 130 interrupted.\n{}",
      version(), embedded_description_man(), commands, embedded_end_man());
}

}  // namespace

int run_completion(const Options& options) {
  Options unused;
  const std::unique_ptr<CLI::App> app = command_line(unused);
  const std::string& form = options.completion;
  const std::string text = form == "bash"    ? std::string(embedded_dolp_bash())
                           : form == "zsh"   ? std::string(embedded_dolp_zsh())
                           : form == "fish"  ? std::string(embedded_dolp_fish())
                           : form == "words" ? completing_words(*app, options.words)
                                             : manual_page(*app);
  std::fputs(text.c_str(), stdout);
  return kExitDone;
}

}  // namespace dolp::cli
