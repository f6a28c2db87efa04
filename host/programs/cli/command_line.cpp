#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <dolp/dolp.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/text.hpp"
#include "cli/commands.hpp"
#include "explore/panels.hpp"

namespace dolp::cli {
namespace {

struct CommandRow {
  const char* name;
  int (*run)(const Options&);
  const char* description;
  const char* examples;
};

constexpr CommandRow kCommands[] = {
    {"table", run_table, "lookup table over the scene's grid (.nc, .csv, .npy)",
     "dolp table scene.toml -o table.nc\n"
     "  dolp table scene.toml -o table.csv --set surface.masking=smith --tolerance 1e-3"},
    {"response", run_response, "response table over the scene's theta, sigma and q, for any material (.nc)",
     "dolp response scene.toml -o response.nc\n"
     "  dolp response scene.toml -o response.nc --set surface.masking=smith --tolerance 1e-6"},
    {"merge", run_merge, "the shards of a table as one table",
     "dolp merge table.*-of-4.nc -o table.nc\n  dolp merge table.1-of-2.nc table.2-of-2.nc -o table.csv"},
    {"eval", run_eval, "the same quantities at scattered points",
     "dolp eval scene.toml --points points.csv -o results.csv\n"
     "  dolp eval scene.toml --points - -o - --set emission.bracket=true < points.csv"},
    {"mueller", run_mueller, "4 x 4 Mueller pBRDF [1/sr] at scattered geometries",
     "dolp mueller scene.toml --points geometries.csv -o matrices.csv\n"
     "  dolp mueller scene.toml --points geometries.csv -o -"},
    {"plan", run_plan, "what a table would compute and leave out, why, and what it would cost",
     "dolp plan scene.toml\n  dolp plan scene.toml --tolerance 1e-6 --json"},
    {"verify", run_verify, "recompute entries of a table, or examine a device",
     "dolp verify table.nc\n  dolp verify --hard-cases --device nvidia"},
    {"lookup", run_lookup, "values between the entries of a table, computed from its scene",
     "dolp lookup table.nc --points points.csv -o results.csv\n  dolp lookup table.nc --points - -o - < points.csv"},
    {"fit", run_fit, "numbers of a scene from measured data, with intervals",
     "dolp fit scene.toml --data measured.csv --vary surface.n=1:3 --vary surface.sigma=0.01:1\n"
     "  dolp fit scene.toml --data a.csv --vary surface.n=1:3 --compare surface.masking=smith,v-cavity"},
    {"explore", run_explore, "the window: parameters, curves, map, effects and their price, live",
     "dolp explore\n  dolp explore scene.toml --measured measured.csv"},
    {"materials", run_materials, "built-in materials, their ranges and sources, or n and k of one",
     "dolp materials\n  dolp materials --at 10.6\n  dolp materials iron --at 8:14:25 --json"},
    {"devices", run_devices, "Vulkan devices, and why each one is or is not usable",
     "dolp devices\n  dolp devices --device llvmpipe"},
    {"keys", run_keys, "the keys of a scene: meaning, unit, allowed values, default",
     "dolp keys\n  dolp keys surface.masking"},
    {"completion", run_completion, "completions of a shell for this command line, or its manual page",
     "dolp completion bash > ~/.local/share/bash-completion/completions/dolp\n  dolp completion man | man -l -"}};

/// An option, a flag, or a positional argument. The name of a positional argument has no hyphens.
struct OptionRow {
  const char* commands;  ///< the commands with this option; "table plan!" means that `plan` requires the option
  const char* name;
  std::variant<bool Options::*, std::string Options::*, std::size_t Options::*, std::vector<std::string> Options::*>
      value;
  std::string description;
  std::optional<CLI::Validator> check = {};
};

CLI::Validator range_to(std::size_t most) { return CLI::Range(std::size_t{1}, most); }

/// Refuses values with a minus sign, which the conversion to an unsigned type would turn into huge numbers.
CLI::Validator not_negative() {
  return {[](const std::string& value) {
            return value.starts_with('-') ? "must be a whole number from 0, not " + value : "";
          },
          ""};
}

std::vector<OptionRow> option_rows() {
  constexpr const char* kPointColumns =
      "CSV with any of theta_deg, sigma or wind_m_s, q, n, k and the other axes of tables; - is stdin";
  return {
      {"table! response! eval! mueller! plan! fit!", "SCENE", &Options::scene_path,
       "scene file (TOML), or table (.nc), whose scene counts; - is stdin"},
      {"explore", "SCENE", &Options::scene_path,
       "scene or session of the window (TOML), or table (.nc); - is stdin; without it, paint at night"},
      {"verify", "TABLE", &Options::table_path, "table file (.nc) that dolp table wrote"},
      {"lookup!", "TABLE", &Options::scene_path, "table file (.nc) that dolp table wrote"},
      {"merge!", "SHARD", &Options::shards, "all shards of one table (.nc)"},
      {"materials", "NAME", &Options::material, "only this one"},
      {"keys", "KEY", &Options::key, "only this one, or the keys of a table, e.g. surface"},
      {"completion!", "FORM", &Options::completion, "what to print",
       CLI::IsMember({"bash", "zsh", "fish", "words", "man"})},
      {"completion", "WORD", &Options::words, "line to complete, for the form words"},
      {"eval! lookup!", "--points", &Options::points_path, kPointColumns},
      {"mueller!", "--points", &Options::points_path,
       "CSV with theta_i_deg, theta_r_deg, delta_phi_deg and any of sigma, q, n, k; - is stdin"},
      {"fit!", "--data", &Options::data,
       "CSV with theta_deg, one of dolp, q_over_i, emissivity_s, and any of uncertainty, wavelength_um; - is stdin; "
       "FILE:KEY=VALUE,... sets scene keys for it; repeatable"},
      {"fit!", "--vary", &Options::vary,
       "KEY=LOW:HIGH or KEY=LOW:HIGH:START: a number of the scene to find; repeatable"},
      {"fit", "--compare", &Options::compare, "KEY=WORD,WORD,...: fit with each and rank them; repeatable"},
      {"table! response! eval! mueller! lookup!", "-o,--output", &Options::output_path, "file to write; - is stdout"},
      {"merge!", "-o,--output", &Options::output_path, "file to write"},
      {"fit", "-o,--output", &Options::output_path, "file for the fitted scene; - is stdout"},
      {"fit", "--plot", &Options::plot_path, ".png, .pdf or .svg of data, fit and residuals, drawn with Matplotlib"},
      {"table", "--shard", &Options::shard,
       "I/N: this part of the grid, into FILE with .I-of-N before its suffix; auto: in a Slurm array"},
      {"table", "--quantities", &Options::quantities,
       "NAME,NAME,...: the variables to write, e.g. dolp,error_estimate,status; all when not given"},
      {"table eval lookup", "--derivatives", &Options::derivatives,
       "KEY,KEY,...: derivatives of dolp and q_over_i by numbers of the scene, e.g. surface.n,surface.sigma"},
      {"table", "--resume", &Options::resume, "continue where an interrupted run of the same scene stopped"},
      {"table response eval mueller plan fit explore", "--set", &Options::overrides,
       "KEY=VALUE: any scene key, e.g. surface.masking=none"},
      {"table response eval mueller plan lookup fit explore", "--tolerance", &Options::tolerance,
       "the scene's accuracy.tolerance: " + allowed("accuracy.tolerance")},
      {"verify", "--tolerance", &Options::tolerance,
       "requested tolerance: " + allowed("accuracy.tolerance") + "; 1e-4 when not given"},
      {"table response eval mueller plan lookup fit explore", "--precision", &Options::precision,
       "the scene's accuracy.precision: " + allowed("accuracy.precision")},
      {"verify", "--precision", &Options::precision, "auto is both", CLI::IsMember({"auto", "float", "double"})},
      {"table response eval mueller plan lookup fit explore verify devices", "--device", &Options::device,
       "Vulkan device: its position or a part of its name"},
      {"table response eval mueller lookup fit", "--evaluator", &Options::evaluator,
       "vulkan; cpu: the same text on the CPU; reference: independent adaptive quadrature; by default the evaluator of "
       "the table, or vulkan",
       CLI::IsMember({"vulkan", "cpu", "reference"})},
      {"verify", "--evaluator", &Options::evaluator, "vulkan; cpu: the same text on the CPU",
       CLI::IsMember({"vulkan", "cpu"})},
      {"table eval plan lookup", "--keep-all", &Options::keep_all,
       "compute every effect that the scene has, however little it counts"},
      {"verify", "--samples", &Options::samples, "entries to recompute; all when the table has no more",
       range_to(std::size_t{1} << 24U)},
      {"verify", "--between", &Options::between,
       "compute so many random points between the entries, and report what linear and cubic interpolation cost there",
       range_to(100'000)},
      {"verify", "--quantities", &Options::quantities, "NAME,...: for --between; dolp when not given"},
      {"verify fit", "--seed", &Options::seed, "seed of the entries to recompute, or of the first points of a fit",
       not_negative()},
      {"verify", "--named-files", &Options::named_files,
       "take n, k and E0 from the files that the scene names, not from the table"},
      {"verify", "--hard-cases", &Options::hard_cases,
       "examine a device with the model's hard cases, in float and double"},
      {"verify", "--all", &Options::all, "report every case"},
      {"fit", "--starts", &Options::starts, "descents that look for minima", range_to(kMostStarts)},
      {"fit", "--loss", &Options::loss, fmt::format("what a residual counts: {}", fmt::join(loss_names(), ", ")),
       CLI::IsMember(loss_names())},
      {"fit", "--model-error", &Options::model_error,
       "systematic error of the model; bracket: at each point the truth may lie anywhere between both ends of its "
       "bracket of all bounces",
       CLI::IsMember(model_error_names())},
      {"explore", "--measured", &Options::measured_path, "CSV of measured points with the columns theta_deg, dolp"},
      {"explore", "--frames", &Options::frames, "draw so many frames, print how long they took, and end",
       range_to(1'000'000)},
      {"explore", "--view", &Options::panel, "panel beside the curve",
       CLI::IsMember(std::vector<std::string>(explore::kPanelNames.begin(), explore::kPanelNames.end()))},
      {"explore", "--screenshot", &Options::screenshot_path, "PNG of the last frame, when all is computed"},
      {"materials", "--at", &Options::wavelength_um,
       "at this wavelength [um], or from one to another: FROM:TO or FROM:TO:COUNT"},
      {"table response merge eval mueller plan verify lookup fit materials devices keys", "--json", &Options::json,
       "machine-readable report"},
      {"table response merge eval mueller verify lookup fit", "--quiet", &Options::quiet,
       "no report and no progress bar"},
      {"table response eval mueller lookup fit", "--strict", &Options::strict,
       "exit 1 if any entry misses its tolerance"}};
}

/// Refuses an empty value: an empty text in Options means that the user has not given the option.
std::string not_empty(const std::string& value) { return value.empty() ? "must not be empty" : ""; }

CLI::Option* add_option(CLI::App& command, const OptionRow& row, Options& options) {
  return std::visit(
      [&](auto member) {
        auto& value = options.*member;
        if constexpr (std::is_same_v<decltype(member), bool Options::*>) {
          return command.add_flag(row.name, value, row.description);
        } else {
          CLI::Option* option = command.add_option(row.name, value, row.description);
          if constexpr (std::is_same_v<decltype(member), std::vector<std::string> Options::*>) {
            if (row.name[0] == '-') option->allow_extra_args(false);
          } else {
            option->capture_default_str();
          }
          if (row.check) option->check(*row.check);
          return option->check(not_empty, "");
        }
      },
      row.value);
}

void add_conditions(CLI::App& verify) {
  for (const char* option : {"--samples", "--seed", "--named-files"})
    verify.get_option(option)->needs(verify.get_option("TABLE"));
  verify.get_option("--between")->needs(verify.get_option("TABLE"))->excludes(verify.get_option("--samples"));
  verify.get_option("--quantities")->needs(verify.get_option("--between"));
  for (const char* option : {"--device", "--precision", "--evaluator", "--tolerance", "--all"})
    verify.get_option(option)->needs(verify.get_option("--hard-cases"));
  verify.get_option("--hard-cases")->excludes(verify.get_option("TABLE"));
}

}  // namespace

std::unique_ptr<CLI::App> command_line(Options& options) {
  auto app = std::make_unique<CLI::App>(
      "dolp: infrared degree of linear polarisation of rough surfaces, on any Vulkan device", "dolp");
  app->set_version_flag("--version", fmt::format("dolp {} ({})", version(), commit()));
  app->add_flag_callback(
      "--cite", [] { throw CLI::CallForVersion(citation(), 0); }, "how to cite the program and its model");
  app->require_subcommand(0, 1);
  const std::vector<OptionRow> rows = option_rows();
  for (const CommandRow& row : kCommands) {
    CLI::App& command = *app->add_subcommand(row.name, row.description);
    command.callback([&options, run = row.run] { options.run = run; });
    command.footer(std::string("Examples:\n  ") + row.examples);
    for (const OptionRow& option : rows) {
      for (const std::string_view name : split(option.commands, ' ')) {
        const bool is_required = name.ends_with('!');
        if (name.substr(0, name.size() - (is_required ? 1 : 0)) != row.name) continue;
        add_option(command, option, options)->required(is_required);
      }
    }
  }
  add_conditions(*app->get_subcommand("verify"));
  return app;
}

}  // namespace dolp::cli
