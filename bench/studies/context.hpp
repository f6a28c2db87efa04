// The machine and the settings of a study's run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dolp::bench {

/// The arguments as a line for the shell, quoted where necessary.
std::string shell_line(const std::vector<std::string>& arguments);

/// The context of a run: machine, system, Vulkan device, compiler with flags, versions, date, and the command that
/// repeats the run. `device` is the value of --device.
nlohmann::ordered_json context_json(const std::string& device, const std::vector<std::string>& arguments);

}  // namespace dolp::bench
