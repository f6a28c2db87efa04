// Calibrations as text and as JSON.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calibrate/calibration.hpp"

namespace dolp {

struct CalibrationReport {
  std::string precision;          ///< float | double
  std::vector<StoredCase> cases;  ///< what `groups` refers to
  std::vector<GroupCalibration> groups;
  std::size_t worst = 0;  ///< points to list of each group
};

/// A line for each group, and below it its worst points.
std::string calibration_text(const CalibrationReport& report);

/// The same; infinite numbers are null.
nlohmann::ordered_json calibration_json(const CalibrationReport& report);

}  // namespace dolp
