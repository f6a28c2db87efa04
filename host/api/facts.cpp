#include "api/scene_impl.hpp"
#include "api/translated.hpp"
#include "base/version.hpp"
#include "evaluate/vulkan/devices.hpp"
#include "model/status.hpp"
#include "report/plan_report.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"

namespace dolp::api {

std::string version() { return program_version(); }
std::string commit() { return program_commit(); }
std::string citation() { return std::string(embedded_citation_cff()); }

Plan plan(const Scene& scene, const std::string& device, bool keep_all) {
  return translated([&] {
    const Report report = plan_report(plan_of(scene.impl().scene, device, keep_all));
    return Plan{report.text(), report.json_text()};
  });
}

std::vector<Material> materials() {
  std::vector<Material> all;
  for (const dolp::Material& material : built_in_materials()) {
    const Spectrum range = known_range(material);
    all.push_back({material.name, range.min_um, range.max_um, material.source});
  }
  return all;
}

std::vector<StatusBit> status_bits() {
  std::vector<StatusBit> all;
  for (const dolp::StatusBit& bit : dolp::kStatusBits) all.push_back({bit.mask, bit.meaning});
  return all;
}

std::vector<Device> devices() {
  std::vector<Device> all;
  for (const DeviceDescription& device : list_devices().devices) {
    all.push_back({device.name, type_name(device.type), device.driver, device.api_version, device.usable,
                   device.why_not, device.float64, device.heap_bytes});
  }
  return all;
}

}  // namespace dolp::api
