// The parsed command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <dolp/dolp.hpp>
#include <string>
#include <vector>

namespace dolp::cli {

struct Options {
  std::string scene_path;
  std::string points_path;
  std::string table_path;  ///< of verify and lookup
  std::string output_path;
  std::string shard;                   ///< of table: "I/N" or "auto"; empty: all of it
  bool resume = false;                 ///< of table: go on with what an interrupted run left
  std::vector<std::string> shards;     ///< of merge
  std::vector<std::string> overrides;  ///< --set KEY=VALUE
  std::string tolerance;               ///< as typed; empty when not given
  std::string precision;               ///< likewise
  std::string device;
  std::string evaluator = "vulkan";  ///< vulkan | cpu | reference
  bool json = false;
  bool quiet = false;
  bool strict = false;
  bool keep_all = false;             ///< drop no effect
  std::size_t samples = 64;          ///< of verify: entries to recompute
  std::uint64_t seed = 1;            ///< of verify: of their choice
  bool named_files = false;          ///< of verify: n, k and E0 from the files that the scene names
  bool hard_cases = false;           ///< of verify: examine a device instead of a table
  bool all = false;                  ///< of verify: report every hard case
  std::size_t frames = 0;            ///< of explore: draw so many and end; 0: until the window is closed
  std::string screenshot_path;       ///< of explore
  std::string panel;                 ///< of explore: the view beside the curve
  std::string measured_path;         ///< of explore
  std::vector<std::string> data;     ///< of fit: FILE or FILE:KEY=VALUE,...
  std::vector<std::string> vary;     ///< of fit: KEY=LOW:HIGH or KEY=LOW:HIGH:START
  std::vector<std::string> compare;  ///< of fit: KEY=WORD,WORD,...
  std::size_t starts = 24;           ///< of fit
  std::string loss = "squares";      ///< of fit
  std::string model_error = "none";  ///< likewise
  std::string plot_path;             ///< of fit
  std::string key;                   ///< of keys: one of them, or a table; empty: all
  std::string material;              ///< of materials: one of them; empty: all
  std::string wavelength_um;         ///< of materials: as typed
  std::string completion;            ///< of completion: one of kCompletions
  std::string command_line;          ///< for the table's history
};

/// Refuses to read two inputs from stdin. Errors: InputError.
void check_one_stdin(const Options& options);

/// All settings of the command line: --set first, then --tolerance and --precision. Errors: InputError.
std::vector<Setting> all_settings(const Options& options);

/// The allowed values of a scene key: "a number in [0, 10]".
std::string allowed(const std::string& key);

/// The scene with all_settings and then `more`, after a warning on stderr for each of its remarks.
Scene load_scene(const Options& options, const std::vector<Setting>& more = {});

/// The evaluator that --evaluator and --device ask for.
Evaluator evaluator_of(const Options& options);

/// Prints a report as --json and --quiet ask for: to stdout, or to stderr when the results themselves go to stdout.
void print(const Report& report, const Options& options);

/// Prints a report and its remarks; returns the exit status that --strict asks for.
int finish(const Report& report, const Options& options);

}  // namespace dolp::cli
