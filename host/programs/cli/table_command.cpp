#include <fmt/format.h>

#include <cstdlib>
#include <dolp/errors.hpp>
#include <optional>
#include <string>

#include "base/text.hpp"
#include "cli/commands.hpp"
#include "terminal/progress_bar.hpp"

namespace dolp::cli {
namespace {

std::size_t whole_number(const std::string& text, const std::string& what) {
  constexpr double kMost = 1e9;
  const std::optional<double> number = parse_number(text);
  if (number && *number >= 0.0 && *number <= kMost && *number == static_cast<double>(static_cast<std::size_t>(*number)))
    return static_cast<std::size_t>(*number);
  throw InputError(fmt::format("{}: {} is not a whole number from 0 to {}", what, one_line(text), kMost));
}

std::size_t slurm_number(const char* variable) {
  const char* text = std::getenv(variable);
  if (!text)
    throw InputError(fmt::format("--shard auto: needs the tasks of a Slurm array, and {} is not set", variable));
  return whole_number(text, variable);
}

/// "2/8", or what the Slurm array says for "auto".
Shard shard_of(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  if (text == "auto") {
    const std::size_t task = slurm_number("SLURM_ARRAY_TASK_ID");
    const std::size_t first = slurm_number("SLURM_ARRAY_TASK_MIN");
    shard = {task - first + 1, slurm_number("SLURM_ARRAY_TASK_COUNT")};
  } else {
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) throw InputError(fmt::format("--shard {}: must be I/N or auto", one_line(text)));
    shard = {whole_number(text.substr(0, slash), "--shard"), whole_number(text.substr(slash + 1), "--shard")};
  }
  if (shard.is_none()) throw InputError("--shard 0/0: there is no such shard");
  return shard;
}

}  // namespace

int run_table(const Options& options) {
  const Scene scene = load_scene(options);
  const Shard shard = shard_of(options.shard);
  const Report report = evaluator_of(options).write_table(
      scene, options.output_path,
      {options.keep_all, ProgressBar(options.quiet).callback(), options.command_line, options.resume}, shard);
  return finish(report, options);
}

int run_response(const Options& options) {
  const Scene scene = load_scene(options, surface_settings());
  return finish(evaluator_of(options).write_response(
                    scene, options.output_path,
                    {.progress = ProgressBar(options.quiet).callback(), .history = options.command_line}),
                options);
}

int run_merge(const Options& options) {
  return finish(merge({options.shards.begin(), options.shards.end()}, options.output_path, options.command_line),
                options);
}

}  // namespace dolp::cli
