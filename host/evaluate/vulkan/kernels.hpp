// The compute pipelines of shaders/*.comp and the descriptor set they share.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "evaluate/vulkan/device.hpp"
#include "evaluate/vulkan/handle.hpp"
#include "plan/kernel_data.hpp"

namespace dolp::vulkan {

constexpr std::uint32_t kBindingCount = DOLP_BINDING_RULE + 1;
constexpr std::uint32_t kPushConstantCount = 4;
/// Invocations of a workgroup; every device allows 128.
constexpr std::uint32_t kLocalSize = 64;

/// Creates pipelines on demand, one for each combination of the specialization constants; any thread may ask for one.
class Kernels {
 public:
  Kernels(const Device& device, bool float64);

  /// Binds one storage buffer to each binding of interface.glsl, whole; a null handle leaves a binding that the
  /// pipelines to run do not use.
  void bind(const std::array<VkBuffer, kBindingCount>& buffers);

  /// `group_size`: one of kGroupSizes of plan/groups.hpp.
  VkPipeline moments(Distribution distribution, Masking masking, std::uint32_t group_size);
  /// The sizes of groups that `moments` has made a pipeline for.
  std::vector<std::uint32_t> made_group_sizes(Distribution distribution, Masking masking);
  VkPipeline masking_table(Distribution distribution, Masking masking);
  VkPipeline mueller(Distribution distribution, Masking masking);
  /// Runs `pipeline` of `create` in place of that of `moments`, for studies of other modules.
  void replace_moments(Distribution distribution, Masking masking, UniquePipeline pipeline) {
    moments_[1].insert_or_assign({distribution, masking}, std::move(pipeline));
  }
  VkPipelineLayout layout() const { return layout_.get(); }
  VkDescriptorSet descriptor_set() const { return set_; }

  /// A pipeline of any module that keeps to interface.glsl.
  UniquePipeline create(std::span<const std::uint32_t> spirv, Distribution distribution, Masking masking) const;

 private:
  using Cache = std::map<std::pair<Distribution, Masking>, UniquePipeline>;
  Cache& moments_cache(std::uint32_t group_size);
  VkPipeline cached(Cache& cache, std::span<const std::uint32_t> spirv, Distribution distribution, Masking masking);
  void create_layouts();
  void create_descriptor_set();

  const Device& device_;
  bool float64_;
  UniqueDescriptorSetLayout set_layout_;
  UniquePipelineLayout layout_;
  UniqueDescriptorPool pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  std::mutex mutex_;                        ///< of the caches
  std::map<std::uint32_t, Cache> moments_;  ///< by the size of a group
  Cache masking_tables_, muellers_;
};

}  // namespace dolp::vulkan
