// The study of the kernels: what the driver's compiler makes of them.
#include <fmt/format.h>

#include <chrono>
#include <dolp/errors.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/stopwatch.hpp"
#include "device/result.hpp"
#include "evaluate/vulkan/kernels.hpp"
#include "methods/bench_device.hpp"
#include "plan/rows.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;
using vulkan::EntryPoint;
using vulkan::KernelVariant;

struct NamedKernel {
  std::string name;
  KernelVariant variant;
};

/// Kernels of all kinds, with the most columns. Gaussian kernels are shorter than Cauchy kernels, which stand for both.
std::vector<NamedKernel> named_kernels() {
  using enum Masking;
  constexpr EntryPoint kSlopes = EntryPoint::kSlopes;
  constexpr std::uint32_t kSkyColumns = DOLP_SKY_FUNCTIONS;
  constexpr std::uint32_t kResponses = DOLP_COLUMNS;
  constexpr std::uint32_t kResponseKind = DOLP_COLUMNS_RESPONSE;
  return {{"integral", {.masking = kIntegral}},
          {"integral, total reflection", {.masking = kIntegral, .has_total_reflection = true}},
          {"integral, films", {.masking = kIntegral, .has_curves = true}},
          {"integral, direct emission", {.masking = kIntegral, .has_direct = true}},
          {"integral, sky", {.masking = kIntegral, .columns = kSkyColumns}},
          {"integral, responses", {.masking = kIntegral, .columns = kResponses, .column_kind = kResponseKind}},
          {"integral, responses, total reflection",
           {.masking = kIntegral, .has_total_reflection = true, .columns = kResponses, .column_kind = kResponseKind}},
          {"smith", {.masking = kSmith}},
          {"smith, responses", {.masking = kSmith, .columns = kResponses, .column_kind = kResponseKind}},
          {"rows of four, integral", {.masking = kIntegral, .width = kRowWidth}},
          {"rows of four, smith", {.masking = kSmith, .width = kRowWidth}},
          {"rows of four, integral, sky", {.masking = kIntegral, .columns = kSkyColumns, .width = kRowWidth}},
          {"rows of four, integral, responses",
           {.masking = kIntegral, .columns = kResponses, .column_kind = kResponseKind, .width = kRowWidth}},
          {"masking table", {.entry = EntryPoint::kMaskingTable, .masking = kIntegral}},
          {"none", {.entry = kSlopes}},
          {"v-cavity", {.entry = kSlopes, .masking = kVCavity}},
          {"v-cavity, total reflection", {.entry = kSlopes, .masking = kVCavity, .has_total_reflection = true}},
          {"v-cavity, sky", {.entry = kSlopes, .masking = kVCavity, .columns = kSkyColumns}},
          {"v-cavity, responses",
           {.entry = kSlopes, .masking = kVCavity, .columns = kResponses, .column_kind = kResponseKind}},
          {"v-cavity, orders", {.entry = kSlopes, .masking = kVCavity, .has_orders = true}},
          {"all bounces", {.entry = kSlopes, .masking = kVCavity, .is_multiple = true}},
          {"all bounces, orders", {.entry = kSlopes, .masking = kVCavity, .is_multiple = true, .has_orders = true}},
          {"all bounces, orders, sky",
           {.entry = kSlopes, .masking = kVCavity, .is_multiple = true, .columns = kSkyColumns, .has_orders = true}}};
}

struct NamedPrecision {
  std::string name;
  bool float64 = false;
};

const std::vector<NamedPrecision> kPrecisions = {{"float", false}, {"double", true}};

template <class Function>
Function device_function(const vulkan::Device& device, const char* name) {
  return reinterpret_cast<Function>(vkGetDeviceProcAddr(device.get(), name));
}

double number(const VkPipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
      return statistic.value.b32 == VK_TRUE ? 1.0 : 0.0;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
      return static_cast<double>(statistic.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
      return static_cast<double>(statistic.value.u64);
    default:
      return statistic.value.f64;
  }
}

/// The statistics of a pipeline by the names that the driver gives them. A driver may compile a kernel several times,
/// for example with other subgroups; the first executable counts.
ordered_json statistics(const vulkan::Device& device, VkPipeline pipeline) {
  const auto list =
      device_function<PFN_vkGetPipelineExecutableStatisticsKHR>(device, "vkGetPipelineExecutableStatisticsKHR");
  const VkPipelineExecutableInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
  std::uint32_t count = 0;
  vulkan::check(list(device.get(), &info, &count, nullptr), "listing the statistics of a pipeline");
  std::vector<VkPipelineExecutableStatisticKHR> all(count,
                                                    {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
  vulkan::check(list(device.get(), &info, &count, all.data()), "listing the statistics of a pipeline");
  ordered_json json;
  for (const VkPipelineExecutableStatisticKHR& statistic : all) json[statistic.name] = number(statistic);
  return json;
}

void measure_kernels(StudyRun& run) {
  run.describe("kernels", "none", "seconds that the driver needs to compile the kernel");
  const std::vector<NamedKernel> all = named_kernels();
  const std::vector<NamedPrecision> precisions = chosen(kPrecisions, run.options().cases, "--case");
  run.expect(precisions.size() * all.size());
  const vulkan::Instance instance(nullptr);
  VkPhysicalDevice const physical = chosen_device(instance, run.options().device);
  for (const auto& [precision, float64] : precisions) {
    const vulkan::Device device(physical, {.float64 = float64, .statistics = true});
    vulkan::Kernels kernels(device, float64);
    for (const NamedKernel& kernel : all) {
      const auto begin = std::chrono::steady_clock::now();
      const VkPipeline pipeline = kernels.pipeline(kernel.variant);
      const double time_s = seconds_since(begin);
      run.finish({{"method", "dolp Vulkan"},
                  {"case", kernel.name},
                  {"setting", precision},
                  {"time_s", time_s},
                  {"statistics", statistics(device, pipeline)},
                  {"raw_times_s", {time_s}}});
    }
  }
}

std::string kernels_table(const ordered_json& result) {
  std::string text;
  for (const ordered_json& row : result["results"]) {
    text += fmt::format("{:<40} {:<7}", row["case"].get<std::string>(), row["setting"].get<std::string>());
    for (const auto& [name, value] : row["statistics"].items())
      text += fmt::format(" {} {:g};", name, value.get<double>());
    text += "\n";
  }
  return text;
}

}  // namespace

void run_kernels(const StudyOptions& options) {
  run_study(options, {.measure = measure_kernels, .table_text = kernels_table});
}

}  // namespace dolp::bench
