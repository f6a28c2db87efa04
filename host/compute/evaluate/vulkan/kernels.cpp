#include "evaluate/vulkan/kernels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <future>
#include <optional>
#include <thread>

#include "base/interrupt.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "device/result.hpp"
#include "plan/rows.hpp"
#include "spirv.hpp"

namespace dolp::vulkan {
namespace {

std::span<const std::uint32_t> shader_module(const KernelVariant& variant, bool float64) {
  using namespace spirv;
  using Module = std::array<std::span<const std::uint32_t>, 2>;  // SPIR-V in float and in double
  const std::array<std::array<Module, 3>, 4> modules = {
      {{{{slopes_float, slopes_double},
         {slopes_sky_float, slopes_sky_double},
         {slopes_responses_float, slopes_responses_double}}},
       {{{moments_float, moments_double},
         {moments_sky_float, moments_sky_double},
         {moments_responses_float, moments_responses_double}}},
       {{{moments_rows_float, moments_rows_double},
         {moments_sky_rows_float, moments_sky_rows_double},
         {moments_responses_rows_float, moments_responses_rows_double}}},
       {{{slopes_orders_float, slopes_orders_double}, {slopes_sky_orders_float, slopes_sky_orders_double}, {}}}}};
  if (variant.entry == EntryPoint::kMaskingTable) return float64 ? masking_table_double : masking_table_float;
  const std::size_t columns = variant.columns == 0 ? 0 : variant.column_kind == DOLP_COLUMNS_SKY ? 1 : 2;
  const std::size_t moments_kind = variant.width == kRowWidth ? 2 : 1;
  const std::size_t kind = variant.entry != EntryPoint::kSlopes ? moments_kind : variant.has_orders ? 3 : 0;
  return modules[kind][columns][float64 ? 1 : 0];
}

constexpr std::uint32_t kWordBytes = sizeof(std::uint32_t);

VkDescriptorType descriptor_type(std::uint32_t binding) {
  return binding < kStorageCount ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
}

/// Members that all pipelines share.
struct PipelineSetting {
  VkDevice device = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipelineCreateFlags flags = 0;
  std::uint32_t local_size = 0;
};

UniquePipeline compile(const PipelineSetting& setting, std::span<const std::uint32_t> spirv,
                       const KernelVariant& variant) {
  const VkShaderModuleCreateInfo module_info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  const auto shader =
      created<UniqueShaderModule>(setting.device, vkCreateShaderModule, module_info, "creating a shader module");

  // The specialization constants, in the order of DOLP_SPEC_*. The enumerations have the values of interface.glsl.
  const std::array<std::uint32_t, 10> values{setting.local_size,
                                             static_cast<std::uint32_t>(variant.distribution),
                                             static_cast<std::uint32_t>(variant.masking),
                                             variant.has_total_reflection ? 1U : 0U,
                                             variant.is_multiple ? 1U : 0U,
                                             variant.has_direct ? 1U : 0U,
                                             variant.columns,
                                             variant.column_kind,
                                             variant.has_curves ? 1U : 0U,
                                             variant.has_stored_nodes ? 1U : 0U};
  std::array<VkSpecializationMapEntry, values.size()> entries;
  for (std::uint32_t i = 0; i < entries.size(); ++i) entries[i] = {i, i * kWordBytes, kWordBytes};
  const VkSpecializationInfo constants{.mapEntryCount = static_cast<std::uint32_t>(entries.size()),
                                       .pMapEntries = entries.data(),
                                       .dataSize = sizeof values,
                                       .pData = values.data()};
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .flags = setting.flags,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = shader.get(),
                                                   .pName = "main",
                                                   .pSpecializationInfo = &constants},
                                         .layout = setting.layout};
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(setting.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "creating a pipeline");
  return UniquePipeline(setting.device, pipeline);
}

constexpr auto kInterruptInterval = std::chrono::milliseconds(20);
constexpr double kDefaultCompilationLimitS = 120.0;  // SwiftShader on an idle processor needs at most 7 s
constexpr const char* kCompilationLimit = "DOLP_COMPILATION_LIMIT_S";

double compilation_limit_s() {
  const char* const wish = std::getenv(kCompilationLimit);
  if (wish == nullptr) return kDefaultCompilationLimitS;
  const std::optional<double> limit_s = parse_number(wish);
  if (limit_s && *limit_s > 0.0) return *limit_s;
  throw InputError(fmt::format("{}={}: must be a number of seconds above 0", kCompilationLimit, one_line(wish)));
}

}  // namespace

KernelVariant moments_variant(const KernelData& data, std::uint32_t width) {
  return {.entry = EntryPoint::kMoments,
          .distribution = data.distribution,
          .masking = data.masking,
          .has_total_reflection = data.has_total_reflection,
          .has_direct = data.has_direct,
          .columns = static_cast<std::uint32_t>(data.column_count()),
          .column_kind = column_kind(data),
          .has_curves = data.has_curves,
          .width = width};
}

KernelVariant slopes_variant(const KernelData& data) {
  KernelVariant variant = moments_variant(data, 1);
  variant.entry = EntryPoint::kSlopes;
  variant.distribution = {};  // one pipeline serves all distributions, because the sums at a slope do not contain D
  variant.is_multiple = data.scattering == Scattering::kMultiple;
  variant.has_orders = data.orders.highest > 0;
  return variant;
}

