#include "cli/options.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/interpolation/interpolating_evaluator.hpp"
#include "evaluate/reference/reference_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "scene/scene_reader.hpp"

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

std::unique_ptr<MomentsEvaluator> make_evaluator(const Options& options, const Scene& scene) {
  if (options.evaluator == "reference") return std::make_unique<ReferenceEvaluator>();
  std::unique_ptr<MomentsEvaluator> evaluator;
  if (options.evaluator == "cpu") {
    evaluator = std::make_unique<CpuEvaluator>(scene.accuracy.precision);
  } else {
    VulkanOptions vulkan;
    vulkan.device = options.device;
    vulkan.precision = scene.accuracy.precision;
    evaluator = std::make_unique<VulkanEvaluator>(vulkan);
  }
  return std::make_unique<InterpolatingEvaluator>(std::move(evaluator));
}

}  // namespace dolp::cli
