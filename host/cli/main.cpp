// The command line: parsing.

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "model/choices.hpp"
#include "scene/number_range.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/guarded.hpp"

namespace dolp::cli {
namespace {

void add_overrides(CLI::App& command, Options& options) {
  command.add_option("--set", options.overrides, "KEY=VALUE: any scene key, e.g. surface.masking=none")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_option("--tolerance", options.tolerance, "the scene's accuracy.tolerance, in " + kToleranceRange.text());
  command.add_option("--precision", options.precision,
                     fmt::format("the scene's accuracy.precision: {}", fmt::join(Names<Precision>::kAll, ", ")));
}

void add_scene(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene_path, "scene file (TOML); - is stdin")->required();
  add_overrides(command, options);
}

void add_explore(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene_path, "scene file (TOML); - is stdin; without it, stainless steel");
  add_overrides(command, options);
  command.add_option("--device", options.device, "Vulkan device: its position or a part of its name");
  command.add_option("--measured", options.measured_path, "CSV of measured points with the columns theta_deg, dolp");
  constexpr std::size_t kMostFrames = 1'000'000;
  command.add_option("--frames", options.frames, "draw so many frames, print how long they took, and end")
      ->check(CLI::Range(std::size_t{1}, kMostFrames));
  command.add_option("--screenshot", options.screenshot_path, "PNG of the last frame, when all is computed");
}

void add_run(CLI::App& command, Options& options) {
  add_scene(command, options);
  command.add_option("-o,--output", options.output_path, "file to write; - is stdout")->required();
  command.add_option("--device", options.device, "Vulkan device: its position or a part of its name");
  command
      .add_option("--evaluator", options.evaluator,
                  "vulkan; cpu: the same text on the CPU; reference: independent adaptive quadrature")
      ->check(CLI::IsMember({"vulkan", "cpu", "reference"}))
      ->capture_default_str();
  command.add_flag("--json", options.json, "machine-readable report");
  command.add_flag("--quiet", options.quiet, "no summary and no progress bar");
  command.add_flag("--strict", options.strict, "exit 1 if any entry misses its tolerance");
}

void add_keep_all(CLI::App& command, Options& options) {
  command.add_flag("--keep-all", options.keep_all, "compute every effect that the scene has, however little it counts");
}

void add_lookup(CLI::App& command, Options& options) {
  command.add_option("TABLE", options.table_path, "table file (.nc) that dolp table wrote")->required();
  command
      .add_option("--points", options.points_path,
                  "CSV with any of theta_deg, sigma, q, n, k, wavelength_um; - is stdin")
      ->required();
  command.add_option("-o,--output", options.output_path, "file to write; - is stdout")->required();
  command.add_flag("--json", options.json, "machine-readable report");
  command.add_flag("--quiet", options.quiet, "no summary");
  command.add_flag("--strict", options.strict, "exit 1 if any point misses the table's tolerance");
}

/// A whole number with a minus sign would pass as 2^64 less it.
std::string not_negative(const std::string& value) {
  return value.starts_with('-') ? "must be a whole number from 0 on, not " + value : "";
}

constexpr std::size_t kMostSamples = std::size_t{1} << 24U;

void add_verify(CLI::App& command, Options& options) {
  CLI::Option* table = command.add_option("TABLE", options.table_path, "table file (.nc) that dolp table wrote");
  const auto of_table = [&](CLI::Option* option) { option->needs(table); };
  of_table(command.add_option("--samples", options.samples, "entries to recompute; all when the table has no more")
               ->check(CLI::Range(std::size_t{1}, kMostSamples))
               ->capture_default_str());
  of_table(command.add_option("--seed", options.seed, "seed of their choice")
               ->check(not_negative, "")
               ->capture_default_str());
  of_table(command.add_flag("--named-files", options.named_files,
                            "take n, k and E0 from where the scene says, not from the table"));
  CLI::Option* hard = command.add_flag("--hard-cases", options.hard_cases,
                                       "examine a device with the model's hard cases, in float and double");
  hard->excludes(table);
  const auto of_device = [&](CLI::Option* option) { option->needs(hard); };
  of_device(command.add_option("--device", options.device, "Vulkan device: its position or a part of its name"));
  of_device(command.add_option("--precision", options.precision, "auto is both")
                ->check(CLI::IsMember(
                    std::vector<std::string>(Names<Precision>::kAll.begin(), Names<Precision>::kAll.end()))));
  of_device(command.add_option("--evaluator", options.evaluator, "vulkan; cpu: the same text on the CPU")
                ->check(CLI::IsMember({"vulkan", "cpu"}))
                ->capture_default_str());
  of_device(command.add_option("--tolerance", options.tolerance,
                               "what to ask for, in " + kToleranceRange.text() + "; 1e-4 when not given"));
  of_device(command.add_flag("--all", options.all, "report every case"));
  command.add_flag("--json", options.json, "machine-readable report of everything compared");
  command.add_flag("--quiet", options.quiet, "no report and no progress bar; the exit status says it");
}

