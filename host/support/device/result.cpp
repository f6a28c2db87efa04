#include "device/result.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace dolp::vulkan {
namespace {

std::atomic<bool> is_busy{false};

}  // namespace

DeviceTimeout::DeviceTimeout(const std::string& message) : DeviceError(message) { is_busy = true; }

bool driver_is_busy() { return is_busy; }

std::string result_name(VkResult result) {
#define DOLP_NAMED(code) std::pair(code, #code)
  constexpr std::array kNames = {DOLP_NAMED(VK_SUCCESS),
                                 DOLP_NAMED(VK_TIMEOUT),
                                 DOLP_NAMED(VK_INCOMPLETE),
                                 DOLP_NAMED(VK_ERROR_OUT_OF_HOST_MEMORY),
                                 DOLP_NAMED(VK_ERROR_OUT_OF_DEVICE_MEMORY),
                                 DOLP_NAMED(VK_ERROR_INITIALIZATION_FAILED),
                                 DOLP_NAMED(VK_ERROR_DEVICE_LOST),
                                 DOLP_NAMED(VK_ERROR_MEMORY_MAP_FAILED),
                                 DOLP_NAMED(VK_ERROR_LAYER_NOT_PRESENT),
                                 DOLP_NAMED(VK_ERROR_EXTENSION_NOT_PRESENT),
                                 DOLP_NAMED(VK_ERROR_FEATURE_NOT_PRESENT),
                                 DOLP_NAMED(VK_ERROR_INCOMPATIBLE_DRIVER),
                                 DOLP_NAMED(VK_ERROR_TOO_MANY_OBJECTS),
                                 DOLP_NAMED(VK_ERROR_OUT_OF_POOL_MEMORY)};
#undef DOLP_NAMED
  const auto found = std::ranges::find(kNames, result, [](const auto& named) { return named.first; });
  return found != kNames.end() ? found->second : "VkResult " + std::to_string(static_cast<int>(result));
}

bool lacks_addresses() {
  constexpr std::size_t kDriverBytes = 256U << 20U;  // address space that a driver and its compiler need
  void* const room = ::mmap(nullptr, kDriverBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return true;
  ::munmap(room, kDriverBytes);
  return false;
}

bool lacks_threads() {
  // Mesa's CPU driver lavapipe would wait forever if it cannot start two threads per core and three further threads.
  const std::size_t needed = 2 * std::clamp(std::thread::hardware_concurrency(), 1U, 32U) + 3;
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  std::vector<std::jthread> threads;
  try {
    threads.reserve(needed);
    while (threads.size() < needed) threads.emplace_back([ended] { ended.wait(); });
  } catch (const std::system_error&) {
    // the system refused to start a thread
  } catch (...) {
    end.set_value();  // otherwise the threads would wait forever
    throw;
  }
  end.set_value();
  return threads.size() < needed;
}

void check(VkResult result, const std::string& action) {
  if (result == VK_SUCCESS) return;
  if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost("the Vulkan device was lost while " + action);
  // A driver that runs out of address space may return any error.
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY || lacks_addresses()) {
    throw MemoryError("out of memory: Vulkan: " + action + " failed: " + result_name(result));
  }
  throw DeviceError("Vulkan: " + action + " failed: " + result_name(result));
}

}  // namespace dolp::vulkan
