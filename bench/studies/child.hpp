// Programs that the benchmark runs.
#pragma once

#include <string>
#include <vector>

namespace dolp::bench {

/// The output and exit status of a program.
struct ChildOutcome {
  int status = 0;
  std::string out;
};

/// Shows or discards the stderr of a program.
enum class ChildErrors { kShown, kHidden };

/// Runs a program to its end. Errors: Unavailable if the process does not start.
ChildOutcome run_child(const std::vector<std::string>& arguments, ChildErrors errors);

/// Path of the running program.
std::string own_program();

}  // namespace dolp::bench
