// Measures how an environment variable of the Vulkan driver changes the time of the kernels.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "studies/study.hpp"

namespace dolp::bench {

/// An environment variable that lavapipe reads once per process.
struct DriverVariable {
  std::string name;
  std::vector<unsigned> settings;
  /// True if the variable changes the machine code of kernels. Mesa's cache of machine code ignores the variable, so
  /// each setting gets a separate cache folder.
  bool changes_code = false;
};

/// Runs `dolp-bench throughput --case kernels` in `rounds` rounds. Each round starts one process per setting, so that
/// other load on the machine affects all settings equally. Returns one row per setting and masking. The keys of a
/// row are `case` (the masking), `setting`, `entries`, `time_s`, `time_min_s`, `raw_times_s` and `speedup`: the minimum
/// time of the first setting, divided by the minimum time of the row. Errors: Unavailable if a process fails; IoError.
std::vector<nlohmann::ordered_json> kernels_with(const DriverVariable& variable, const StudyOptions& options,
                                                 std::size_t entries, std::size_t rounds);

}  // namespace dolp::bench
