// Report on the Vulkan devices.
#pragma once

#include "device/devices.hpp"
#include "report/report.hpp"

namespace dolp {

/// Their limits, and how well each computes a few ordinary cases in float and double.
ReportBuilder device_report(const DeviceList& list);

}  // namespace dolp
