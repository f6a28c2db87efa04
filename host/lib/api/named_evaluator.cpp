#include "api/named_evaluator.hpp"

#include <utility>

#include "base/error.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/interpolation/interpolating_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "reference/reference_evaluator.hpp"

namespace dolp {
namespace {

// On two cores some milliseconds of the dearest entries.
constexpr std::uint32_t kInteractiveTileInvocations = 2'048;

}  // namespace

std::unique_ptr<MomentsEvaluator> make_evaluator(const EvaluatorChoice& choice) {
  const bool is_vulkan = choice.name == "vulkan";
  if (!is_vulkan && choice.name != "cpu" && choice.name != "reference") {
    throw InputError("evaluator " + choice.name + ": is not one of vulkan, cpu, reference");
  }
  if (!is_vulkan && !choice.device.empty()) {
    throw InputError("device " + choice.device + ": needs the evaluator vulkan, and it is " + choice.name);
  }
  if (choice.name == "reference") return std::make_unique<ReferenceEvaluator>();
  std::unique_ptr<MomentsEvaluator> evaluator;
  if (is_vulkan) {
    VulkanOptions options;
    options.device = choice.device;
    options.precision = choice.precision;
    if (choice.is_interactive) options.max_tile_invocations = kInteractiveTileInvocations;
    evaluator = std::make_unique<VulkanEvaluator>(options);
  } else {
    evaluator = std::make_unique<CpuEvaluator>(choice.precision);
  }
  return std::make_unique<InterpolatingEvaluator>(std::move(evaluator));
}

}  // namespace dolp
