#include "cli/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "base/error.hpp"
#include "base/printable_text.hpp"
#include "evaluate/named/named_evaluator.hpp"
#include "scene/scene_reader.hpp"
#include "table/result_csv.hpp"

namespace dolp::cli {

void check_output_is_no_input(const Options& options, const std::vector<std::string>& scene_files) {
  std::vector<std::string> inputs = {options.scene_path, options.points_path, options.table_path};
  inputs.insert(inputs.end(), scene_files.begin(), scene_files.end());
  for (const std::string& input : inputs) {
    std::error_code missing;  // a file that is not there is not the same file
    if (std::filesystem::equivalent(options.output_path, input, missing)) {
      throw InputError(options.output_path + ": the output would overwrite an input");
    }
  }
}

void check_one_stdin(const Options& options) {
  if (options.scene_path == "-" && options.points_path == "-") {
    throw InputError("--points -: SCENE is - too, and stdin can be read only once; name a file for one of them");
  }
}

std::vector<std::string> all_overrides(const Options& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.tolerance.empty()) overrides.push_back("accuracy.tolerance=" + options.tolerance);
  if (!options.precision.empty()) overrides.push_back("accuracy.precision=" + options.precision);
  return overrides;
}

Scene load_scene(const Options& options) { return read_scene(options.scene_path, all_overrides(options)); }

Points load_points(const Options& options, PointsKind kind) {
  Points points = read_points(options.points_path, kind, result_columns());
  if (!options.quiet && !points.left_out.empty()) {
    fmt::print(stderr, "dolp: {}: left out, because they are results: {}\n", printable_line(points.name),
               fmt::join(points.left_out, ", "));
  }
  return points;
}

std::unique_ptr<MomentsEvaluator> make_evaluator(const Options& options, const Scene& scene) {
  return dolp::make_evaluator({options.evaluator, options.device, scene.accuracy.precision});
}

}  // namespace dolp::cli
