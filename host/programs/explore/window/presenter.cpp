#include "explore/window/presenter.hpp"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "base/atomic_file.hpp"
#include "device/result.hpp"
#include "explore/window/style.hpp"

namespace dolp::explore {
namespace {

using vulkan::check;

constexpr std::size_t kBytesPerPixel = 4;

void check_imgui(VkResult result) { check(result, "drawing the window"); }

}  // namespace

Presenter::Presenter(vulkan::Context& context, VkSurfaceKHR surface, VkExtent2D size)
    : context_(context), surface_(surface), size_(size) {
  VkBool32 is_supported = VK_FALSE;
  check(vkGetPhysicalDeviceSurfaceSupportKHR(context.physical_device(), context.device().queue_family(), surface,
                                             &is_supported),
        "asking whether the device can show the window");
  if (is_supported == VK_FALSE) throw DeviceError(context.description().name + " cannot show a window on this display");
  format_ = choose_format(context.physical_device(), surface);
  pass_ = make_render_pass(context.device().get(), format_.format.format);
  swapchain_ = std::make_unique<Swapchain>(context, surface, format_, pass_.get(), size, VK_NULL_HANDLE);
  create_frame();
  start_imgui();
}

Presenter::~Presenter() {
  vkQueueWaitIdle(context_.device().queue());
  ImGui_ImplVulkan_Shutdown();
  swapchain_.reset();
  vkDestroySurfaceKHR(context_.instance(), surface_, nullptr);
}

void Presenter::create_frame() {
  const VkDevice device = context_.device().get();
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = context_.device().queue_family()};
  pool_ = vulkan::created<vulkan::UniqueCommandPool>(device, vkCreateCommandPool, pool_info, "creating a command pool");
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pool_.get(),
                                         .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                         .commandBufferCount = 1};
  check(vkAllocateCommandBuffers(device, &info, &commands_), "allocating a command buffer");
  const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                     .flags = VK_FENCE_CREATE_SIGNALED_BIT};
  done_ = vulkan::created<vulkan::UniqueFence>(device, vkCreateFence, fence_info, "creating a fence");
  acquired_ = make_semaphore(device);
}

void Presenter::start_imgui() {
  const VkDevice device = context_.device().get();
  const VkDescriptorPoolSize size{.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, .descriptorCount = 1};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
  descriptors_ = vulkan::created<vulkan::UniqueDescriptorPool>(device, vkCreateDescriptorPool, pool_info,
                                                               "creating a descriptor pool");
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = context_.instance();
  info.PhysicalDevice = context_.physical_device();
  info.Device = device;
  info.QueueFamily = context_.device().queue_family();
  info.Queue = context_.device().queue();
  info.DescriptorPool = descriptors_.get();
  info.MinImageCount = info.ImageCount = 2;  // the least that it takes: buffers of this many frames
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = check_imgui;
  ImGui_ImplVulkan_Init(&info, pass_.get());
  load_fonts();
}

void Presenter::restart_imgui() {
  wait();
  ImGui_ImplVulkan_Shutdown();
  start_imgui();
}

#if IMGUI_VERSION_NUM < 19000
void Presenter::load_fonts() {
  begin();
  ImGui_ImplVulkan_CreateFontsTexture(commands_);
  check(vkEndCommandBuffer(commands_), "recording commands");
  submit({.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands_},
         "submitting the fonts");
  wait();
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}
#else
void Presenter::load_fonts() { ImGui_ImplVulkan_CreateFontsTexture(); }
#endif

void Presenter::wait() const {
  const VkFence fence = done_.get();
  check(vkWaitForFences(context_.device().get(), 1, &fence, VK_TRUE, UINT64_MAX), "waiting for a frame");
}

void Presenter::begin() const {
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(commands_, &info), "recording commands");
}

void Presenter::recreate(VkExtent2D size) {
  check(vkQueueWaitIdle(context_.device().queue()), "waiting for the device");
  size_ = size;
  auto next = std::make_unique<Swapchain>(context_, surface_, format_, pass_.get(), size, swapchain_->get());
  swapchain_ = std::move(next);
}

bool Presenter::acquire(VkExtent2D size, std::uint32_t& image) {
  for (;;) {
    if (size.width == 0 || size.height == 0 || !has_area(context_.physical_device(), surface_, size)) return false;
    // Not every driver tells that its images have an old size.
    if (size.width != size_.width || size.height != size_.height) recreate(size);
    const VkResult result = vkAcquireNextImageKHR(context_.device().get(), swapchain_->get(), UINT64_MAX,
                                                  acquired_.get(), VK_NULL_HANDLE, &image);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) return true;
    if (result != VK_ERROR_OUT_OF_DATE_KHR) check(result, "getting an image of the window");
    recreate(size);
  }
}

