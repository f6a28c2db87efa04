// Input buffers of kernels.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "device/buffer.hpp"

namespace dolp::vulkan {

class CommandStream;

/// A buffer that the host writes and kernels read, in the device's own memory: directly where that can be mapped, by a
/// copy from a staging buffer elsewhere.
class InputBuffer {
 public:
  /// `force_staging` uses the staging buffer on every device.
  InputBuffer(const Device& device, VkDeviceSize bytes, bool force_staging, VkFormat texels = VK_FORMAT_UNDEFINED);

  VkBuffer get() const { return buffer_.get(); }
  VkBufferView texels() const { return buffer_.texels(); }
  /// Writes to the start of the buffer; a staging copy is recorded in `stream`, which must be recording.
  void write(std::span<const std::byte> bytes, CommandStream& stream);

 private:
  std::optional<Buffer> staging_;
  Buffer buffer_;
};

}  // namespace dolp::vulkan
