// Draws ImGui's lists into a window, on the device that computes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
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
  /// Takes a new font of ImGui's context, between two frames.
  void restart_imgui();

 private:
  void create_frame();
  void start_imgui();
  void load_fonts();
  void recreate(VkExtent2D size);
  bool acquire(VkExtent2D size, std::uint32_t& image);
  void begin() const;
  void record(const Swapchain::Image& image, ImDrawData* data, const vulkan::Buffer* copy) const;
  void record_copy(VkImage image, const vulkan::Buffer& copy) const;
  void submit(const VkSubmitInfo& info, const char* action) const;
  void submit_frame(const Swapchain::Image& image) const;
  void present(const Swapchain::Image& image, std::uint32_t index, VkExtent2D size);
  Picture read(const vulkan::Buffer& copy) const;
  void wait() const;

  vulkan::Context& context_;
  VkSurfaceKHR surface_;
  VkExtent2D size_;  ///< of the window when the swapchain was made
  SurfaceFormat format_;
  UniqueRenderPass pass_;
  std::unique_ptr<Swapchain> swapchain_;
  vulkan::UniqueDescriptorPool descriptors_;
  // Of the frame that is drawn: the next one is laid out meanwhile, and waits for it before it is recorded.
  vulkan::UniqueCommandPool pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  vulkan::UniqueFence done_;
  UniqueSemaphore acquired_;
};

/// Writes a picture as PNG, whole or not at all. Errors: IoError.
void write_png(const Picture& picture, const std::string& path);

}  // namespace dolp::explore