KernelVariant masking_table_variant(const KernelData& data) {
  return {EntryPoint::kMaskingTable, data.distribution, data.masking};
}

Kernels::Kernels(const Device& device, bool float64) : device_(device), float64_(float64) {
  create_layouts();
  create_descriptor_sets();
}

void Kernels::create_layouts() {
  std::array<VkDescriptorSetLayoutBinding, kStorageCount + kTexelCount> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    bindings[i] = {.binding = i,
                   .descriptorType = descriptor_type(i),
                   .descriptorCount = 1,
                   .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
  }
  const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                 .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                 .pBindings = bindings.data()};
  set_layout_ = created<UniqueDescriptorSetLayout>(device_.get(), vkCreateDescriptorSetLayout, set_info,
                                                   "creating a descriptor set layout");
  const VkDescriptorSetLayout set_layout = set_layout_.get();
  const VkPushConstantRange constants{
      .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .offset = 0, .size = kPushConstantCount * kWordBytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &constants};
  layout_ = created<UniquePipelineLayout>(device_.get(), vkCreatePipelineLayout, info, "creating a pipeline layout");
}

void Kernels::create_descriptor_sets() {
  const std::array<VkDescriptorPoolSize, 2> sizes{
      {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kMostInFlight * kStorageCount},
       {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kMostInFlight * kTexelCount}}};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = kMostInFlight,
                                             .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                             .pPoolSizes = sizes.data()};
  pool_ = created<UniqueDescriptorPool>(device_.get(), vkCreateDescriptorPool, pool_info, "creating a descriptor pool");
  std::array<VkDescriptorSetLayout, kMostInFlight> set_layouts{};
  set_layouts.fill(set_layout_.get());
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool_.get(),
                                         .descriptorSetCount = kMostInFlight,
                                         .pSetLayouts = set_layouts.data()};
  check(vkAllocateDescriptorSets(device_.get(), &info, sets_.data()), "allocating descriptor sets");
}

void Kernels::bind(const Bindings& bindings, std::size_t slot) {
  const auto is_given = [](const auto& handle) { return handle != VK_NULL_HANDLE; };
  const auto any_buffer = std::ranges::find_if(bindings.buffers, is_given);
  const auto any_view = std::ranges::find_if(bindings.texels, is_given);
  std::array<VkDescriptorBufferInfo, kStorageCount> infos{};
  std::array<VkBufferView, kTexelCount> views = bindings.texels;
  std::vector<VkWriteDescriptorSet> writes;
  for (std::uint32_t i = 0; i < kStorageCount + (any_view != bindings.texels.end() ? kTexelCount : 0); ++i) {
    VkWriteDescriptorSet& write =
        writes.emplace_back(VkWriteDescriptorSet{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                                 .dstSet = sets_[slot],
                                                 .dstBinding = i,
                                                 .descriptorCount = 1,
                                                 .descriptorType = descriptor_type(i)});
    if (i < kStorageCount) {
      infos[i] = {is_given(bindings.buffers[i]) ? bindings.buffers[i] : *any_buffer, 0, VK_WHOLE_SIZE};
      write.pBufferInfo = &infos[i];
    } else {
      VkBufferView& view = views[i - kStorageCount];
      if (!is_given(view)) view = *any_view;
      write.pTexelBufferView = &view;
    }
  }
  vkUpdateDescriptorSets(device_.get(), static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

VkPipeline Kernels::known(const KernelVariant& variant) {
  const std::scoped_lock lock(mutex_);
  const auto found = pipelines_.find(variant);
  return found == pipelines_.end() ? VK_NULL_HANDLE : found->second.get();
}

VkPipeline Kernels::pipeline(const KernelVariant& variant) {
  if (VkPipeline pipeline = known(variant)) return pipeline;
  UniquePipeline created = create(shader_module(variant, float64_), variant);
  const std::scoped_lock lock(mutex_);
  return pipelines_.emplace(variant, std::move(created)).first->second.get();
}

UniquePipeline Kernels::create(std::span<const std::uint32_t> spirv, const KernelVariant& variant) const {
  const double limit_s = compilation_limit_s();
  // A compilation may never end, and nothing can stop it. So it runs in a thread that the program can abandon.
  PipelineSetting setting{.device = device_.get(), .layout = layout_.get(), .local_size = local_size()};
  if (device_.features().statistics) setting.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
  std::packaged_task<UniquePipeline()> compilation([=] { return compile(setting, spirv, variant); });
  std::future<UniquePipeline> pipeline = compilation.get_future();
  std::thread(std::move(compilation)).detach();
  const auto start = std::chrono::steady_clock::now();
  while (pipeline.wait_for(kInterruptInterval) != std::future_status::ready) {
    if (interrupted() || seconds_since(start) > limit_s) {
      throw DeviceTimeout(fmt::format(
          "the Vulkan driver did not finish compiling a kernel within {:g} s; {} sets another limit, in seconds",
          limit_s, kCompilationLimit));
    }
  }
  return pipeline.get();
}

}  // namespace dolp::vulkan
