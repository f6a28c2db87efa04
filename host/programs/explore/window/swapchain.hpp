// The images of a window.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <vector>

#include "device/context.hpp"
#include "device/handle.hpp"

namespace dolp::explore {

using UniqueSwapchain = vulkan::Handle<VkSwapchainKHR, vkDestroySwapchainKHR>;
using UniqueImageView = vulkan::Handle<VkImageView, vkDestroyImageView>;
using UniqueFramebuffer = vulkan::Handle<VkFramebuffer, vkDestroyFramebuffer>;
using UniqueRenderPass = vulkan::Handle<VkRenderPass, vkDestroyRenderPass>;
using UniqueSemaphore = vulkan::Handle<VkSemaphore, vkDestroySemaphore>;

/// Format of a surface's images: eight bits a channel, not sRGB, because ImGui's colours assume that.
struct SurfaceFormat {
  VkSurfaceFormatKHR format{};
  bool is_bgr = false;
};

/// Errors: DeviceError when the surface has no such format.
SurfaceFormat choose_format(VkPhysicalDevice physical, VkSurfaceKHR surface);

/// A pass that clears one image of `format` and leaves it ready to be presented.
UniqueRenderPass make_render_pass(VkDevice device, VkFormat format);

/// Swapchain of one size, with a framebuffer and a semaphore for each image.
class Swapchain {
 public:
  /// One image of it.
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    UniqueImageView view;
    UniqueFramebuffer framebuffer;
    UniqueSemaphore drawn;  ///< signalled when the image may be presented
  };

  /// `wanted` is the size where the surface leaves it open. `old` is retired, but not destroyed.
  Swapchain(const vulkan::Context& context, VkSurfaceKHR surface, const SurfaceFormat& format, VkRenderPass pass,
            VkExtent2D wanted, VkSwapchainKHR old);

  VkSwapchainKHR get() const { return swapchain_.get(); }
  VkExtent2D extent() const { return extent_; }
  const std::vector<Image>& images() const { return images_; }

 private:
  void create(const vulkan::Context& context, VkSurfaceKHR surface, const SurfaceFormat& format, VkExtent2D wanted,
              VkSwapchainKHR old);
  void add_image(VkDevice device, VkImage image, VkFormat format, VkRenderPass pass);

  VkExtent2D extent_{};
  UniqueSwapchain swapchain_;
  std::vector<Image> images_;
};

UniqueSemaphore make_semaphore(VkDevice device);

/// True where a surface has a size to draw into: a minimised window has none.
bool has_area(VkPhysicalDevice physical, VkSurfaceKHR surface, VkExtent2D wanted);

}  // namespace dolp::explore
