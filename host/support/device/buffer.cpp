#include "device/buffer.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "device/result.hpp"

namespace dolp::vulkan {
namespace {

// Smallest size of a buffer in bytes. Vulkan forbids empty buffers.
constexpr VkDeviceSize kSmallestBuffer = 256;

}  // namespace

Buffer::Buffer(const Device& device, VkDeviceSize bytes, MemoryUse use, VkFormat texels)
    : device_(device.get()), size_(std::max(bytes, kSmallestBuffer)), format_(texels) {
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = size_,
                                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
  buffer_ = created<UniqueBuffer>(device_, vkCreateBuffer, info, "creating a buffer");

  VkMemoryRequirements requirements{};
  vkGetBufferMemoryRequirements(device_, buffer_.get(), &requirements);
  const MemoryType type = device.memory_type(requirements.memoryTypeBits, use);
  memory_flags_ = type.flags;
  const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = requirements.size,
                                        .memoryTypeIndex = type.index};
  memory_ = created<UniqueMemory>(device_, vkAllocateMemory, allocation,
                                  "allocating " + std::to_string(requirements.size) + " bytes");
  check(vkBindBufferMemory(device_, buffer_.get(), memory_.get(), 0), "binding memory");
  if (texels != VK_FORMAT_UNDEFINED) {
    const VkBufferViewCreateInfo view_info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                           .buffer = buffer_.get(),
                                           .format = texels,
                                           .range = VK_WHOLE_SIZE};
    texels_ = created<UniqueBufferView>(device_, vkCreateBufferView, view_info, "creating a view of a buffer");
  }
  if (use == MemoryUse::kDeviceOnly) return;
  void* address = nullptr;
  check(vkMapMemory(device_, memory_.get(), 0, VK_WHOLE_SIZE, 0, &address), "mapping memory");
  mapped_ = static_cast<std::byte*>(address);
}

VkMappedMemoryRange Buffer::range() const {
  return {.sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE, .memory = memory_.get(), .offset = 0, .size = VK_WHOLE_SIZE};
}

void Buffer::write(std::span<const std::byte> bytes) {
  assert(mapped_ && bytes.size() <= size_);
  if (bytes.empty()) return;
  std::memcpy(mapped_, bytes.data(), bytes.size());
  if (coherent()) return;
  const VkMappedMemoryRange whole = range();
  check(vkFlushMappedMemoryRanges(device_, 1, &whole), "flushing memory");
}

void Buffer::read(std::span<std::byte> bytes) const {
  assert(mapped_ && bytes.size() <= size_);
  if (bytes.empty()) return;
  if (!coherent()) {
    const VkMappedMemoryRange whole = range();
    check(vkInvalidateMappedMemoryRanges(device_, 1, &whole), "invalidating memory");
  }
  std::memcpy(bytes.data(), mapped_, bytes.size());
}

}  // namespace dolp::vulkan
