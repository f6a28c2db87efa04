// Reports that calls of the public header give of their work.
#pragma once

#include <dolp/dolp.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "report/report.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// `output`: the file that was written.
Report public_report(const ReportBuilder& report, bool is_good = true, const std::filesystem::path& output = {});

/// The files that a scene is read from.
std::vector<std::string> files_of(const SceneValues& scene);

/// Refuses to write over what is read. "-" is stdin and stdout. Errors: InputError.
void check_output_is_no_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

}  // namespace dolp
