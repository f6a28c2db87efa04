// Draws ImGui's lists into a window, on the device that also computes. Only for app.cpp.
#pragma once

#include <vulkan/vulkan.h>

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "device/buffer.hpp"
#include "device/context.hpp"
#include "device/result.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {

/// Owns the surface and everything that draws on it, with ImGui's Vulkan backend. Needs an ImGui context.
class Presenter {
 public:
  /// `surface` must belong to the context's instance; the object takes ownership. `size` is the size of the
  /// framebuffer.
  Presenter(vulkan::Context& context, VkSurfaceKHR surface, VkExtent2D size)
      : context_(context), surface_(surface), size_(size) {
    VkBool32 is_supported = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(context.physical_device(), context.device().queue_family(), surface,
                                               &is_supported),
          "asking whether the device can show the window");
    if (is_supported == VK_FALSE)
      throw DeviceError(context.description().name + " cannot show a window on this display");
    choose_format();
    create_render_pass();
    create_swapchain(size);
    create_frame();
    start_imgui();
  }

  ~Presenter() {
    vkQueueWaitIdle(queue());
    ImGui_ImplVulkan_Shutdown();
    images_.clear();
    swapchain_ = {};
    vkDestroySurfaceKHR(context_.instance(), surface_, nullptr);
  }

  /// Draws and presents. Does nothing while the window has no area. Returns the frame as a PNG file if that is wanted
  /// and the frame was drawn; otherwise nothing.
  /// Errors: DeviceError if the device or the surface is lost.
  std::string draw(ImDrawData* data, VkExtent2D size, bool wants_picture) {
    wait();
    std::uint32_t index = 0;
    if (!acquire(size, index)) return {};
    std::optional<vulkan::Buffer> copy;
    if (wants_picture) {
      copy.emplace(context_.device(), VkDeviceSize{extent_.width} * extent_.height * kBytesPerPixel,
                   vulkan::MemoryUse::kReadback);
    }
    record(images_[index], data, copy ? &*copy : nullptr);
    submit_frame(images_[index]);
    std::string png = copy ? png_of(*copy) : "";
    present(images_[index], index, size);
    return png;
  }

  /// Loads a new font of ImGui's context. Call it between two frames.
  void restart_imgui() {
    wait();
    ImGui_ImplVulkan_Shutdown();
    start_imgui();
  }

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
    UniqueSemaphore drawn;  ///< signalled when the image is ready to be presented
  };

  static constexpr std::size_t kBytesPerPixel = 4;

  static void check(VkResult result, const char* action) { vulkan::check(result, action); }
  static void check_imgui(VkResult result) { check(result, "drawing the window"); }

  static VkExtent2D extent_of(const VkSurfaceCapabilitiesKHR& capabilities, VkExtent2D wanted) {
    constexpr std::uint32_t kOpenSize = UINT32_MAX;  // the window can choose any size
    if (capabilities.currentExtent.width != kOpenSize) return capabilities.currentExtent;
    const VkExtent2D& least = capabilities.minImageExtent;
    const VkExtent2D& most = capabilities.maxImageExtent;
    return {std::clamp(wanted.width, least.width, most.width), std::clamp(wanted.height, least.height, most.height)};
  }

  VkDevice device() const { return context_.device().get(); }
  VkQueue queue() const { return context_.device().queue(); }

  void choose_format() {
    // not sRGB, because ImGui expects linear formats
    constexpr std::array kFormats = {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM};
    format_ =
        ImGui_ImplVulkanH_SelectSurfaceFormat(context_.physical_device(), surface_, kFormats.data(),
                                              static_cast<int>(kFormats.size()), VK_COLOR_SPACE_SRGB_NONLINEAR_KHR);
    if (std::ranges::count(kFormats, format_.format) == 0)
      throw DeviceError("the Vulkan device cannot show 8-bit colours on this display");
  }

  /// A pass that clears one image and leaves it ready to be presented.
  void create_render_pass() {
    const VkAttachmentDescription colour{.format = format_.format,
                                         .samples = VK_SAMPLE_COUNT_1_BIT,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                         .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                         .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
    const VkAttachmentReference reference{.attachment = 0, .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &reference};
    // The submission waits for the semaphore of the image's acquisition at the same stage.
    const VkSubpassDependency dependency{.srcSubpass = VK_SUBPASS_EXTERNAL,
                                         .dstSubpass = 0,
                                         .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         .srcAccessMask = 0,
                                         .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};
    const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 1,
                                      .pAttachments = &colour,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass,
                                      .dependencyCount = 1,
                                      .pDependencies = &dependency};
    pass_ = vulkan::created<UniqueRenderPass>(device(), vkCreateRenderPass, info, "creating a render pass");
  }

  UniqueSemaphore new_semaphore() const {
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    return vulkan::created<UniqueSemaphore>(device(), vkCreateSemaphore, info, "creating a semaphore");
  }

  VkSurfaceCapabilitiesKHR capabilities() const {
    VkSurfaceCapabilitiesKHR capabilities{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_.physical_device(), surface_, &capabilities),
          "asking for the surface's size");
    return capabilities;
  }

  /// True if the surface has an area. A minimised window has none.
  bool has_area(VkExtent2D size) const {
    if (size.width == 0 || size.height == 0) return false;
    const VkExtent2D extent = extent_of(capabilities(), size);
    return extent.width > 0 && extent.height > 0;
  }

  void create_swapchain(VkExtent2D size) {
    const VkSurfaceCapabilitiesKHR allowed = capabilities();
    extent_ = extent_of(allowed, size);
    if (!(allowed.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT))
      throw DeviceError("the Vulkan device cannot read back what it shows on this display");
    const bool is_opaque = (allowed.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0;
    const std::uint32_t most_images = allowed.maxImageCount == 0 ? UINT32_MAX : allowed.maxImageCount;
    const VkSwapchainCreateInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = surface_,
        .minImageCount = std::min(allowed.minImageCount + 1, most_images),
        .imageFormat = format_.format,
        .imageColorSpace = format_.colorSpace,
        .imageExtent = extent_,
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .preTransform = allowed.currentTransform,
        .compositeAlpha = is_opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_TRUE,
        .oldSwapchain = swapchain_.get()};
    swapchain_ = vulkan::created<UniqueSwapchain>(device(), vkCreateSwapchainKHR, info, "creating the window's images");
    std::uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device(), swapchain_.get(), &count, nullptr), "listing the window's images");
    std::vector<VkImage> images(count);
    check(vkGetSwapchainImagesKHR(device(), swapchain_.get(), &count, images.data()), "listing the window's images");
    for (VkImage image : images) add_image(image);
  }

  void recreate_swapchain(VkExtent2D size) {
    check(vkQueueWaitIdle(queue()), "waiting for the device");
    size_ = size;
    images_.clear();
    create_swapchain(size);
  }

  void add_image(VkImage image) {
    const VkImageViewCreateInfo view_info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = format_.format,
        .subresourceRange = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .levelCount = 1, .layerCount = 1}};
    auto view = vulkan::created<UniqueImageView>(device(), vkCreateImageView, view_info, "creating an image view");
    const VkImageView attachment = view.get();
    const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = pass_.get(),
                                       .attachmentCount = 1,
                                       .pAttachments = &attachment,
                                       .width = extent_.width,
                                       .height = extent_.height,
                                       .layers = 1};
    auto framebuffer =
        vulkan::created<UniqueFramebuffer>(device(), vkCreateFramebuffer, info, "creating a framebuffer");
    images_.push_back({image, std::move(view), std::move(framebuffer), new_semaphore()});
  }

  void create_frame() {
    const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                            .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                            .queueFamilyIndex = context_.device().queue_family()};
    pool_ =
        vulkan::created<vulkan::UniqueCommandPool>(device(), vkCreateCommandPool, pool_info, "creating a command pool");
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_.get(),
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device(), &info, &commands_), "allocating a command buffer");
    const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                       .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    done_ = vulkan::created<vulkan::UniqueFence>(device(), vkCreateFence, fence_info, "creating a fence");
    acquired_ = new_semaphore();
  }

  void start_imgui() {
    const VkDescriptorPoolSize size{.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, .descriptorCount = 1};
    const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                               .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                               .maxSets = 1,
                                               .poolSizeCount = 1,
                                               .pPoolSizes = &size};
    descriptors_ = vulkan::created<vulkan::UniqueDescriptorPool>(device(), vkCreateDescriptorPool, pool_info,
                                                                 "creating a descriptor pool");
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = context_.instance();
    info.PhysicalDevice = context_.physical_device();
    info.Device = device();
    info.QueueFamily = context_.device().queue_family();
    info.Queue = queue();
    info.DescriptorPool = descriptors_.get();
    info.MinImageCount = info.ImageCount = 2;  // minimum of ImGui; it makes buffers for this many frames
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = check_imgui;
    ImGui_ImplVulkan_Init(&info, pass_.get());
    load_fonts();
  }

