#include "cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <dolp/dolp.hpp>
#include <string>
#include <vector>

#include "cli/completion.hpp"

namespace dolp::cli {
namespace {

constexpr const char* kDescription =
    "dolp: infrared degree of linear polarisation of rough surfaces, on any Vulkan device";

/// At the end of a command's help.
void add_examples(CLI::App& command, const char* first, const char* second) {
  command.footer(fmt::format("Examples:\n  {}\n  {}", first, second));
}

void add_overrides(CLI::App& command, Options& options) {
  command.add_option("--set", options.overrides, "KEY=VALUE: any scene key, e.g. surface.masking=none")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_option("--tolerance", options.tolerance,
                     "the scene's accuracy.tolerance: " + allowed("accuracy.tolerance"));
  command.add_option("--precision", options.precision,
                     "the scene's accuracy.precision: " + allowed("accuracy.precision"));
}

void add_scene(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene_path, "scene file (TOML); - is stdin")->required();
  add_overrides(command, options);
}

void add_explore(CLI::App& command, Options& options) {
  command.add_option("SCENE", options.scene_path,
                     "scene, or session of the window (TOML); - is stdin; without it, stainless steel");
  add_overrides(command, options);
  command.add_option("--device", options.device, "Vulkan device: its position or a part of its name");
  command.add_option("--measured", options.measured_path, "CSV of measured points with the columns theta_deg, dolp");
  constexpr std::size_t kMostFrames = 1'000'000;
  command.add_option("--frames", options.frames, "draw so many frames, print how long they took, and end")
      ->check(CLI::Range(std::size_t{1}, kMostFrames));
  command
      .add_option("--view", options.panel, "what is beside the curve: map, slopes, material, pBRDF, sphere, sky, fit")
      ->check(CLI::IsMember({"map", "slopes", "material", "pBRDF", "sphere", "sky", "fit"}));
  command.add_option("--screenshot", options.screenshot_path, "PNG of the last frame, when all is computed");
}

void add_evaluator(CLI::App& command, Options& options) {
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

void add_run(CLI::App& command, Options& options) {
  add_scene(command, options);
  command.add_option("-o,--output", options.output_path, "file to write; - is stdout")->required();
  add_evaluator(command, options);
}

void add_keep_all(CLI::App& command, Options& options) {
  command.add_flag("--keep-all", options.keep_all, "compute every effect that the scene has, however little it counts");
}

void add_lookup(CLI::App& command, Options& options) {
  command.add_option("TABLE", options.table_path, "table file (.nc) that dolp table wrote")->required();
  command
      .add_option("--points", options.points_path,
                  "CSV with any of theta_deg, sigma or wind_m_s, q, n, k, wavelength_um; - is stdin")
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
                ->check(CLI::IsMember({"auto", "float", "double"})));
  of_device(command.add_option("--evaluator", options.evaluator, "vulkan; cpu: the same text on the CPU")
                ->check(CLI::IsMember({"vulkan", "cpu"}))
                ->capture_default_str());
  of_device(command.add_option("--tolerance", options.tolerance,
                               "what to ask for: " + allowed("accuracy.tolerance") + "; 1e-4 when not given"));
  of_device(command.add_flag("--all", options.all, "report every case"));
  command.add_flag("--json", options.json, "machine-readable report of everything compared");
  command.add_flag("--quiet", options.quiet, "no report and no progress bar; the exit status says it");
}

void add_fit(CLI::App& command, Options& options) {
  add_scene(command, options);
  const auto list = [&](const char* name, std::vector<std::string>& values, const char* what) {
    return command.add_option(name, values, what)->allow_extra_args(false);
  };
  list("--data", options.data,
       "CSV with theta_deg, one of dolp, q_over_i, emissivity_s, and any of uncertainty, wavelength_um; - is stdin; "
       "FILE:KEY=VALUE,... sets scene keys for it; repeatable")
      ->required();
  list("--vary", options.vary, "KEY=LOW:HIGH or KEY=LOW:HIGH:START: a number of the scene to find; repeatable")
      ->required();
  list("--compare", options.compare, "KEY=WORD,WORD,...: fit with each and rank them; repeatable");
  command.add_option("-o,--output", options.output_path, "file for the fitted scene; - is stdout");
  command.add_option("--plot", options.plot_path,
                     ".png, .pdf or .svg of data, fit and residuals, drawn with Matplotlib");
  command.add_option("--starts", options.starts, "descents that look for minima")
      ->check(CLI::Range(std::size_t{1}, kMostStarts))
      ->capture_default_str();
  command.add_option("--seed", options.seed, "seed of where they begin")
      ->check(not_negative, "")
      ->capture_default_str();
  command.add_option("--loss", options.loss, fmt::format("what a residual counts: {}", fmt::join(loss_names(), ", ")))
      ->check(CLI::IsMember(loss_names()))
      ->capture_default_str();
  command
      .add_option(
          "--model-error", options.model_error,
          "systematic error of the model; bracket: at each point the truth may lie anywhere between both ends of "
          "its bracket of all bounces")
      ->check(CLI::IsMember(model_error_names()))
      ->capture_default_str();
  add_evaluator(command, options);
}

/// Refuses empty values of options: they would pass as options that are not there.
void refuse_empty_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    option->check([](const std::string& value) { return std::string(value.empty() ? "must not be empty" : ""); }, "");
  }
}

}  // namespace

