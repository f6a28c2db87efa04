#include "evaluate/vulkan/command_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "base/interrupt.hpp"
#include "base/stopwatch.hpp"
#include "device/result.hpp"
#include "evaluate/vulkan/kernels.hpp"

namespace dolp::vulkan {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;
constexpr double kInterruptIntervalS = 0.02;

struct BarrierScopes {
  VkPipelineStageFlags from_stage, to_stage;
  VkAccessFlags from_access, to_access;
};

constexpr VkPipelineStageFlags kCompute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
constexpr std::array<BarrierScopes, 3> kScopes = {  // in the order of Barrier
    {{VK_PIPELINE_STAGE_TRANSFER_BIT, kCompute, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT},
     {kCompute, kCompute, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT},
     {kCompute, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT}}};

bool must_stage(const Device& device) {
  constexpr std::uint32_t kAnyType = UINT32_MAX;
  return !(device.memory_type(kAnyType, MemoryUse::kUpload).flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
}

}  // namespace

CommandStream::CommandStream(const Device& device) : device_(device) {
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = device.queue_family()};
  pool_ = created<UniqueCommandPool>(device.get(), vkCreateCommandPool, pool_info, "creating a command pool");
  const VkCommandBufferAllocateInfo commands_info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = pool_.get(),
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
  const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  const VkQueryPoolCreateInfo query_info{
      .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = 2};
  for (Recording& recording : recordings_) {
    check(vkAllocateCommandBuffers(device.get(), &commands_info, &recording.commands), "allocating a command buffer");
    recording.fence = created<UniqueFence>(device.get(), vkCreateFence, fence_info, "creating a fence");
    if (device.timestamp_bits() == 0) continue;
    recording.timestamps =
        created<UniqueQueryPool>(device.get(), vkCreateQueryPool, query_info, "creating a query pool");
  }
}

void CommandStream::begin() {
  assert(in_flight_ < kMostInFlight);
  if (in_flight_ == 0) slot_ = 0;
  // After an error the commands may still be in recording state.
  check(vkResetCommandBuffer(commands(), 0), "resetting commands");
  has_copies_ = false;
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(commands(), &info), "recording commands");
  const VkQueryPool timestamps = recordings_[slot_].timestamps.get();
  if (timestamps == VK_NULL_HANDLE) return;
  vkCmdResetQueryPool(commands(), timestamps, 0, 2);
  vkCmdWriteTimestamp(commands(), VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps, 0);
}

void CommandStream::copy(const Buffer& from, VkBuffer to, VkDeviceSize bytes) {
  const VkBufferCopy region{.srcOffset = 0, .dstOffset = 0, .size = bytes};
  vkCmdCopyBuffer(commands(), from.get(), to, 1, &region);
  has_copies_ = true;
}

