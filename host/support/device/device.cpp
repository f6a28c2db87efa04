#include "device/device.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "device/context.hpp"
#include "device/result.hpp"

namespace dolp::vulkan {
namespace {

std::vector<VkQueueFamilyProperties> queue_families(VkPhysicalDevice physical) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  return families;
}

VkDeviceSize largest_device_heap(const VkPhysicalDeviceMemoryProperties& memory) {
  VkDeviceSize largest = 0;
  for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps, memory.memoryHeapCount)) {
    if (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) largest = std::max(largest, heap.size);
  }
  return largest;
}

dolp::Device::Type device_type(VkPhysicalDeviceType type) {
  using enum dolp::Device::Type;
  // in the order of the values of VkPhysicalDeviceType
  constexpr std::array kTypes = {kOther, kIntegrated, kDiscrete, kVirtual, kCpu};
  const auto number = static_cast<std::size_t>(type);
  return number < kTypes.size() ? kTypes[number] : kOther;
}

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + '.' + std::to_string(VK_API_VERSION_MINOR(version)) + '.' +
         std::to_string(VK_API_VERSION_PATCH(version));
}

std::string why_not_usable(const VkPhysicalDeviceProperties& properties, bool has_compute_queue) {
  if (properties.apiVersion < VK_API_VERSION_1_2) return "Vulkan " + version_text(properties.apiVersion) + " < 1.2";
  if (!has_compute_queue) return "no compute queue";
  if (properties.limits.maxPerStageDescriptorStorageBuffers < kStorageCount) {
    return "only " + std::to_string(properties.limits.maxPerStageDescriptorStorageBuffers) + " storage buffers, " +
           std::to_string(kStorageCount) + " needed";
  }
  return {};
}

void add_properties_1_2(VkPhysicalDevice physical, dolp::Device& description) {
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
                                              .pNext = &driver};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  description.driver = driver.driverName;
  if (driver.driverInfo[0] != '\0') description.driver += std::string(" ") + driver.driverInfo;
  description.subgroup_size = subgroup.subgroupSize;
}

// On a CPU the program makes a workgroup as small as a subgroup, because a small dispatch would not fill larger ones.
std::uint32_t choose_local_size(const dolp::Device& device) {
  if (device.type != dolp::Device::Type::kCpu || device.subgroup_size == 0) return kLocalSize;
  return std::min(device.subgroup_size, kLocalSize);
}

}  // namespace

std::optional<std::uint32_t> choose_queue_family(std::span<const VkQueueFamilyProperties> families) {
  std::optional<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    const VkQueueFlags flags = families[i].queueFlags;
    if (!(flags & VK_QUEUE_COMPUTE_BIT)) continue;
    if (!(flags & VK_QUEUE_GRAPHICS_BIT)) return i;
    if (!chosen) chosen = i;
  }
  return chosen;
}

dolp::Device describe(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  VkPhysicalDeviceFeatures features{};
  vkGetPhysicalDeviceFeatures(physical, &features);
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  const std::vector<VkQueueFamilyProperties> families = queue_families(physical);
  const std::optional<std::uint32_t> family = choose_queue_family(families);

  dolp::Device description;
  description.name = properties.deviceName;
  description.type = device_type(properties.deviceType);
  description.driver = version_text(properties.driverVersion);
  description.api_version = version_text(properties.apiVersion);
  description.why_not = why_not_usable(properties, family.has_value());
  description.usable = description.why_not.empty();
  description.has_double = features.shaderFloat64 == VK_TRUE;
  description.max_storage_buffer_bytes = properties.limits.maxStorageBufferRange;
  description.max_texels = properties.limits.maxTexelBufferElements;
  description.max_workgroups = properties.limits.maxComputeWorkGroupCount[0];
  description.memory_bytes = largest_device_heap(memory);
  description.timestamps = family && families[*family].timestampValidBits > 0;
  if (properties.apiVersion >= VK_API_VERSION_1_2) add_properties_1_2(physical, description);
  description.local_size = choose_local_size(description);
  return description;
}

Device::Device(VkPhysicalDevice physical, DeviceFeatures features) : features_(features) {
  const std::vector<VkQueueFamilyProperties> families = queue_families(physical);
  const std::optional<std::uint32_t> family = choose_queue_family(families);
  if (!family) throw DeviceError("the Vulkan device has no compute queue");
  queue_family_ = *family;
  timestamp_bits_ = families[*family].timestampValidBits;
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  limits_ = properties.limits;
  local_size_ = describe(physical).local_size;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory_);

  const float priority = 1.0F;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = queue_family_,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  const VkPhysicalDeviceFeatures enabled{.shaderFloat64 = features.float64 ? VK_TRUE : VK_FALSE};
  const VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
      .pipelineExecutableInfo = VK_TRUE};
  const char* const extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = features.statistics ? &statistics : nullptr,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = features.statistics ? 1U : 0U,
                                .ppEnabledExtensionNames = &extension,
                                .pEnabledFeatures = &enabled};
  const VkResult result = vkCreateDevice(physical, &info, nullptr, &device_);
  if (result == VK_ERROR_EXTENSION_NOT_PRESENT) {
    throw DeviceError(std::string("the Vulkan driver reports no statistics of kernels: it lacks ") + extension);
  }
  check(result, "creating the device");
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
}

Device::~Device() { vkDestroyDevice(device_, nullptr); }

MemoryType Device::memory_type(std::uint32_t allowed, MemoryUse use) const {
  VkMemoryPropertyFlags required = 0;
  VkMemoryPropertyFlags preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (use != MemoryUse::kDeviceOnly) required = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
  // The host would need a hundred times as long to read results from memory that it does not cache.
  if (use == MemoryUse::kReadback) preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

  std::optional<MemoryType> best;
  for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags flags = memory_.memoryTypes[i].propertyFlags;
    if (!(allowed & (1U << i)) || (flags & required) != required) continue;
    if (!best || (!(best->flags & preferred) && (flags & preferred))) best = MemoryType{i, flags};
  }
  if (!best) throw DeviceError("the Vulkan device has no memory for a storage buffer that the host can map");
  return *best;
}

}  // namespace dolp::vulkan
