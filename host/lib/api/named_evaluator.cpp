#include "api/evaluator_impl.hpp"

#include <dolp/errors.hpp>

#include "evaluate/cpu/cpu_evaluator.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "reference/reference_evaluator.hpp"

namespace dolp {
namespace {

// Some milliseconds of the most expensive entries on two cores.
constexpr std::uint32_t kInteractiveTileInvocations = 2'048;

}  // namespace

std::unique_ptr<ModelEvaluator> make_evaluator(const EvaluatorOptions& wanted, bool needs_double) {
  const bool is_vulkan = wanted.evaluator == "vulkan";
  if (!is_vulkan && wanted.evaluator != "cpu" && wanted.evaluator != "reference") {
    throw InputError("evaluator " + wanted.evaluator + ": is not one of vulkan, cpu, reference");
  }
  if (!is_vulkan && !wanted.device.empty()) {
    throw InputError("device " + wanted.device + ": needs the evaluator vulkan, and it is " + wanted.evaluator);
  }
  if (wanted.evaluator == "reference") return std::make_unique<ReferenceEvaluator>();
  if (!is_vulkan) return std::make_unique<CpuEvaluator>();
  VulkanOptions options;
  options.device = wanted.device;
  options.needs_double = needs_double;
  if (wanted.is_interactive) options.max_tile_invocations = kInteractiveTileInvocations;
  return std::make_unique<VulkanEvaluator>(options);
}

}  // namespace dolp