#if IMGUI_VERSION_NUM < 19000
  void load_fonts() {
    begin();
    ImGui_ImplVulkan_CreateFontsTexture(commands_);
    check(vkEndCommandBuffer(commands_), "recording commands");
    submit({.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands_},
           "submitting the fonts");
    wait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
  }
#else
  void load_fonts() { ImGui_ImplVulkan_CreateFontsTexture(); }
#endif

  void wait() const {
    const VkFence fence = done_.get();
    check(vkWaitForFences(device(), 1, &fence, VK_TRUE, UINT64_MAX), "waiting for a frame");
  }

  void begin() const {
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vkBeginCommandBuffer(commands_, &info), "recording commands");
  }

  bool acquire(VkExtent2D size, std::uint32_t& image) {
    for (;;) {
      if (!has_area(size)) return false;
      // Some drivers do not report an outdated image size.
      if (size.width != size_.width || size.height != size_.height) recreate_swapchain(size);
      const VkResult result =
          vkAcquireNextImageKHR(device(), swapchain_.get(), UINT64_MAX, acquired_.get(), VK_NULL_HANDLE, &image);
      if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) return true;
      if (result != VK_ERROR_OUT_OF_DATE_KHR) check(result, "getting an image of the window");
      recreate_swapchain(size);
    }
  }

  void record(const Image& image, ImDrawData* data, const vulkan::Buffer* copy) const {
    begin();
    const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(kBackground);
    const VkClearValue clear{.color = {.float32 = {ground.x, ground.y, ground.z, 1.0F}}};
    const VkRenderPassBeginInfo pass{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                     .renderPass = pass_.get(),
                                     .framebuffer = image.framebuffer.get(),
                                     .renderArea = {.extent = extent_},
                                     .clearValueCount = 1,
                                     .pClearValues = &clear};
    vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(data, commands_);
    vkCmdEndRenderPass(commands_);
    if (copy) record_copy(image.image, *copy);
    check(vkEndCommandBuffer(commands_), "recording commands");
  }

  void record_copy(VkImage image, const vulkan::Buffer& copy) const {
    VkImageMemoryBarrier barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
        .newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .levelCount = 1, .layerCount = 1}};
    // The copy waits for the render pass and for the write.
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr,
                         0, nullptr, 1, &barrier);
    const VkBufferImageCopy region{.imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
                                   .imageExtent = {extent_.width, extent_.height, 1}};
    vkCmdCopyImageToBuffer(commands_, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy.get(), 1, &region);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    barrier.dstAccessMask = 0;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkMemoryBarrier to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, nullptr,
                         1, &barrier);
  }

  void submit(const VkSubmitInfo& info, const char* action) const {
    const VkFence fence = done_.get();
    check(vkResetFences(device(), 1, &fence), "resetting a fence");
    check(vkQueueSubmit(queue(), 1, &info, fence), action);
  }

  void submit_frame(const Image& image) const {
    const VkSemaphore acquired = acquired_.get();
    const VkSemaphore drawn = image.drawn.get();
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    submit({.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
            .waitSemaphoreCount = 1,
            .pWaitSemaphores = &acquired,
            .pWaitDstStageMask = &stage,
            .commandBufferCount = 1,
            .pCommandBuffers = &commands_,
            .signalSemaphoreCount = 1,
            .pSignalSemaphores = &drawn},
           "submitting a frame");
  }

  void present(const Image& image, std::uint32_t index, VkExtent2D size) {
    const VkSemaphore drawn = image.drawn.get();
    const VkSwapchainKHR swapchain = swapchain_.get();
    const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                .waitSemaphoreCount = 1,
                                .pWaitSemaphores = &drawn,
                                .swapchainCount = 1,
                                .pSwapchains = &swapchain,
                                .pImageIndices = &index};
    const VkResult result = vkQueuePresentKHR(queue(), &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
      if (has_area(size)) recreate_swapchain(size);
    } else {
      check(result, "showing a frame");
    }
  }

  std::string png_of(const vulkan::Buffer& copy) const {
    wait();
    std::vector<std::uint8_t> rgba(std::size_t{extent_.width} * extent_.height * kBytesPerPixel);
    copy.read(std::as_writable_bytes(std::span(rgba)));
    for (std::size_t i = 0; i < rgba.size(); i += kBytesPerPixel) {
      if (format_.format == VK_FORMAT_B8G8R8A8_UNORM) std::swap(rgba[i], rgba[i + 2]);
      rgba[i + 3] = UINT8_MAX;
    }
    std::string bytes;
    const auto append = [](void* to, void* data, int size) {
      static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    const auto width = static_cast<int>(extent_.width), height = static_cast<int>(extent_.height);
    constexpr int kChannels = 4;
    if (stbi_write_png_to_func(append, &bytes, width, height, kChannels, rgba.data(), kChannels * width) == 0)
      throw IoError("the picture cannot be made");
    return bytes;
  }

  vulkan::Context& context_;
  VkSurfaceKHR surface_;
  VkExtent2D size_;  ///< size of the window when the swapchain was created
  VkSurfaceFormatKHR format_{};
  UniqueRenderPass pass_;
  VkExtent2D extent_{};
  UniqueSwapchain swapchain_;
  std::vector<Image> images_;
  vulkan::UniqueDescriptorPool descriptors_;
  // For the frame that is being drawn. The next frame is laid out at the same time, and waits for this one before it is
  // recorded.
  vulkan::UniqueCommandPool pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  vulkan::UniqueFence done_;
  UniqueSemaphore acquired_;
};

}  // namespace dolp::explore
