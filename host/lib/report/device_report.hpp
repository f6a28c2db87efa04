// Report on the Vulkan devices.
#pragma once

#include "device/devices.hpp"
#include "report/report.hpp"

namespace dolp {

/// Adds the limits of the devices, and the accuracy of each on a few ordinary cases in float and double.
ReportBuilder device_report(const DeviceList& list);

}  // namespace dolp
