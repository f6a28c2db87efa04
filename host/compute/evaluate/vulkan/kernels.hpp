// The compute pipelines of shaders/*.comp; they share the descriptor sets.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>

#include "device/device.hpp"
#include "device/result.hpp"
#include "evaluate/vulkan/command_stream.hpp"
#include "plan/kernel_data.hpp"

namespace dolp::vulkan {

static_assert(kStorageCount == DOLP_BINDING_RULE_NODES &&
              kTexelCount == DOLP_BINDING_MASKING_NODES + 1 - kStorageCount);
constexpr std::uint32_t kPushConstantCount = 4;

enum class EntryPoint { kMoments, kSlopes, kMaskingTable };

struct KernelVariant {
  EntryPoint entry = EntryPoint::kMoments;
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kNone;
  bool has_total_reflection = false;
  bool is_multiple = false;
  bool has_direct = false;
  std::uint32_t columns = 0;
  std::uint32_t column_kind = DOLP_COLUMNS_SKY;
  bool has_curves = false;
  bool has_orders = false;
  bool has_stored_nodes = false;  ///< the rule nodes are in a storage buffer, not in a texel buffer
  std::uint32_t width = 1;        ///< largest number of entries per invocation: 1, or kRowWidth of plan/rows.hpp
  auto operator<=>(const KernelVariant&) const = default;
};

KernelVariant moments_variant(const KernelData& data, std::uint32_t width);
KernelVariant slopes_variant(const KernelData& data);
KernelVariant masking_table_variant(const KernelData& data);

/// Creates a pipeline on demand for each variant. Any thread may ask for one.
class Kernels {
 public:
  Kernels(const Device& device, bool float64);

  struct Bindings {
    std::array<VkBuffer, kStorageCount> buffers{};
    std::array<VkBufferView, kTexelCount> texels{};  ///< for DOLP_BINDING_RULE_NODES and DOLP_BINDING_MASKING_NODES
  };
  /// Binds the buffers for recordings in `slot` (see CommandStream). In place of a null buffer, which no kernel reads,
  /// binds any other buffer of `bindings`. This replaces the old binding, whose buffer may be destroyed: Vulkan forbids
  /// bindings to destroyed buffers.
  void bind(const Bindings& bindings, std::size_t slot = 0);

  VkPipeline pipeline(const KernelVariant& variant);
  bool has(const KernelVariant& variant) { return known(variant) != VK_NULL_HANDLE; }
  std::uint32_t local_size() const { return device_.local_size(); }
  VkPipelineLayout layout() const { return layout_.get(); }
  VkDescriptorSet descriptor_set(std::size_t slot) const { return sets_[slot]; }

  /// Creates a pipeline from any SPIR-V module that has the bindings and constants of interface.glsl.
  UniquePipeline create(std::span<const std::uint32_t> spirv, const KernelVariant& variant) const;

 private:
  void create_layouts();
  void create_descriptor_sets();
  VkPipeline known(const KernelVariant& variant);

  const Device& device_;
  bool float64_;
  UniqueDescriptorSetLayout set_layout_;
  UniquePipelineLayout layout_;
  UniqueDescriptorPool pool_;
  std::array<VkDescriptorSet, kMostInFlight> sets_{};
  std::mutex mutex_;  ///< guards the pipelines
  std::map<KernelVariant, UniquePipeline> pipelines_;
};

}  // namespace dolp::vulkan
