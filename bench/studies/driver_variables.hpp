// Effect of an environment variable of the Vulkan driver on the kernels' time.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "studies/study.hpp"

namespace dolp::bench {

/// An environment variable that lavapipe reads once in a process.
struct DriverVariable {
  std::string name;
  std::vector<unsigned> settings;
  /// the variable changes the code of kernels. Mesa's cache on disk ignores it, so each setting gets a separate cache.
  bool changes_code = false;
};

/// Runs `dolp-bench throughput --case kernels` `rounds` times with each setting, in turns, so that other load on the
/// machine affects all settings equally. Returns a row for each setting and masking: case, setting, entries, time_s,
/// time_min_s, speedup over the first setting (from the minima) and raw_times_s.
/// Errors: Unavailable if a process fails; IoError.
std::vector<nlohmann::ordered_json> kernels_with(const DriverVariable& variable, const StudyOptions& options,
                                                 std::size_t entries, std::size_t rounds);

}  // namespace dolp::bench
