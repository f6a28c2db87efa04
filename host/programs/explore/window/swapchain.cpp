#include "explore/window/swapchain.hpp"

#include <algorithm>
#include <utility>

#include "device/result.hpp"

namespace dolp::explore {
namespace {

using vulkan::check;

constexpr std::uint32_t kOpenSize = UINT32_MAX;  // of VkSurfaceCapabilitiesKHR::currentExtent

VkSurfaceCapabilitiesKHR capabilities_of(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  VkSurfaceCapabilitiesKHR capabilities{};
  check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface, &capabilities), "asking for the surface's size");
  return capabilities;
}

VkExtent2D extent_of(const VkSurfaceCapabilitiesKHR& capabilities, VkExtent2D wanted) {
  if (capabilities.currentExtent.width != kOpenSize) return capabilities.currentExtent;
  const VkExtent2D& least = capabilities.minImageExtent;
  const VkExtent2D& most = capabilities.maxImageExtent;
  return {std::clamp(wanted.width, least.width, most.width), std::clamp(wanted.height, least.height, most.height)};
}

std::uint32_t image_count(const VkSurfaceCapabilitiesKHR& capabilities) {
  const std::uint32_t wanted = capabilities.minImageCount + 1;
  return capabilities.maxImageCount == 0 ? wanted : std::min(wanted, capabilities.maxImageCount);
}

}  // namespace

SurfaceFormat choose_format(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr), "listing the surface's formats");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data()),
        "listing the surface's formats");
  for (const VkSurfaceFormatKHR& format : formats) {
    if (format.format == VK_FORMAT_B8G8R8A8_UNORM) return {format, true};
    if (format.format == VK_FORMAT_R8G8B8A8_UNORM) return {format, false};
  }
  throw DeviceError("the Vulkan device cannot show 8-bit colours on this display");
}

UniqueRenderPass make_render_pass(VkDevice device, VkFormat format) {
  const VkAttachmentDescription colour{.format = format,
                                       .samples = VK_SAMPLE_COUNT_1_BIT,
                                       .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                       .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                       .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                       .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                       .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
                                       .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
  const VkAttachmentReference reference{.attachment = 0, .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkSubpassDescription subpass{
      .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS, .colorAttachmentCount = 1, .pColorAttachments = &reference};
  // The image is there when the semaphore of its acquisition says so, which is waited for at the same stage.
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
  return vulkan::created<UniqueRenderPass>(device, vkCreateRenderPass, info, "creating a render pass");
}

UniqueSemaphore make_semaphore(VkDevice device) {
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  return vulkan::created<UniqueSemaphore>(device, vkCreateSemaphore, info, "creating a semaphore");
}

bool has_area(VkPhysicalDevice physical, VkSurfaceKHR surface, VkExtent2D wanted) {
  const VkExtent2D extent = extent_of(capabilities_of(physical, surface), wanted);
  return extent.width > 0 && extent.height > 0;
}

Swapchain::Swapchain(const vulkan::Context& context, VkSurfaceKHR surface, const SurfaceFormat& format,
                     VkRenderPass pass, VkExtent2D wanted, VkSwapchainKHR old) {
  create(context, surface, format, wanted, old);
  const VkDevice device = context.device().get();
  std::uint32_t count = 0;
  check(vkGetSwapchainImagesKHR(device, swapchain_.get(), &count, nullptr), "listing the window's images");
  std::vector<VkImage> images(count);
  check(vkGetSwapchainImagesKHR(device, swapchain_.get(), &count, images.data()), "listing the window's images");
  for (VkImage image : images) add_image(device, image, format.format.format, pass);
}

void Swapchain::create(const vulkan::Context& context, VkSurfaceKHR surface, const SurfaceFormat& format,
                       VkExtent2D wanted, VkSwapchainKHR old) {
  const VkSurfaceCapabilitiesKHR capabilities = capabilities_of(context.physical_device(), surface);
  extent_ = extent_of(capabilities, wanted);
  if (!(capabilities.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT)) {
    throw DeviceError("the Vulkan device cannot read back what it shows on this display");
  }
  const bool is_opaque = (capabilities.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0;
  const VkSwapchainCreateInfoKHR info{
      .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
      .surface = surface,
      .minImageCount = image_count(capabilities),
      .imageFormat = format.format.format,
      .imageColorSpace = format.format.colorSpace,
      .imageExtent = extent_,
      .imageArrayLayers = 1,
      .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
      .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
      .preTransform = capabilities.currentTransform,
      .compositeAlpha = is_opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
      .presentMode = VK_PRESENT_MODE_FIFO_KHR,
      .clipped = VK_TRUE,
      .oldSwapchain = old};
  swapchain_ = vulkan::created<UniqueSwapchain>(context.device().get(), vkCreateSwapchainKHR, info,
                                                "creating the window's images");
}

void Swapchain::add_image(VkDevice device, VkImage image, VkFormat format, VkRenderPass pass) {
  const VkImageViewCreateInfo view_info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
      .image = image,
      .viewType = VK_IMAGE_VIEW_TYPE_2D,
      .format = format,
      .subresourceRange = {.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .levelCount = 1, .layerCount = 1}};
  auto view = vulkan::created<UniqueImageView>(device, vkCreateImageView, view_info, "creating an image view");
  const VkImageView attachment = view.get();
  const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                     .renderPass = pass,
                                     .attachmentCount = 1,
                                     .pAttachments = &attachment,
                                     .width = extent_.width,
                                     .height = extent_.height,
                                     .layers = 1};
  auto framebuffer = vulkan::created<UniqueFramebuffer>(device, vkCreateFramebuffer, info, "creating a framebuffer");
  images_.push_back({image, std::move(view), std::move(framebuffer), make_semaphore(device)});
}

}  // namespace dolp::explore
