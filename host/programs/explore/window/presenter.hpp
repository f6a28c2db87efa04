// Draws ImGui's lists into a window, on the device that computes.
#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <string>

#include "device/context.hpp"

struct ImDrawData;

namespace dolp::explore {

/// Owns the surface and everything that draws on it, ImGui's Vulkan backend included. Needs an ImGui context.
class Presenter {
 public:
  /// Takes `surface`, which must belong to the context's instance. `size` is the size of the window's framebuffer.
  Presenter(vulkan::Context& context, VkSurfaceKHR surface, VkExtent2D size);
  ~Presenter();

  /// Draws and presents; does nothing while the window has no area. Returns the frame as a PNG file if it is wanted and
  /// was drawn, else nothing.
  /// Errors: DeviceError when the device or the surface is lost.
  std::string draw(ImDrawData* data, VkExtent2D size, bool wants_picture);
  /// Takes a new font of ImGui's context, between two frames.
  void restart_imgui();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dolp::explore
