#include "evaluate/vulkan/kernels.hpp"

#include <algorithm>

#include "device/result.hpp"
#include "spirv.hpp"

namespace dolp::vulkan {
namespace {

/// The SPIR-V module of a variant.
std::span<const std::uint32_t> module_of(const KernelVariant& variant, bool float64) {
  if (variant.entry == EntryPoint::kMaskingTable) {
    return float64 ? spirv::masking_table_double : spirv::masking_table_float;
  }
  if (variant.entry == EntryPoint::kMueller) return float64 ? spirv::mueller_double : spirv::mueller_float;
  if (variant.entry == EntryPoint::kSlopes) return float64 ? spirv::slopes_double : spirv::slopes_float;
  switch (variant.width) {
    case 4:
      return float64 ? spirv::moments_row4_double : spirv::moments_row4_float;
    case 8:
      return float64 ? spirv::moments_row8_double : spirv::moments_row8_float;
    case 16:
      return float64 ? spirv::moments_row16_double : spirv::moments_row16_float;
    default:
      return float64 ? spirv::moments_double : spirv::moments_float;
  }
}

}  // namespace

KernelVariant moments_variant(const KernelData& data, std::uint32_t width) {
  return {.entry = EntryPoint::kMoments,
          .distribution = data.distribution,
          .masking = data.masking,
          .has_total_reflection = data.has_total_reflection,
          .has_direct = data.has_direct,
          .width = width};
}

KernelVariant slopes_variant(const KernelData& data) {
  return {.entry = EntryPoint::kSlopes,
          .distribution = data.distribution,
          .masking = data.masking,
          .has_total_reflection = data.has_total_reflection,
          .is_multiple = data.scattering == Scattering::kMultiple,
          .has_direct = data.has_direct};
}

KernelVariant masking_table_variant(const KernelData& data) {
  return {EntryPoint::kMaskingTable, data.distribution, data.masking};
}

Kernels::Kernels(const Device& device, bool float64) : device_(device), float64_(float64) {
  create_layouts();
  create_descriptor_set();
}

void Kernels::create_layouts() {
  std::array<VkDescriptorSetLayoutBinding, kBindingCount> bindings{};
  for (std::uint32_t i = 0; i < kBindingCount; ++i) {
    bindings[i] = {.binding = i,
                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                   .descriptorCount = 1,
                   .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
  }
  const VkDescriptorSetLayoutCreateInfo set_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                 .bindingCount = kBindingCount,
                                                 .pBindings = bindings.data()};
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device_.get(), &set_info, nullptr, &set_layout),
        "creating a descriptor set layout");
  set_layout_ = UniqueDescriptorSetLayout(device_.get(), set_layout);

  const VkPushConstantRange constants{
      .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .offset = 0, .size = kPushConstantCount * sizeof(std::uint32_t)};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &constants};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device_.get(), &info, nullptr, &layout), "creating a pipeline layout");
  layout_ = UniquePipelineLayout(device_.get(), layout);
}

void Kernels::create_descriptor_set() {
  const VkDescriptorPoolSize size{.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .descriptorCount = kBindingCount};
  const VkDescriptorPoolCreateInfo pool_info{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device_.get(), &pool_info, nullptr, &pool), "creating a descriptor pool");
  pool_ = UniqueDescriptorPool(device_.get(), pool);
  const VkDescriptorSetLayout set_layout = set_layout_.get();
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool,
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &set_layout};
  check(vkAllocateDescriptorSets(device_.get(), &info, &set_), "allocating a descriptor set");
}

void Kernels::bind(std::array<VkBuffer, kBindingCount> buffers) {
  const VkBuffer any = *std::ranges::find_if(buffers, [](VkBuffer buffer) { return buffer != VK_NULL_HANDLE; });
  std::array<VkDescriptorBufferInfo, kBindingCount> infos{};
  std::array<VkWriteDescriptorSet, kBindingCount> writes{};
  for (std::uint32_t i = 0; i < kBindingCount; ++i) {
    infos[i] = {.buffer = buffers[i] == VK_NULL_HANDLE ? any : buffers[i], .offset = 0, .range = VK_WHOLE_SIZE};
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                 .dstSet = set_,
                 .dstBinding = i,
                 .descriptorCount = 1,
                 .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                 .pBufferInfo = &infos[i]};
  }
  vkUpdateDescriptorSets(device_.get(), kBindingCount, writes.data(), 0, nullptr);
}

VkPipeline Kernels::known(const KernelVariant& variant) {
  const std::scoped_lock lock(mutex_);
  const auto found = pipelines_.find(variant);
  return found == pipelines_.end() ? VK_NULL_HANDLE : found->second.get();
}

VkPipeline Kernels::pipeline(const KernelVariant& variant) {
  if (VkPipeline pipeline = known(variant)) return pipeline;
  UniquePipeline created = create(module_of(variant, float64_), variant);
  const std::scoped_lock lock(mutex_);
  return pipelines_.emplace(variant, std::move(created)).first->second.get();
}

UniquePipeline Kernels::create(std::span<const std::uint32_t> spirv, const KernelVariant& variant) const {
  const VkShaderModuleCreateInfo module_info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  VkShaderModule created_module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device_.get(), &module_info, nullptr, &created_module), "creating a shader module");
  const UniqueShaderModule shader(device_.get(), created_module);

  // The enumerators are the values of interface.glsl.
  const std::array<std::uint32_t, 6> values{local_size(),
                                            static_cast<std::uint32_t>(variant.distribution),
                                            static_cast<std::uint32_t>(variant.masking),
                                            variant.has_total_reflection ? 1U : 0U,
                                            variant.is_multiple ? 1U : 0U,
                                            variant.has_direct ? 1U : 0U};
  constexpr std::uint32_t kSize = sizeof(std::uint32_t);
  const std::array<VkSpecializationMapEntry, 6> entries{{{DOLP_SPEC_LOCAL_SIZE, 0, kSize},
                                                         {DOLP_SPEC_DISTRIBUTION, kSize, kSize},
                                                         {DOLP_SPEC_MASKING, 2 * kSize, kSize},
                                                         {DOLP_SPEC_TOTAL_REFLECTION, 3 * kSize, kSize},
                                                         {DOLP_SPEC_MULTIPLE, 4 * kSize, kSize},
                                                         {DOLP_SPEC_DIRECT, 5 * kSize, kSize}}};
  const VkSpecializationInfo constants{.mapEntryCount = static_cast<std::uint32_t>(entries.size()),
                                       .pMapEntries = entries.data(),
                                       .dataSize = sizeof values,
                                       .pData = values.data()};
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = shader.get(),
                                                   .pName = "main",
                                                   .pSpecializationInfo = &constants},
                                         .layout = layout_.get()};
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device_.get(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "creating a pipeline");
  return UniquePipeline(device_.get(), pipeline);
}

}  // namespace dolp::vulkan
