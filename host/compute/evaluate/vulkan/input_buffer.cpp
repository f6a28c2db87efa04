#include "evaluate/vulkan/input_buffer.hpp"

#include "evaluate/vulkan/command_stream.hpp"

namespace dolp::vulkan {
namespace {

bool must_stage(const Device& device) {
  constexpr std::uint32_t kAnyType = UINT32_MAX;
  return !(device.memory_type(kAnyType, MemoryUse::kUpload).flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
}

}  // namespace

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
