#pragma once

#include <cstdint>

#include "device/devices.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

/// Division of a request into dispatches.
struct DispatchForecast {
  std::uint32_t tile_invocations = 0;
  std::uint32_t block_shapes = 0;
  std::uint32_t row_width = 1;  ///< most entries that share an invocation, see plan/rows.hpp
  std::uint64_t rows = 0;       ///< of the moments, or pairs of a direction and an index with slope samples
  std::uint64_t slopes = 0;     ///< of all slope samples
  std::uint64_t dispatches = 0;
  std::uint64_t device_bytes = 0;  ///< bound of the memory of all buffers
};

/// Forecast of the dispatches of VulkanEvaluator for a request on a device, by the code that it uses itself.
DispatchForecast dispatch_forecast(const MomentsRequest& request, const dolp::Device& device,
                                   const VulkanOptions& options = {});
DispatchForecast dispatch_forecast(const ScatteringRequest& request, const dolp::Device& device,
                                   const VulkanOptions& options = {});

/// The limits that every Vulkan device guarantees, for plans without a device. The heap size is a guess.
dolp::Device least_device();

}  // namespace dolp
