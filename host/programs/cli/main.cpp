#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <dolp/dolp.hpp>
#include <dolp/errors.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "cli/commands.hpp"
#include "device/result.hpp"
#include "terminal/terminal.hpp"

namespace dolp::cli {
namespace {

/// A hint for an unknown option: an option with a similar name, or --set with the scene key of this name. May be empty.
std::string option_hint(const CLI::App& command, const std::string& option) {
  constexpr std::size_t kMostMistakes = 2;
  const std::string given = option.substr(0, option.find('='));
  for (const CLI::Option* known : command.get_options()) {
    for (const std::string& name : known->get_lnames()) {
      if (edit_distance(given, "--" + name) <= kMostMistakes) return "; did you mean --" + name + "?";
    }
  }
  for (const Key& known : dolp::keys()) {
    const std::string name = known.key.substr(known.key.find('.') + 1);
    if (option == "--" + name || option == "--" + known.key) return "; --set " + known.key + "=VALUE sets it";
  }
  return "";
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining(true);
  const bool is_unknown = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (!app.get_subcommands().empty()) {
    const CLI::App& command = *app.get_subcommands().front();
    const std::string what =
        is_unknown ? fmt::format("{}: unknown here{}", fmt::join(unknown, " "), option_hint(command, unknown.front()))
                   : error.what();
    return fmt::format("{} (see dolp {} --help)", what, command.get_name());
  }
  if (unknown.empty()) return fmt::format("{} (see dolp --help)", error.what());
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const std::optional<std::string> near = near_name(unknown.front(), commands);
  return fmt::format("{}: unknown command or option{} (see dolp --help)", unknown.front(),
                     near ? "; the nearest command is " + *near : "");
}

int parse_and_run(int argc, char** argv) {
  Options options;
  for (int i = 0; i < argc; ++i) options.command_line += (i > 0 ? " " : "") + std::string(argv[i]);
  const std::unique_ptr<CLI::App> program = command_line(options);
  CLI::App& app = *program;
  int status = kExitDone;
  try {
    app.parse(argc, argv);
    for (const char* own : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})
      if (options.output_path == own) options.output_path = "-";
    if (options.run == nullptr) fmt::print("{}", app.help());
    if (options.run != nullptr) status = options.run(options);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return fail("dolp", kExitInput, usage_message(app, error));
    app.exit(error);  // prints the help, the version or the citation
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw IoError("standard output: cannot write the report");
  return status;
}

/// Prints a message and ends the program. `new` calls this function if there is no memory. The program may end at any
/// moment, because an incomplete output file does not have its final name yet.
[[noreturn]] void end_out_of_memory() {
  static std::atomic_flag is_ending;
  while (is_ending.test_and_set()) ::pause();  // another thread is printing the message
  ::_exit(fail_out_of_memory("dolp"));
}

}  // namespace
}  // namespace dolp::cli

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // if a file is too large, write() then fails instead of ending the program
  std::set_new_handler(dolp::cli::end_out_of_memory);
  // Makes free() keep memory for later use. Otherwise the program would return the memory of large lists and of Vulkan
  // pipelines to the system, and request it again page by page.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  const int status = dolp::guarded("dolp", [&] { return dolp::cli::parse_and_run(argc, argv); });
  if (status != dolp::kExitMemory && !dolp::vulkan::driver_is_busy()) return status;
  std::fflush(stdout);
  ::_exit(status);  // skips the cleanup, because it needs memory and waits for a busy driver
}
