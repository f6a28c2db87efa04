#pragma once

#include <cstddef>
#include <span>

#include "device/device.hpp"
#include "device/result.hpp"

namespace dolp::vulkan {

/// A Vulkan storage buffer with its memory.
class Buffer {
 public:
  /// Creates a buffer with at least `bytes`. If `texels` is a format, shaders can also read texels in this format.
  Buffer(const Device& device, VkDeviceSize bytes, MemoryUse use, VkFormat texels = VK_FORMAT_UNDEFINED);

  VkBuffer get() const { return buffer_.get(); }
  VkBufferView texels() const { return texels_.get(); }
  VkDeviceSize size() const { return size_; }
  /// True if the buffer can take the place of a new one.
  bool fits(VkDeviceSize bytes, VkFormat texels) const { return size_ >= bytes && format_ == texels; }

  /// Writes bytes to the start of a mapped buffer. Work that is submitted to the queue later sees these bytes.
  void write(std::span<const std::byte> bytes);
  /// Reads the start of a mapped buffer. The device must have ended its work with a barrier that lets the host read it.
  void read(std::span<std::byte> bytes) const;

 private:
  VkMappedMemoryRange range() const;
  bool coherent() const { return (memory_flags_ & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0; }

  VkDevice device_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  VkMemoryPropertyFlags memory_flags_ = 0;
  // The destructor destroys members in reverse order: the memory last.
  UniqueMemory memory_;
  UniqueBuffer buffer_;
  UniqueBufferView texels_;
  std::byte* mapped_ = nullptr;
};

}  // namespace dolp::vulkan