void CommandStream::barrier(Barrier barrier) {
  if (barrier == Barrier::kUploadToKernel && !std::exchange(has_copies_, false)) return;
  const BarrierScopes& scopes = kScopes[static_cast<std::size_t>(barrier)];
  const VkMemoryBarrier memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = scopes.from_access,
                               .dstAccessMask = scopes.to_access};
  vkCmdPipelineBarrier(commands(), scopes.from_stage, scopes.to_stage, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

void CommandStream::dispatch(const Kernels& kernels, VkPipeline pipeline, std::uint32_t first, std::uint32_t count,
                             int largest_order, std::uint32_t sky) {
  if (count == 0) return;
  const std::array<std::uint32_t, kPushConstantCount> constants{first, count, static_cast<std::uint32_t>(largest_order),
                                                                sky};
  const VkDescriptorSet set = kernels.descriptor_set(slot_);
  const std::uint32_t local_size = kernels.local_size();
  vkCmdBindPipeline(commands(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdBindDescriptorSets(commands(), VK_PIPELINE_BIND_POINT_COMPUTE, kernels.layout(), 0, 1, &set, 0, nullptr);
  vkCmdPushConstants(commands(), kernels.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, constants.data());
  vkCmdDispatch(commands(), (count + local_size - 1) / local_size, 1, 1);
}

void CommandStream::submit() {
  Recording& recording = recordings_[slot_];
  if (recording.timestamps.get() != VK_NULL_HANDLE) {
    vkCmdWriteTimestamp(commands(), VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, recording.timestamps.get(), 1);
  }
  check(vkEndCommandBuffer(commands()), "recording commands");
  const VkSubmitInfo info{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &recording.commands};
  recording.follows = in_flight_ > 0;
  recording.submitted = std::chrono::steady_clock::now();
  check(vkQueueSubmit(device_.queue(), 1, &info, recording.fence.get()), "submitting work");
  slot_ = (slot_ + 1) % kMostInFlight;
  ++in_flight_;
}

double CommandStream::wait(double timeout_s) {
  assert(in_flight_ > 0);
  const Recording& recording = recordings_[oldest_slot()];
  const VkFence fence = recording.fence.get();
  const auto start = std::chrono::steady_clock::now();
  VkResult result = VK_TIMEOUT;
  while (result == VK_TIMEOUT) {
    const double slice_s = std::min(timeout_s, kInterruptIntervalS);
    result =
        vkWaitForFences(device_.get(), 1, &fence, VK_TRUE, static_cast<std::uint64_t>(slice_s * kNanosecondsPerSecond));
    if (result == VK_TIMEOUT && (interrupted() || seconds_since(start) > timeout_s)) {
      throw DeviceTimeout(fmt::format("the Vulkan device did not finish a tile within {:g} s", timeout_s));
    }
  }
  --in_flight_;
  if (result != VK_SUCCESS) vkDeviceWaitIdle(device_.get());  // only the wait failed; the kernels may still be running
  const VkResult reset = vkResetFences(device_.get(), 1, &fence);
  check(result, "waiting for the device");
  check(reset, "resetting a fence");
  return elapsed_s(recording);
}

void CommandStream::drain(double timeout_s) {
  while (in_flight_ > 0) {
    try {
      wait(timeout_s);
    } catch (const DeviceTimeout&) {
      throw;
    } catch (const std::exception&) {
      // The caller already has an error, and wait() has counted the submission as ended.
    }
  }
}

double CommandStream::elapsed_s(const Recording& recording) {
  const auto seen = std::exchange(last_end_seen_, std::chrono::steady_clock::now());
  if (recording.timestamps.get() == VK_NULL_HANDLE) {
    return std::chrono::duration<double>(last_end_seen_ - std::max(seen, recording.submitted)).count();
  }
  std::array<std::uint64_t, 2> ticks{};
  check(vkGetQueryPoolResults(device_.get(), recording.timestamps.get(), 0, 2, sizeof ticks, ticks.data(),
                              sizeof ticks[0], VK_QUERY_RESULT_64_BIT),
        "reading timestamps");
  const std::uint64_t before = std::exchange(last_end_, ticks[1]);
  const std::uint32_t unused_bits = 64 - device_.timestamp_bits();
  // Shifting out the unused bits makes the difference wrap around as the device's counter does.
  const auto from = [&](std::uint64_t start) {
    return ((ticks[1] << unused_bits) - (start << unused_bits)) >> unused_bits;
  };
  // The device may start a submission before the end of the submission before.
  const std::uint64_t difference = recording.follows ? std::min(from(ticks[0]), from(before)) : from(ticks[0]);
  return static_cast<double>(difference) * static_cast<double>(device_.limits().timestampPeriod) /
         kNanosecondsPerSecond;
}

InputBuffer::InputBuffer(const Device& device, VkDeviceSize bytes, bool force_staging, VkFormat texels)
    : staging_(force_staging || must_stage(device)
                   ? std::optional<Buffer>(std::in_place, device, bytes, MemoryUse::kUpload)
                   : std::nullopt),
      buffer_(device, bytes, staging_ ? MemoryUse::kDeviceOnly : MemoryUse::kUpload, texels) {}

void InputBuffer::write(std::span<const std::byte> bytes, CommandStream& stream) {
  if (!staging_) {
    buffer_.write(bytes);
  } else if (!bytes.empty()) {
    staging_->write(bytes);
    stream.copy(*staging_, buffer_.get(), bytes.size());
  }
}

}  // namespace dolp::vulkan
