#pragma once

#include <CLI/App.hpp>
#include <cstddef>
#include <dolp/dolp.hpp>
#include <memory>
#include <string>
#include <vector>

namespace dolp::cli {

/// The values of all options of the command line. An empty text means that the user has not given the option.
struct Options {
  int (*run)(const Options&) = nullptr;  ///< function of the command; null if there is no command
  std::string command_line;              ///< all words of the command line; a table stores them as its history
  std::string scene_path, points_path, table_path, output_path, measured_path, plot_path, screenshot_path;
  std::vector<std::string> overrides;  ///< the texts KEY=VALUE of --set
  std::string tolerance, precision, device, evaluator;
  bool json = false, quiet = false, strict = false, keep_all = false;
  std::string shard, quantities, derivatives;
  std::vector<std::string> shards;
  bool resume = false;
  std::size_t samples = 64, seed = 1, between = 0;
  bool named_files = false, hard_cases = false, all = false;
  std::vector<std::string> data, vary, compare;
  std::size_t starts = 24;
  std::string loss = "squares", model_error = "none";
  std::size_t frames = 0;  ///< number of frames to draw; 0: until the user closes the window
  std::string panel;
  std::string key, material, wavelength_um;
  std::string completion;
  std::vector<std::string> words;
};

std::string allowed(const std::string& key);  ///< values that a scene key allows: "a number in [0, 10]"

/// Prints a report: with --json as JSON, otherwise as text unless --quiet. With `-o -` it goes to stderr.
void print(const Report& report, const Options& options);

/// Prints a report and its remarks. Returns kExitAccuracy if --strict is given and Report::is_good is false.
int finish(const Report& report, const Options& options);

/// The parser of the command line. Parsing fills `options`, which must outlive the result.
std::unique_ptr<CLI::App> command_line(Options& options);

// Each command returns an exit status of terminal/terminal.hpp, or throws an error, which guarded() converts to one.
int run_table(const Options& options);
int run_response(const Options& options);
int run_merge(const Options& options);
int run_eval(const Options& options);
int run_mueller(const Options& options);
int run_plan(const Options& options);
/// Returns kExitAccuracy if a value is wrong: for example, if its error exceeds its error bound, or if it misses its
/// tolerance and the status of its entry does not say so.
int run_verify(const Options& options);
int run_lookup(const Options& options);  ///< run_eval() for the scene of a table
int run_fit(const Options& options);     ///< returns kExitAccuracy if the fit finds no minimum
int run_explore(const Options& options);
int run_materials(const Options& options);
int run_keys(const Options& options);
int run_devices(const Options& options);
int run_completion(const Options& options);

}  // namespace dolp::cli
