// Draws ImGui's lists into a window, on the device that computes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "device/buffer.hpp"
#include "explore/window/swapchain.hpp"

struct ImDrawData;

namespace dolp::explore {

/// A picture in rows from the top; RGBA, eight bits each.
struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Owns the surface and everything that draws on it, ImGui's Vulkan backend included. An ImGui context must be there.
class Presenter {
 public:
  /// Takes `surface`, which must belong to the context's instance.
  Presenter(vulkan::Context& context, VkSurfaceKHR surface, VkExtent2D size);
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;
  ~Presenter();

  /// Draws and presents; does nothing while the window has no area. `size` is that of the window's framebuffer.
  /// `picture`: where the frame is also to be copied to.
  /// Errors: DeviceError when the device or the surface is lost.
  void draw(ImDrawData* data, VkExtent2D size, Picture* picture = nullptr);

 private:
  /// Resources of one frame in flight.
  struct Frame {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    vulkan::UniqueFence done;
    UniqueSemaphore acquired;
  };

  void create_frames();
  void start_imgui();
  void recreate(VkExtent2D size);
  bool acquire(Frame& frame, VkExtent2D size, std::uint32_t& image);
  void record(const Frame& frame, const Swapchain::Image& image, ImDrawData* data, const vulkan::Buffer* copy) const;
  void record_copy(VkCommandBuffer commands, VkImage image, const vulkan::Buffer& copy) const;
  void submit(const Frame& frame, const Swapchain::Image& image) const;
  void present(const Swapchain::Image& image, std::uint32_t index, VkExtent2D size);
  Picture read(const Frame& frame, const vulkan::Buffer& copy) const;
  void wait(const Frame& frame) const;

  static constexpr std::size_t kFramesInFlight = 2;

  vulkan::Context& context_;
  VkSurfaceKHR surface_;
  VkExtent2D size_;  ///< of the window when the swapchain was made
  SurfaceFormat format_;
  UniqueRenderPass pass_;
  std::unique_ptr<Swapchain> swapchain_;
  vulkan::UniqueCommandPool commands_;
  vulkan::UniqueDescriptorPool descriptors_;
  std::array<Frame, kFramesInFlight> frames_;
  std::size_t next_frame_ = 0;
};

}  // namespace dolp::explore
