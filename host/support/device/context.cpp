#include "device/context.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

#include "device/result.hpp"

namespace dolp::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::array kValidationExtensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                              VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
constexpr const char* kNoDriver =
    "no Vulkan driver was found (on Debian, mesa-vulkan-drivers has one that needs no GPU; VK_DRIVER_FILES and "
    "VK_ICD_FILENAMES override the search)";
// If a driver file is malformed, the Vulkan loader reports "out of memory". Real lack of memory causes other errors.
constexpr const char* kDriverNotLoaded =
    "no Vulkan driver could be loaded: its file (VK_DRIVER_FILES, VK_ICD_FILENAMES, vulkan/icd.d) is malformed";

constexpr const char* kTooFewThreads =
    "out of memory: the system allows too few threads for a Vulkan driver (ulimit -u); the evaluator cpu needs one";

/// Throws the error for a missing driver: MemoryError if the loader skipped all drivers for lack of address space.
[[noreturn]] void fail_without_driver() {
  if (lacks_addresses()) throw MemoryError("out of memory: too little is left to load a Vulkan driver");
  throw DeviceError(kNoDriver);
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
  static_cast<ValidationLog*>(log)->add(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog* log) {
  // Leaves out messages of type "general", because the Vulkan loader sends them even for drivers that are never used.
  return {
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
      .pfnUserCallback = on_message,
      .pUserData = log};
}

bool asks_for_validation() {
  const char* value = std::getenv("DOLP_VALIDATION");
  return value && std::string_view(value) == "1";
}

}  // namespace

void ValidationLog::add(std::string message) {
  const std::scoped_lock lock(mutex_);
  messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::messages() const {
  const std::scoped_lock lock(mutex_);
  return messages_;
}

Instance::Instance(ValidationLog* log) {
  if (lacks_threads() && !lacks_addresses()) throw MemoryError(kTooFewThreads);
  const VkApplicationInfo application{
      .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "dolp", .apiVersion = VK_API_VERSION_1_2};
  const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(log);
  const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = &synchronization};
  VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
  if (log) {
    info.enabledExtensionCount = static_cast<std::uint32_t>(kValidationExtensions.size());
    info.ppEnabledExtensionNames = kValidationExtensions.data();
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (log && result == VK_ERROR_LAYER_NOT_PRESENT) {
    throw DeviceError(std::string("validation is wanted, but the layer ") + kValidationLayer +
                      " is not installed (on Debian, vulkan-validationlayers)");
  }
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) fail_without_driver();
  if (result == VK_ERROR_OUT_OF_HOST_MEMORY) throw DeviceError(kDriverNotLoaded);
  check(result, "creating the instance");
  if (log) attach(messenger);
}

void Instance::attach(const VkDebugUtilsMessengerCreateInfoEXT& info) {
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  const VkResult result = create ? create(instance_, &info, nullptr, &messenger_) : VK_ERROR_EXTENSION_NOT_PRESENT;
  if (result != VK_SUCCESS) vkDestroyInstance(instance_, nullptr);
  check(result, "attaching the validation messenger");
}

Instance::~Instance() {
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  vkDestroyInstance(instance_, nullptr);
}

std::vector<VkPhysicalDevice> Instance::physical_devices() const {
  std::uint32_t count = 0;
  const VkResult result = vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  // Without hardware, drivers return this error or an empty list.
  if (result == VK_ERROR_INITIALIZATION_FAILED || (result == VK_SUCCESS && count == 0)) fail_without_driver();
  check(result, "listing the devices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "listing the devices");
  return devices;
}

Context::Context(const DeviceSelector& wish)
    : instance_(std::make_unique<Instance>(wish.has_validation || asks_for_validation() ? &log_ : nullptr)) {
  const std::vector<VkPhysicalDevice> physical = instance_->physical_devices();
  std::vector<dolp::Device> descriptions;
  for (VkPhysicalDevice device : physical) descriptions.push_back(describe(device));
  const std::size_t index = choose_device(descriptions, wish.device, wish.needs_double);
  description_ = descriptions[index];
  device_ = std::make_unique<Device>(physical[index], DeviceFeatures{.float64 = description_.has_double});
}

void Context::check_validation() const {
  const std::vector<std::string> messages = log_.messages();
  if (!messages.empty()) throw DeviceError("Vulkan validation: " + messages.front());
}

}  // namespace dolp::vulkan