/// Refuses empty values of options: they would pass as options that are not there.
void refuse_empty_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    option->check([](const std::string& value) { return std::string(value.empty() ? "must not be empty" : ""); }, "");
  }
}

/// Refuses a device for an evaluator that has none.
void check_device(const Options& options) {
  if (options.device.empty() || options.evaluator == "vulkan") return;
  throw InputError(
      fmt::format("--device {}: needs --evaluator vulkan, and it is {}", options.device, options.evaluator));
}

/// Runs the command that the arguments name.
int run(CLI::App& app, Options& options) {
  const auto given = [&app](const char* name) { return app.got_subcommand(name); };
  if (given("table")) return run_table(options);
  if (given("merge")) return run_merge(options);
  if (given("eval")) return run_eval(options);
  if (given("mueller")) return run_mueller(options);
  if (given("plan")) return run_plan(options);
  if (given("explore")) return run_explore(options);
  if (given("verify")) return run_verify(options);
  if (given("lookup")) return run_lookup(options);
  if (given("materials")) return run_materials(options);
  return run_devices(options);
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining();
  if (!app.get_subcommands().empty() || unknown.empty()) return fmt::format("{} (see dolp --help)", error.what());
  return fmt::format("{}: unknown command or option (see dolp --help)", unknown.front());
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("dolp: infrared degree of linear polarisation of rough surfaces, on any Vulkan device", "dolp");
  app.set_version_flag("--version", "dolp " DOLP_VERSION);
  app.require_subcommand(1);
  Options options;
  for (int i = 0; i < argc; ++i) options.command_line += (i > 0 ? " " : "") + std::string(argv[i]);

  CLI::App* table = app.add_subcommand("table", "lookup table over the scene's grid (.nc, .csv, .npy)");
  add_run(*table, options);
  add_keep_all(*table, options);
  table->add_option("--shard", options.shard,
                    "I/N: this part of the grid, into FILE with .I-of-N before its suffix; auto: in a Slurm array");
  table->add_flag("--resume", options.resume, "go on where an interrupted run of the same scene stopped");
  CLI::App* merge = app.add_subcommand("merge", "the shards of a table as one table");
  merge->add_option("SHARD", options.shards, "all shards of one table (.nc)")->required();
  merge->add_option("-o,--output", options.output_path, "file to write")->required();
  merge->add_flag("--json", options.json, "machine-readable report");
  merge->add_flag("--quiet", options.quiet, "no summary");
  CLI::App* eval = app.add_subcommand("eval", "the same quantities at scattered points");
  add_run(*eval, options);
  add_keep_all(*eval, options);
  eval->add_option("--points", options.points_path,
                   "CSV with any of theta_deg, sigma, q, n, k, wavelength_um; - is stdin")
      ->required();
  CLI::App* mueller = app.add_subcommand("mueller", "4 x 4 Mueller pBRDF [1/sr] at scattered geometries");
  add_run(*mueller, options);
  mueller
      ->add_option("--points", options.points_path,
                   "CSV with theta_i_deg, theta_r_deg, delta_phi_deg and any of sigma, q, n, k; - is stdin")
      ->required();
  CLI::App* plan = app.add_subcommand("plan", "what a table would compute and leave out, why, and what it would cost");
  add_scene(*plan, options);
  plan->add_option("--device", options.device, "Vulkan device: its position or a part of its name");
  add_keep_all(*plan, options);
  plan->add_flag("--json", options.json, "machine-readable plan");
  add_verify(*app.add_subcommand("verify", "recompute entries of a table, or examine a device"), options);
  add_lookup(*app.add_subcommand("lookup", "interpolate in a table at scattered points, with the error of that"),
             options);
  add_explore(*app.add_subcommand("explore", "the window: parameters, curves, map, effects and their price, live"),
              options);
  app.add_subcommand("materials", "built-in materials, their ranges of wavelength and their sources")
      ->add_flag("--json", options.json, "machine-readable list");
  CLI::App* devices = app.add_subcommand("devices", "Vulkan devices, and why each one is or is not usable");
  devices->add_flag("--json", options.json, "machine-readable list");
  devices->add_option("--device", options.device, "check this one: its position or a part of its name");

  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return fail("dolp", kExitInput, usage_message(app, error));
  }
  check_device(options);
  const int status = run(app, options);
  if (std::fflush(stdout) != 0) throw dolp::IoError("standard output: cannot write the report");
  return status;
}

/// Lets freed memory serve again: lists as long as a table, and what a driver needs for a pipeline, would otherwise go
/// back to the system and come back page by page.
void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace dolp::cli

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error of its writing
  dolp::cli::keep_freed_memory();
  return dolp::guarded("dolp", [&] { return dolp::cli::parse_and_run(argc, argv); });
}
