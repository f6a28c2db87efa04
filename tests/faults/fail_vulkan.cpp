// A library that is preloaded into a program and makes Vulkan calls fail. Environment:
//   DOLP_FAIL_VULKAN     FUNCTION:N:RESULT makes the N-th call of FUNCTION return the number RESULT. For example,
//                        vkQueueSubmit:3:-4 loses the device at the third submission. With N+ instead of N all later
//                        calls fail, too. If RESULT is the word `never`, the call does not return.
//   DOLP_VULKAN_MEMORY   bytes: larger pieces of device memory are refused
//   DOLP_VULKAN_WITHOUT  float64, compute or version: devices lack double precision, compute queues or Vulkan 1.2.
//                        processor: devices say that they are discrete GPUs
//   DOLP_VULKAN_TEXELS   the devices allow only this number of texels in a buffer; views of larger buffers fail
//   DOLP_VULKAN_DISPATCH a submission with a dispatch of more workgroups than this number loses the device
//   DOLP_COUNT_SUBMISSIONS a file that receives the number of submissions when the program ends
#include <dlfcn.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// The fault that DOLP_FAIL_VULKAN selects.
struct Fault {
  Fault() {
    const std::string text = from_environment("DOLP_FAIL_VULKAN");
    const std::size_t first = text.find(':');
    const std::size_t second = text.rfind(':');
    if (first == std::string::npos || second == first) return;
    function = text.substr(0, first);
    call = std::stoul(text.substr(first + 1));
    all_after = text[second - 1] == '+';
    never_returns = text.substr(second + 1) == "never";
    if (!never_returns) result = static_cast<VkResult>(std::stoi(text.substr(second + 1)));
  }
  std::string function;
  unsigned long call = 0;
  bool all_after = false;
  bool never_returns = false;
  VkResult result = VK_SUCCESS;
};

std::atomic<unsigned long> submissions{0};
std::atomic<bool> has_large_dispatch{false};

/// VK_SUCCESS, or the result with which this call must fail.
VkResult fault_of(const char* function) {
  static const Fault fault;
  static std::atomic<unsigned long> calls{0};
  if (fault.function != function) return VK_SUCCESS;
  const unsigned long call = ++calls;
  const bool fails = call == fault.call || (fault.all_after && call > fault.call);
  while (fails && fault.never_returns) ::pause();
  return fails ? fault.result : VK_SUCCESS;
}

bool lacks(const char* what) {
  static const std::string lacking = from_environment("DOLP_VULKAN_WITHOUT");
  return lacking == what;
}

/// The value of DOLP_VULKAN_TEXELS, or no limit.
uint32_t most_texels() {
  static const std::string most = from_environment("DOLP_VULKAN_TEXELS");
  return most.empty() ? UINT32_MAX : static_cast<uint32_t>(std::stoul(most));
}

