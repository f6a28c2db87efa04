#include "evaluate/vulkan/kernels.hpp"

#include "evaluate/vulkan/result.hpp"
#include "shaders/spirv.hpp"

namespace dolp::vulkan {
namespace {

std::span<const std::uint32_t> moments_module(std::uint32_t group_size, bool float64) {
  switch (group_size) {
    case 4:
      return float64 ? spirv::moments_group4_double : spirv::moments_group4_float;
    case 8:
      return float64 ? spirv::moments_group8_double : spirv::moments_group8_float;
    case 16:
      return float64 ? spirv::moments_group16_double : spirv::moments_group16_float;
    default:
      return float64 ? spirv::moments_double : spirv::moments_float;
  }
}

}  // namespace

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

void Kernels::bind(const std::array<VkBuffer, kBindingCount>& buffers) {
  std::array<VkDescriptorBufferInfo, kBindingCount> infos{};
  std::array<VkWriteDescriptorSet, kBindingCount> writes{};
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < kBindingCount; ++i) {
    if (buffers[i] == VK_NULL_HANDLE) continue;
    infos[i] = {.buffer = buffers[i], .offset = 0, .range = VK_WHOLE_SIZE};
    writes[count++] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                       .dstSet = set_,
                       .dstBinding = i,
                       .descriptorCount = 1,
                       .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                       .pBufferInfo = &infos[i]};
  }
  vkUpdateDescriptorSets(device_.get(), count, writes.data(), 0, nullptr);
}

VkPipeline Kernels::moments(Distribution distribution, Masking masking, std::uint32_t group_size) {
  return cached(moments_cache(group_size), moments_module(group_size, float64_), distribution, masking);
}

std::vector<std::uint32_t> Kernels::made_group_sizes(Distribution distribution, Masking masking) {
  const std::scoped_lock lock(mutex_);
  std::vector<std::uint32_t> sizes;
  for (const auto& [size, cache] : moments_) {
    if (cache.contains({distribution, masking})) sizes.push_back(size);
  }
  return sizes;
}

Kernels::Cache& Kernels::moments_cache(std::uint32_t group_size) {
  const std::scoped_lock lock(mutex_);
  return moments_[group_size];
}

VkPipeline Kernels::masking_table(Distribution distribution, Masking masking) {
  return cached(masking_tables_, float64_ ? spirv::masking_table_double : spirv::masking_table_float, distribution,
                masking);
}

VkPipeline Kernels::mueller(Distribution distribution, Masking masking) {
  return cached(muellers_, float64_ ? spirv::mueller_double : spirv::mueller_float, distribution, masking);
}

VkPipeline Kernels::cached(Cache& cache, std::span<const std::uint32_t> spirv, Distribution distribution,
                           Masking masking) {
  const auto known = [&]() -> VkPipeline {
    const std::scoped_lock lock(mutex_);
    const auto found = cache.find({distribution, masking});
    return found == cache.end() ? VK_NULL_HANDLE : found->second.get();
  };
  if (VkPipeline pipeline = known()) return pipeline;
  UniquePipeline pipeline = create(spirv, distribution, masking);
  const std::scoped_lock lock(mutex_);
  return cache.emplace(std::pair(distribution, masking), std::move(pipeline)).first->second.get();
}

UniquePipeline Kernels::create(std::span<const std::uint32_t> spirv, Distribution distribution, Masking masking) const {
  const VkShaderModuleCreateInfo module_info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  VkShaderModule created_module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device_.get(), &module_info, nullptr, &created_module), "creating a shader module");
  const UniqueShaderModule shader(device_.get(), created_module);

  // The enumerators are the values of interface.glsl.
  const std::array<std::uint32_t, 3> values{kLocalSize, static_cast<std::uint32_t>(distribution),
                                            static_cast<std::uint32_t>(masking)};
  constexpr std::uint32_t kSize = sizeof(std::uint32_t);
  const std::array<VkSpecializationMapEntry, 3> entries{{{DOLP_SPEC_LOCAL_SIZE, 0, kSize},
                                                         {DOLP_SPEC_DISTRIBUTION, kSize, kSize},
                                                         {DOLP_SPEC_MASKING, 2 * kSize, kSize}}};
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
