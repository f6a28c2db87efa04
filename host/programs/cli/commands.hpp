// The commands of the program; each returns the exit status of a run without an error (terminal/exit_status.hpp).
// command_line.cpp says what each does.
#pragma once

#include <CLI/App.hpp>
#include <memory>

#include "cli/options.hpp"

namespace dolp::cli {

/// The commands and their options, for parsing, help, completions and the manual page. Parsing fills `options`, which
/// must outlive it.
std::unique_ptr<CLI::App> command_line(Options& options);

int run_table(const Options& options);
int run_response(const Options& options);
int run_merge(const Options& options);
int run_eval(const Options& options);
int run_mueller(const Options& options);
int run_plan(const Options& options);
/// kExitAccuracy if a stated error is too small or a tolerance is missed without the status that says so.
int run_verify(const Options& options);
int run_lookup(const Options& options);
/// kExitAccuracy if no minimum is found.
int run_fit(const Options& options);
int run_explore(const Options& options);
int run_materials(const Options& options);
int run_keys(const Options& options);
int run_devices(const Options& options);
int run_completion(const Options& options);

}  // namespace dolp::cli
