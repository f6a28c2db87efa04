#include "cli/options.hpp"

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/reference/reference_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::cli {

Scene load_scene(const Options& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.tolerance.empty()) overrides.push_back("accuracy.tolerance=" + options.tolerance);
  if (!options.precision.empty()) overrides.push_back("accuracy.precision=" + options.precision);
  return read_scene(options.scene_path, overrides);
}

std::unique_ptr<MomentsEvaluator> make_evaluator(const Options& options, const Scene& scene) {
  if (options.evaluator == "cpu") return std::make_unique<CpuEvaluator>(scene.accuracy.precision);
  if (options.evaluator == "reference") return std::make_unique<ReferenceEvaluator>();
  VulkanOptions vulkan;
  vulkan.device = options.device;
  vulkan.precision = scene.accuracy.precision;
  return std::make_unique<VulkanEvaluator>(vulkan);
}

}  // namespace dolp::cli
