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
  bool changes_code = false;  ///< of kernels, which Mesa's cache on disk does not know: each setting gets its own
};

/// Runs `dolp-bench throughput --case kernels` with each setting, `rounds` times in turns, so that other load on the
/// machine spreads over all. A row for each setting and masking, in this order: case, setting, entries, time_s,
/// time_min_s, speedup over the first setting (by the minima) and raw_times_s.
/// Errors: Unavailable when a process fails; IoError.
std::vector<nlohmann::ordered_json> kernels_with(const DriverVariable& variable, const StudyOptions& options,
                                                 std::size_t entries, std::size_t rounds);

}  // namespace dolp::bench