std::unique_ptr<CLI::App> command_line(Options& options) {
  auto program = std::make_unique<CLI::App>(kDescription, "dolp");
  CLI::App& app = *program;
  app.set_version_flag("--version", fmt::format("dolp {} ({})", version(), commit()));
  app.add_flag_callback(
      "--cite", [] { throw CLI::CallForVersion(citation(), 0); }, "how to cite the program and its model");
  app.require_subcommand(0, 1);

  CLI::App* table = app.add_subcommand("table", "lookup table over the scene's grid (.nc, .csv, .npy)");
  add_run(*table, options);
  add_keep_all(*table, options);
  table->add_option("--shard", options.shard,
                    "I/N: this part of the grid, into FILE with .I-of-N before its suffix; auto: in a Slurm array");
  table->add_flag("--resume", options.resume, "go on where an interrupted run of the same scene stopped");
  add_run(*app.add_subcommand("response", "response table over the scene's theta, sigma and q, for any material (.nc)"),
          options);
  CLI::App* merge = app.add_subcommand("merge", "the shards of a table as one table");
  merge->add_option("SHARD", options.shards, "all shards of one table (.nc)")->required();
  merge->add_option("-o,--output", options.output_path, "file to write")->required();
  merge->add_flag("--json", options.json, "machine-readable report");
  merge->add_flag("--quiet", options.quiet, "no summary");
  CLI::App* eval = app.add_subcommand("eval", "the same quantities at scattered points");
  add_run(*eval, options);
  add_keep_all(*eval, options);
  eval->add_option("--points", options.points_path,
                   "CSV with any of theta_deg, sigma or wind_m_s, q, n, k, wavelength_um; - is stdin")
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
  add_fit(*app.add_subcommand("fit", "numbers of a scene from measured data, with intervals"), options);
  add_explore(*app.add_subcommand("explore", "the window: parameters, curves, map, effects and their price, live"),
              options);
  CLI::App* materials =
      app.add_subcommand("materials", "built-in materials, their ranges and sources, or n and k of one");
  CLI::Option* material = materials->add_option("NAME", options.material, "n and k of this one");
  material->needs(materials
                      ->add_option("--at", options.wavelength_um,
                                   "at this wavelength [um], or from one to another: FROM:TO or FROM:TO:COUNT")
                      ->needs(material));
  materials->add_flag("--json", options.json, "machine-readable list");
  CLI::App* devices = app.add_subcommand("devices", "Vulkan devices, and why each one is or is not usable");
  devices->add_flag("--json", options.json, "machine-readable list");
  devices->add_option("--device", options.device, "check this one: its position or a part of its name");

  CLI::App* keys = app.add_subcommand("keys", "the keys of a scene: meaning, unit, allowed values, default");
  keys->add_option("KEY", options.key, "only this one, or those of a table, e.g. surface");
  keys->add_flag("--json", options.json, "machine-readable list");
  app.add_subcommand("completion", "completions of a shell for this command line, or its manual page")
      ->add_option("FORM", options.completion, "what to print")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(kCompletions.begin(), kCompletions.end())));

  add_examples(*app.get_subcommand("table"), "dolp table scene.toml -o table.nc",
               "dolp table scene.toml -o table.csv --set surface.masking=smith --tolerance 1e-3");
  add_examples(*app.get_subcommand("response"), "dolp response scene.toml -o response.nc",
               "dolp response scene.toml -o response.nc --set surface.masking=smith --tolerance 1e-6");
  add_examples(*app.get_subcommand("merge"), "dolp merge table.*-of-4.nc -o table.nc",
               "dolp merge table.1-of-2.nc table.2-of-2.nc -o table.csv");
  add_examples(*app.get_subcommand("eval"), "dolp eval scene.toml --points points.csv -o results.csv",
               "dolp eval scene.toml --points - -o - --set emission.bracket=true < points.csv");
  add_examples(*app.get_subcommand("mueller"), "dolp mueller scene.toml --points geometries.csv -o matrices.csv",
               "dolp mueller scene.toml --points geometries.csv -o - --precision double");
  add_examples(*app.get_subcommand("plan"), "dolp plan scene.toml", "dolp plan scene.toml --tolerance 1e-6 --json");
  add_examples(*app.get_subcommand("verify"), "dolp verify table.nc", "dolp verify --hard-cases --device nvidia");
  add_examples(*app.get_subcommand("lookup"), "dolp lookup table.nc --points points.csv -o results.csv",
               "dolp lookup table.nc --points - -o - < points.csv");
  add_examples(*app.get_subcommand("fit"),
               "dolp fit scene.toml --data measured.csv --vary surface.n=1:3 --vary surface.sigma=0.01:1",
               "dolp fit scene.toml --data a.csv --vary surface.n=1:3 --compare surface.masking=smith,v-cavity");
  add_examples(*app.get_subcommand("explore"), "dolp explore", "dolp explore scene.toml --measured measured.csv");
  add_examples(*app.get_subcommand("materials"), "dolp materials", "dolp materials iron --at 8:14:25 --json");
  add_examples(*app.get_subcommand("devices"), "dolp devices", "dolp devices --device llvmpipe");
  add_examples(*app.get_subcommand("keys"), "dolp keys", "dolp keys surface.masking");
  add_examples(*app.get_subcommand("completion"),
               "dolp completion bash > ~/.local/share/bash-completion/completions/dolp",
               "dolp completion man | man -l -");
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
  return program;
}

}  // namespace dolp::cli
