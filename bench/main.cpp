// The command line of the benchmark: one subcommand for each study.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <limits>
#include <string>
#ifdef __GLIBC__
#include <malloc.h>
#include <dolp/errors.hpp>
#endif

#include "studies/study.hpp"
#include "terminal/terminal.hpp"

namespace dolp::bench {
namespace {

/// A subcommand. Empty texts: it lacks the option.
struct StudyRow {
  const char* name;
  const char* what;
  void (*run)(const StudyOptions& options);
  std::size_t entries;
  const char* what_entries;
  const char* what_case;
};

constexpr std::array<StudyRow, 5> kStudies = {
    {{"accuracy", "error against time per entry, for all methods", run_accuracy, 1024,
      "entries of one call of dolp's evaluators; more for a GPU", "only this case (repeatable)"},
     {"throughput", "entries a second, with all axes", run_throughput, std::size_t{256} * 64 * 64,
      "entries of the largest grid; more for a GPU", "only this part (repeatable): grids, materials"},
     {"scale", "time and peak memory of tables of all sizes, and of shards", run_scale, 100'000'000,
      "entries of the largest table", ""},
     {"fit", "synthetic measurements with a known truth, fitted", run_fit_study, 200, "sets of measurements", ""},
     {"kernels", "registers and spilled values of the kernels, by the driver's compiler", run_kernels, 0, "",
      "only this precision: float, double"}}};

void add_study(CLI::App& app, const StudyRow& row, StudyOptions& options) {
  const std::string name = row.name;
  CLI::App* const study = app.add_subcommand(name, row.what);
  study->add_option("--json", options.json_path, "file for the results; - is stdout, without the table");
  study->add_flag("--quick", options.quick, "few settings and short repeats: less than a minute");
  study->add_option("--device", options.device, "Vulkan device: its position or a part of its name");
  study->add_flag("--quiet", options.quiet, "no progress bar");
  if (*row.what_case != '\0') study->add_option("--case", options.cases, row.what_case)->allow_extra_args(false);
  if (*row.what_entries != '\0') {
    options.entries = row.entries;
    study->add_option("--entries", options.entries, row.what_entries)
        ->check(CLI::Range(std::size_t{1}, std::numeric_limits<std::size_t>::max()))
        ->capture_default_str();
  }
  if (name == "accuracy")
    study->add_option("--method", options.methods, "only this method (repeatable)")->allow_extra_args(false);
  if (name == "fit")
    study->add_option("--first-set", options.first_set, "number of the first set")->capture_default_str();
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("dolp-bench: dolp against other ways to compute the same moments, and against itself", "dolp-bench");
  app.set_version_flag("--version", "dolp-bench " DOLP_VERSION);
  app.require_subcommand(1);
  std::array<StudyOptions, kStudies.size()> options;
  for (std::size_t i = 0; i < kStudies.size(); ++i) {
    options[i].arguments.assign(argv, argv + argc);
    add_study(app, kStudies[i], options[i]);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(std::string(error.what()) + " (see dolp-bench --help)");
  }
  for (std::size_t i = 0; i < kStudies.size(); ++i) {
    if (app.got_subcommand(kStudies[i].name)) kStudies[i].run(options[i]);
  }
  if (std::fflush(stdout) != 0) throw IoError("standard output: cannot write the table");
  return kExitDone;
}

// Keeps freed memory in the process, so that the repeats of a study reuse it. By default glibc returns large blocks to
// the system, and each repeat of a large grid would spend time on new memory pages.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
#endif
}

}  // namespace
}  // namespace dolp::bench

int main(int argc, char** argv) {
  dolp::bench::keep_freed_memory();
  return dolp::guarded("dolp-bench", [&] { return dolp::bench::parse_and_run(argc, argv); });
}
