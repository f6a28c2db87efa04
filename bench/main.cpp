// The command line of the benchmark: one subcommand for each study.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#ifdef __GLIBC__
#include <malloc.h>
#include <dolp/errors.hpp>
#endif

#include "studies/study.hpp"
#include "terminal/exit_status.hpp"
#include "terminal/guarded.hpp"

namespace dolp::bench {
namespace {

void add_common(CLI::App& study, StudyOptions& options) {
  study.add_option("--json", options.json_path, "file for the results; - is stdout, without the table");
  study.add_flag("--quick", options.quick, "few settings and short repeats: less than a minute");
  study.add_option("--device", options.device, "Vulkan device: its position or a part of its name");
  study.add_flag("--quiet", options.quiet, "no progress bar");
}

void add_entries(CLI::App& study, StudyOptions& options, const char* what) {
  study.add_option("--entries", options.entries, what)->check(CLI::Range(1, 1 << 24))->capture_default_str();
}

void add_accuracy(CLI::App& app, StudyOptions& options) {
  CLI::App* study = app.add_subcommand("accuracy", "error against time per entry, for all methods");
  add_common(*study, options);
  study->add_option("--case", options.cases, "only this case (repeatable)")->allow_extra_args(false);
  study->add_option("--method", options.methods, "only this method (repeatable)")->allow_extra_args(false);
  add_entries(*study, options, "entries of one call of dolp's evaluators; more for a GPU");
}

CLI::App* add_throughput(CLI::App& app, StudyOptions& options) {
  CLI::App* study = app.add_subcommand("throughput", "entries a second, with all axes");
  add_common(*study, options);
  study->add_option("--case", options.cases, "only this part (repeatable): grids, materials")->allow_extra_args(false);
  options.entries = std::size_t{256} * 64 * 64;
  add_entries(*study, options, "entries of the largest grid; more for a GPU");
  return study;
}

CLI::App* add_scale(CLI::App& app, StudyOptions& options) {
  CLI::App* study = app.add_subcommand("scale", "time and peak memory of tables of all sizes, and of shards");
  add_common(*study, options);
  options.entries = 100'000'000;
  study->add_option("--entries", options.entries, "entries of the largest table")->capture_default_str();
  return study;
}

CLI::App* add_fit(CLI::App& app, StudyOptions& options) {
  CLI::App* study = app.add_subcommand("fit", "synthetic measurements with a known truth, fitted");
  add_common(*study, options);
  options.entries = 200;
  add_entries(*study, options, "sets of measurements");
  study->add_option("--first-set", options.first_set, "number of the first set")->capture_default_str();
  return study;
}

CLI::App* add_kernels(CLI::App& app, StudyOptions& options) {
  CLI::App* study =
      app.add_subcommand("kernels", "registers and spilled values of the kernels, by the driver's compiler");
  add_common(*study, options);
  study->add_option("--case", options.cases, "only this precision: float, double")->allow_extra_args(false);
  return study;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("dolp-bench: dolp against other ways to compute the same moments, and against itself", "dolp-bench");
  app.set_version_flag("--version", "dolp-bench " DOLP_VERSION);
  app.require_subcommand(1);
  StudyOptions accuracy;
  accuracy.arguments.assign(argv, argv + argc);
  add_accuracy(app, accuracy);
  StudyOptions throughput = accuracy;
  StudyOptions scale = accuracy;
  const CLI::App* scale_study = add_scale(app, scale);
  StudyOptions fit = accuracy;
  const CLI::App* fit_study = add_fit(app, fit);
  StudyOptions kernels = accuracy;
  const CLI::App* kernels_study = add_kernels(app, kernels);
  const CLI::App* throughput_study = add_throughput(app, throughput);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(std::string(error.what()) + " (see dolp-bench --help)");
  }
  if (throughput_study->parsed()) {
    run_throughput(throughput);
  } else if (scale_study->parsed()) {
    run_scale(scale);
  } else if (fit_study->parsed()) {
    run_fit_study(fit);
  } else if (kernels_study->parsed()) {
    run_kernels(kernels);
  } else {
    run_accuracy(accuracy);
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
