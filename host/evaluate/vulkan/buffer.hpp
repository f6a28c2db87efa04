// Storage buffers and how the host writes and reads them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "evaluate/vulkan/device.hpp"
#include "evaluate/vulkan/handle.hpp"

namespace dolp::vulkan {

class CommandStream;

/// A storage buffer with memory of its own, never empty.
class Buffer {
 public:
  Buffer(const Device& device, VkDeviceSize bytes, MemoryUse use);

  VkBuffer get() const { return buffer_.get(); }
  VkDeviceSize size() const { return size_; }

  /// Writes to the start of a mapped buffer; the next submission sees it.
  void write(std::span<const std::byte> bytes);
  /// Reads from the start of a mapped buffer after the submission that wrote it (and its barrier) has finished.
  void read(std::span<std::byte> bytes) const;

 private:
  VkMappedMemoryRange range() const;
  bool coherent() const { return (memory_flags_ & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0; }

  VkDevice device_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  VkMemoryPropertyFlags memory_flags_ = 0;
  // The memory outlives the buffer bound to it.
  UniqueMemory memory_;
  UniqueBuffer buffer_;
  std::byte* mapped_ = nullptr;
};

/// A buffer that the host writes and kernels read, in the device's own memory: directly where that can be mapped, by a
/// copy from a staging buffer elsewhere.
class InputBuffer {
 public:
  /// `force_staging` takes the second way on every device.
  InputBuffer(const Device& device, VkDeviceSize bytes, bool force_staging);

  VkBuffer get() const { return buffer_.get(); }
  /// Writes to the start of the buffer; a staging copy is recorded in `stream`, which must be recording.
  void write(std::span<const std::byte> bytes, CommandStream& stream);

 private:
  std::optional<Buffer> staging_;
  Buffer buffer_;
};

}  // namespace dolp::vulkan