[[gnu::destructor]] void report_count() {
  const std::string path = from_environment("DOLP_COUNT_SUBMISSIONS");
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (file == nullptr) return;
  std::fprintf(file, "%lu\n", submissions.load());
  std::fclose(file);
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

// NOLINTBEGIN(bugprone-macro-parentheses): what comes in parentheses has them.
#define DOLP_MAY_FAIL(name, parameters, arguments)                          \
  extern "C" VKAPI_ATTR VkResult VKAPI_CALL name parameters {               \
    const VkResult fault = fault_of(#name);                                 \
    return fault == VK_SUCCESS ? next<PFN_##name>(#name) arguments : fault; \
  }
// NOLINTEND(bugprone-macro-parentheses)

DOLP_MAY_FAIL(vkCreateInstance, (const VkInstanceCreateInfo* i, const VkAllocationCallbacks* a, VkInstance* o),
              (i, a, o))
DOLP_MAY_FAIL(vkEnumeratePhysicalDevices, (VkInstance i, uint32_t* n, VkPhysicalDevice* o), (i, n, o))
DOLP_MAY_FAIL(vkCreateDevice,
              (VkPhysicalDevice p, const VkDeviceCreateInfo* i, const VkAllocationCallbacks* a, VkDevice* o),
              (p, i, a, o))
DOLP_MAY_FAIL(vkCreateCommandPool,
              (VkDevice d, const VkCommandPoolCreateInfo* i, const VkAllocationCallbacks* a, VkCommandPool* o),
              (d, i, a, o))
DOLP_MAY_FAIL(vkAllocateCommandBuffers, (VkDevice d, const VkCommandBufferAllocateInfo* i, VkCommandBuffer* o),
              (d, i, o))
DOLP_MAY_FAIL(vkCreateBuffer, (VkDevice d, const VkBufferCreateInfo* i, const VkAllocationCallbacks* a, VkBuffer* o),
              (d, i, a, o))
DOLP_MAY_FAIL(vkBindBufferMemory, (VkDevice d, VkBuffer b, VkDeviceMemory m, VkDeviceSize o), (d, b, m, o))
DOLP_MAY_FAIL(vkMapMemory, (VkDevice d, VkDeviceMemory m, VkDeviceSize o, VkDeviceSize s, VkMemoryMapFlags f, void** p),
              (d, m, o, s, f, p))
DOLP_MAY_FAIL(vkCreateDescriptorSetLayout,
              (VkDevice d, const VkDescriptorSetLayoutCreateInfo* i, const VkAllocationCallbacks* a,
               VkDescriptorSetLayout* o),
              (d, i, a, o))
DOLP_MAY_FAIL(vkAllocateDescriptorSets, (VkDevice d, const VkDescriptorSetAllocateInfo* i, VkDescriptorSet* o),
              (d, i, o))
DOLP_MAY_FAIL(vkCreateShaderModule,
              (VkDevice d, const VkShaderModuleCreateInfo* i, const VkAllocationCallbacks* a, VkShaderModule* o),
              (d, i, a, o))
DOLP_MAY_FAIL(vkCreateComputePipelines,
              (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo* i,
               const VkAllocationCallbacks* a, VkPipeline* o),
              (d, c, n, i, a, o))
DOLP_MAY_FAIL(vkBeginCommandBuffer, (VkCommandBuffer c, const VkCommandBufferBeginInfo* i), (c, i))
DOLP_MAY_FAIL(vkEndCommandBuffer, (VkCommandBuffer c), (c))

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits,
                                                        VkFence fence) {
  ++submissions;
  if (has_large_dispatch.exchange(false)) return VK_ERROR_DEVICE_LOST;
  const VkResult fault = fault_of("vkQueueSubmit");
  return fault == VK_SUCCESS ? next<PFN_vkQueueSubmit>("vkQueueSubmit")(queue, count, submits, fence) : fault;
}

// Calls the real function before it reports a fault. After a fault the program frees the memory of the submitted work.
// So the real device must have finished this work.
extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkWaitForFences(VkDevice device, uint32_t count, const VkFence* fences,
                                                          VkBool32 all, uint64_t timeout) {
  const VkResult result = next<PFN_vkWaitForFences>("vkWaitForFences")(device, count, fences, all, timeout);
  const VkResult fault = fault_of("vkWaitForFences");
  return fault == VK_SUCCESS ? result : fault;
}

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                                           const VkAllocationCallbacks* callbacks,
                                                           VkDeviceMemory* memory) {
  static const std::string most = from_environment("DOLP_VULKAN_MEMORY");
  if (!most.empty() && info->allocationSize > std::stoul(most)) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  const VkResult fault = fault_of("vkAllocateMemory");
  if (fault != VK_SUCCESS) return fault;
  return next<PFN_vkAllocateMemory>("vkAllocateMemory")(device, info, callbacks, memory);
}

extern "C" VKAPI_ATTR void VKAPI_CALL vkCmdDispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
  static const std::string most = from_environment("DOLP_VULKAN_DISPATCH");
  if (!most.empty() && x > std::stoul(most)) has_large_dispatch = true;
  next<PFN_vkCmdDispatch>("vkCmdDispatch")(commands, x, y, z);
}

extern "C" VKAPI_ATTR void VKAPI_CALL vkGetPhysicalDeviceFeatures(VkPhysicalDevice device,
                                                                  VkPhysicalDeviceFeatures* features) {
  next<PFN_vkGetPhysicalDeviceFeatures>("vkGetPhysicalDeviceFeatures")(device, features);
  if (lacks("float64")) features->shaderFloat64 = VK_FALSE;
}

extern "C" VKAPI_ATTR void VKAPI_CALL vkGetPhysicalDeviceProperties(VkPhysicalDevice device,
                                                                    VkPhysicalDeviceProperties* properties) {
  next<PFN_vkGetPhysicalDeviceProperties>("vkGetPhysicalDeviceProperties")(device, properties);
  if (lacks("version")) properties->apiVersion = VK_API_VERSION_1_1;
  if (lacks("processor")) properties->deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  properties->limits.maxTexelBufferElements = std::min(properties->limits.maxTexelBufferElements, most_texels());
}

// The program views whole buffers.
extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkCreateBufferView(VkDevice device, const VkBufferViewCreateInfo* info,
                                                             const VkAllocationCallbacks* callbacks,
                                                             VkBufferView* view) {
  VkMemoryRequirements buffer{};
  next<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(device, info->buffer, &buffer);
  const VkDeviceSize texel_bytes = info->format == VK_FORMAT_R32G32_SFLOAT ? 8 : 16;
  if (buffer.size / texel_bytes > most_texels()) return VK_ERROR_FORMAT_NOT_SUPPORTED;
  return next<PFN_vkCreateBufferView>("vkCreateBufferView")(device, info, callbacks, view);
}

extern "C" VKAPI_ATTR void VKAPI_CALL vkGetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice device, uint32_t* count,
                                                                               VkQueueFamilyProperties* families) {
  next<PFN_vkGetPhysicalDeviceQueueFamilyProperties>("vkGetPhysicalDeviceQueueFamilyProperties")(device, count,
                                                                                                 families);
  if (families == nullptr || !lacks("compute")) return;
  for (uint32_t i = 0; i < *count; ++i) families[i].queueFlags &= ~static_cast<VkQueueFlags>(VK_QUEUE_COMPUTE_BIT);
}
