#include "explore/window/presenter.hpp"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <cstddef>
#include <span>
#include <utility>

#include "device/result.hpp"

namespace dolp::explore {
namespace {

using vulkan::check;

constexpr VkClearValue kBackground{.color = {.float32 = {0.11F, 0.12F, 0.13F, 1.0F}}};
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
  create_frames();
  start_imgui();
}

Presenter::~Presenter() {
  vkQueueWaitIdle(context_.device().queue());
  ImGui_ImplVulkan_Shutdown();
  swapchain_.reset();
  vkDestroySurfaceKHR(context_.instance(), surface_, nullptr);
}

void Presenter::create_frames() {
  const VkDevice device = context_.device().get();
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = context_.device().queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "creating a command pool");
  commands_ = vulkan::UniqueCommandPool(device, pool);
  for (Frame& frame : frames_) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    check(vkAllocateCommandBuffers(device, &info, &frame.commands), "allocating a command buffer");
    const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                       .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    VkFence fence = VK_NULL_HANDLE;
    check(vkCreateFence(device, &fence_info, nullptr, &fence), "creating a fence");
    frame.done = vulkan::UniqueFence(device, fence);
    frame.acquired = make_semaphore(device);
  }
}

void Presenter::start_imgui() {
  const VkDevice device = context_.device().get();
  const VkDescriptorPoolSize size{.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, .descriptorCount = 1};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "creating a descriptor pool");
  descriptors_ = vulkan::UniqueDescriptorPool(device, pool);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = context_.instance();
  info.PhysicalDevice = context_.physical_device();
  info.Device = device;
  info.QueueFamily = context_.device().queue_family();
  info.Queue = context_.device().queue();
  info.DescriptorPool = pool;
  // ImGui's resources of each image are free again when the frame in flight is done.
  info.MinImageCount = info.ImageCount = static_cast<std::uint32_t>(kFramesInFlight);
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  info.CheckVkResultFn = check_imgui;
  ImGui_ImplVulkan_Init(&info, pass_.get());

  const Frame& frame = frames_[0];
  wait(frame);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(frame.commands, &begin), "recording commands");
  ImGui_ImplVulkan_CreateFontsTexture(frame.commands);
  check(vkEndCommandBuffer(frame.commands), "recording commands");
  const VkSubmitInfo submission{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &frame.commands};
  const VkFence fence = frame.done.get();
  check(vkResetFences(device, 1, &fence), "resetting a fence");
  check(vkQueueSubmit(context_.device().queue(), 1, &submission, fence), "submitting the fonts");
  wait(frame);
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void Presenter::wait(const Frame& frame) const {
  const VkFence fence = frame.done.get();
  check(vkWaitForFences(context_.device().get(), 1, &fence, VK_TRUE, UINT64_MAX), "waiting for a frame");
}

void Presenter::recreate(VkExtent2D size) {
  check(vkQueueWaitIdle(context_.device().queue()), "waiting for the device");
  size_ = size;
  auto next = std::make_unique<Swapchain>(context_, surface_, format_, pass_.get(), size, swapchain_->get());
  swapchain_ = std::move(next);
}

bool Presenter::acquire(Frame& frame, VkExtent2D size, std::uint32_t& image) {
  for (;;) {
    if (size.width == 0 || size.height == 0 || !has_area(context_.physical_device(), surface_, size)) return false;
    // Not every driver tells that its images have an old size.
    if (size.width != size_.width || size.height != size_.height) recreate(size);
    const VkResult result = vkAcquireNextImageKHR(context_.device().get(), swapchain_->get(), UINT64_MAX,
                                                  frame.acquired.get(), VK_NULL_HANDLE, &image);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) return true;
    if (result != VK_ERROR_OUT_OF_DATE_KHR) check(result, "getting an image of the window");
    recreate(size);
  }
}

void Presenter::draw(ImDrawData* data, VkExtent2D size, Picture* picture) {
  Frame& frame = frames_[next_frame_];
  wait(frame);
  std::uint32_t index = 0;
  if (!acquire(frame, size, index)) return;
  const Swapchain::Image& image = swapchain_->images()[index];
  const VkExtent2D extent = swapchain_->extent();
  std::optional<vulkan::Buffer> copy;
  if (picture) {
    copy.emplace(context_.device(), VkDeviceSize{extent.width} * extent.height * kBytesPerPixel,
                 vulkan::MemoryUse::kReadback);
  }
  record(frame, image, data, copy ? &*copy : nullptr);
  submit(frame, image);
  if (picture) *picture = read(frame, *copy);
  present(image, index, size);
  next_frame_ = (next_frame_ + 1) % kFramesInFlight;
}

void Presenter::record(const Frame& frame, const Swapchain::Image& image, ImDrawData* data,
                       const vulkan::Buffer* copy) const {
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(frame.commands, &begin), "recording commands");
  const VkRenderPassBeginInfo pass{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = pass_.get(),
                                   .framebuffer = image.framebuffer.get(),
                                   .renderArea = {.extent = swapchain_->extent()},
                                   .clearValueCount = 1,
                                   .pClearValues = &kBackground};
  vkCmdBeginRenderPass(frame.commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(data, frame.commands);
  vkCmdEndRenderPass(frame.commands);
  if (copy) record_copy(frame.commands, image.image, *copy);
  check(vkEndCommandBuffer(frame.commands), "recording commands");
}

void Presenter::record_copy(VkCommandBuffer commands, VkImage image, const vulkan::Buffer& copy) const {
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
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &barrier);
  const VkExtent2D extent = swapchain_->extent();
  const VkBufferImageCopy region{.imageSubresource = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .layerCount = 1},
                                 .imageExtent = {extent.width, extent.height, 1}};
  vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, copy.get(), 1, &region);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.dstAccessMask = 0;
  barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkMemoryBarrier to_host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, nullptr, 1,
                       &barrier);
}

void Presenter::submit(const Frame& frame, const Swapchain::Image& image) const {
  const VkSemaphore acquired = frame.acquired.get();
  const VkSemaphore drawn = image.drawn.get();
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .waitSemaphoreCount = 1,
                          .pWaitSemaphores = &acquired,
                          .pWaitDstStageMask = &stage,
                          .commandBufferCount = 1,
                          .pCommandBuffers = &frame.commands,
                          .signalSemaphoreCount = 1,
                          .pSignalSemaphores = &drawn};
  const VkFence fence = frame.done.get();
  check(vkResetFences(context_.device().get(), 1, &fence), "resetting a fence");
  check(vkQueueSubmit(context_.device().queue(), 1, &info, fence), "submitting a frame");
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

Picture Presenter::read(const Frame& frame, const vulkan::Buffer& copy) const {
  wait(frame);
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

}  // namespace dolp::explore