void Presenter::draw(ImDrawData* data, VkExtent2D size, Picture* picture) {
  wait();
  std::uint32_t index = 0;
  if (!acquire(size, index)) return;
  const Swapchain::Image& image = swapchain_->images()[index];
  const VkExtent2D extent = swapchain_->extent();
  std::optional<vulkan::Buffer> copy;
  if (picture) {
    copy.emplace(context_.device(), VkDeviceSize{extent.width} * extent.height * kBytesPerPixel,
                 vulkan::MemoryUse::kReadback);
  }
  record(image, data, copy ? &*copy : nullptr);
  submit_frame(image);
  if (picture) *picture = read(*copy);
  present(image, index, size);
}

void Presenter::record(const Swapchain::Image& image, ImDrawData* data, const vulkan::Buffer* copy) const {
  begin();
  const ImVec4 ground = ImGui::ColorConvertU32ToFloat4(kBackground);
  const VkClearValue clear{.color = {.float32 = {ground.x, ground.y, ground.z, 1.0F}}};
  const VkRenderPassBeginInfo pass{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = pass_.get(),
                                   .framebuffer = image.framebuffer.get(),
                                   .renderArea = {.extent = swapchain_->extent()},
                                   .clearValueCount = 1,
                                   .pClearValues = &clear};
  vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(data, commands_);
  vkCmdEndRenderPass(commands_);
  if (copy) record_copy(image.image, *copy);
  check(vkEndCommandBuffer(commands_), "recording commands");
}

void Presenter::record_copy(VkImage image, const vulkan::Buffer& copy) const {
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
  // Both ends of the pass's implicit dependency and of the write itself come before the copy.
  vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &barrier);
  const VkExtent2D extent = swapchain_->extent();
  const VkBufferImageCopy region{.imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
                                 .imageExtent = {extent.width, extent.height, 1}};
  vkCmdCopyImageToBuffer(commands_, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy.get(), 1, &region);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.dstAccessMask = 0;
  barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkMemoryBarrier to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, nullptr, 1,
                       &barrier);
}

void Presenter::submit(const VkSubmitInfo& info, const char* action) const {
  const VkFence fence = done_.get();
  check(vkResetFences(context_.device().get(), 1, &fence), "resetting a fence");
  check(vkQueueSubmit(context_.device().queue(), 1, &info, fence), action);
}

void Presenter::submit_frame(const Swapchain::Image& image) const {
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

void Presenter::present(const Swapchain::Image& image, std::uint32_t index, VkExtent2D size) {
  const VkSemaphore drawn = image.drawn.get();
  const VkSwapchainKHR swapchain = swapchain_->get();
  const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                              .waitSemaphoreCount = 1,
                              .pWaitSemaphores = &drawn,
                              .swapchainCount = 1,
                              .pSwapchains = &swapchain,
                              .pImageIndices = &index};
  const VkResult result = vkQueuePresentKHR(context_.device().queue(), &info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
    if (size.width > 0 && size.height > 0 && has_area(context_.physical_device(), surface_, size)) recreate(size);
    return;
  }
  check(result, "showing a frame");
}

Picture Presenter::read(const vulkan::Buffer& copy) const {
  wait();
  const VkExtent2D extent = swapchain_->extent();
  Picture picture{extent.width, extent.height, {}};
  picture.rgba.resize(std::size_t{extent.width} * extent.height * kBytesPerPixel);
  copy.read(std::as_writable_bytes(std::span(picture.rgba)));
  for (std::size_t i = 0; i < picture.rgba.size(); i += kBytesPerPixel) {
    if (format_.is_bgr) std::swap(picture.rgba[i], picture.rgba[i + 2]);
    picture.rgba[i + 3] = UINT8_MAX;
  }
  return picture;
}

void write_png(const Picture& picture, const std::string& path) {
  constexpr int kChannels = 4;
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  const int width = static_cast<int>(picture.width);
  const int height = static_cast<int>(picture.height);
  if (stbi_write_png_to_func(append, &bytes, width, height, kChannels, picture.rgba.data(), kChannels * width) == 0) {
    throw IoError(path + ": the picture cannot be made");
  }
  write_text_atomically(path, bytes);
}

}  // namespace dolp::explore
