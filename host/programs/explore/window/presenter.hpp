// Draws ImGui's lists into a window, on the device that computes.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

#include "device/buffer.hpp"
#include "device/context.hpp"
#include "device/handle.hpp"

struct ImDrawData;

namespace dolp::explore {

/// Owns the surface and everything that draws on it, ImGui's Vulkan backend included. Needs an ImGui context.
class Presenter {
 public:
  /// Takes `surface`, which must belong to the context's instance. `size` is the size of the window's framebuffer.
  Presenter(vulkan::Context& context, VkSurfaceKHR surface, VkExtent2D size);
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;
  ~Presenter();

  /// Draws and presents; does nothing while the window has no area. Returns the frame as a PNG file if it is wanted and
  /// was drawn, else nothing.
  /// Errors: DeviceError when the device or the surface is lost.
  std::string draw(ImDrawData* data, VkExtent2D size, bool wants_picture);
  /// Takes a new font of ImGui's context, between two frames.
  void restart_imgui();

 private:
  using UniqueSwapchain = vulkan::Handle<VkSwapchainKHR, vkDestroySwapchainKHR>;
  using UniqueImageView = vulkan::Handle<VkImageView, vkDestroyImageView>;
  using UniqueFramebuffer = vulkan::Handle<VkFramebuffer, vkDestroyFramebuffer>;
  using UniqueRenderPass = vulkan::Handle<VkRenderPass, vkDestroyRenderPass>;
  using UniqueSemaphore = vulkan::Handle<VkSemaphore, vkDestroySemaphore>;

  /// One image of the swapchain.
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    UniqueImageView view;
    UniqueFramebuffer framebuffer;
    UniqueSemaphore drawn;  ///< signalled when the image may be presented
  };

  VkDevice device() const { return context_.device().get(); }
  VkQueue queue() const { return context_.device().queue(); }
  void choose_format();
  void create_render_pass();
  void create_frame();
  UniqueSemaphore new_semaphore() const;
  VkSurfaceCapabilitiesKHR capabilities() const;
  /// True where the surface has a size to draw into: a minimised window has none.
  bool has_area(VkExtent2D size) const;
  void create_swapchain(VkExtent2D size);
  void recreate_swapchain(VkExtent2D size);
  void add_image(VkImage image);
  void start_imgui();
  void load_fonts();
  bool acquire(VkExtent2D size, std::uint32_t& image);
  void begin() const;
  void record(const Image& image, ImDrawData* data, const vulkan::Buffer* copy) const;
  void record_copy(VkImage image, const vulkan::Buffer& copy) const;
  void submit(const VkSubmitInfo& info, const char* action) const;
  void submit_frame(const Image& image) const;
  void present(const Image& image, std::uint32_t index, VkExtent2D size);
  std::string png_of(const vulkan::Buffer& copy) const;
  void wait() const;

  vulkan::Context& context_;
  VkSurfaceKHR surface_;
  VkExtent2D size_;  ///< size of the window when the swapchain was made
  VkSurfaceFormatKHR format_{};
  UniqueRenderPass pass_;
  VkExtent2D extent_{};
  UniqueSwapchain swapchain_;
  std::vector<Image> images_;
  vulkan::UniqueDescriptorPool descriptors_;
  // For the frame that is being drawn. The next frame is laid out meanwhile, and waits for it before it is recorded.
  vulkan::UniqueCommandPool pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  vulkan::UniqueFence done_;
  UniqueSemaphore acquired_;
};

}  // namespace dolp::explore
