#include "device/context.hpp"

#include <cstdlib>
#include <string_view>

#include "device/result.hpp"

namespace dolp::vulkan {
namespace {

bool wants_validation(ValidationMode mode) {
  if (mode != ValidationMode::kFromEnvironment) return mode == ValidationMode::kOn;
  const char* value = std::getenv("DOLP_VALIDATION");
  return value && std::string_view(value) == "1";
}

}  // namespace

Context::Context(const DeviceSelector& wish, const Presentation* presentation) {
  const std::vector<const char*> extensions =
      presentation ? presentation->instance_extensions : std::vector<const char*>{};
  instance_ = std::make_unique<Instance>(wants_validation(wish.validation) ? &log_ : nullptr, extensions);
  choose(wish, presentation);
  const std::optional<std::uint32_t> window_family =
      presentation ? presenting_family(instance(), physical_, *presentation) : std::nullopt;
  device_ = std::make_unique<Device>(physical_, description_.has_double, window_family);
}

void Context::choose(const DeviceSelector& wish, const Presentation* presentation) {
  const std::vector<VkPhysicalDevice> physical = instance_->physical_devices();
  std::vector<dolp::Device> descriptions;
  for (VkPhysicalDevice device : physical) {
    dolp::Device description = describe(device);
    if (description.usable && presentation && !presenting_family(instance(), device, *presentation)) {
      description.usable = false;
      description.why_not = "cannot show a window on this display";
    }
    descriptions.push_back(description);
  }
  const std::size_t index = choose_device(descriptions, wish.device, wish.needs_double);
  physical_ = physical[index];
  description_ = descriptions[index];
}

void Context::check_validation() const {
  const std::vector<std::string> messages = log_.messages();
  if (!messages.empty()) throw DeviceError("Vulkan validation: " + messages.front());
}

}  // namespace dolp::vulkan
