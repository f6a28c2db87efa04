#include "device/buffer.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "device/result.hpp"

namespace dolp::vulkan {
namespace {

// Vulkan has no empty buffers, and no structure of the kernels is larger than this.
constexpr VkDeviceSize kSmallestBuffer = 256;

}  // namespace

Buffer::Buffer(const Device& device, VkDeviceSize bytes, MemoryUse use, VkFormat texels)
    : device_(device.get()), size_(std::max(bytes, kSmallestBuffer)) {
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = size_,
                                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(device_, &info, nullptr, &buffer), "creating a buffer");
  buffer_ = UniqueBuffer(device_, buffer);

  VkMemoryRequirements requirements{};
  vkGetBufferMemoryRequirements(device_, buffer, &requirements);
  const MemoryType type = device.memory_type(requirements.memoryTypeBits, use);
  memory_flags_ = type.flags;
  const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = requirements.size,
                                        .memoryTypeIndex = type.index};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device_, &allocation, nullptr, &memory),
        "allocating " + std::to_string(requirements.size) + " bytes");
  memory_ = UniqueMemory(device_, memory);
  check(vkBindBufferMemory(device_, buffer, memory, 0), "binding memory");
  if (texels != VK_FORMAT_UNDEFINED) create_texels(texels);
  if (use == MemoryUse::kDeviceOnly) return;
  void* address = nullptr;
  check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &address), "mapping memory");
  mapped_ = static_cast<std::byte*>(address);
}

void Buffer::create_texels(VkFormat format) {
  const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                    .buffer = buffer_.get(),
                                    .format = format,
                                    .range = VK_WHOLE_SIZE};
  VkBufferView view = VK_NULL_HANDLE;
  check(vkCreateBufferView(device_, &info, nullptr, &view), "creating a view of a buffer");
  texels_ = UniqueBufferView(device_, view);
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
