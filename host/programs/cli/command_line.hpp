// The commands and their options, for parsing, help, completions and the manual page.
#pragma once

#include <CLI/App.hpp>
#include <memory>

#include "cli/options.hpp"

namespace dolp::cli {

/// The command line; parsing it fills `options`, which must outlive it.
std::unique_ptr<CLI::App> command_line(Options& options);

}  // namespace dolp::cli
