#pragma once

#include <string>
#include <vector>

#include "device/devices.hpp"
#include "report/report.hpp"
#include "verify/interpolation.hpp"
#include "verify/qualification.hpp"
#include "verify/table_check.hpp"

namespace dolp {

ReportBuilder table_report(const TableCheck& check, const std::string& path, const std::string& title,
                           std::uint64_t seed, double wall_s);

ReportBuilder between_report(const std::vector<InterpolationError>& errors, std::size_t points, const std::string& path,
                             const std::string& title);

struct PrecisionReport {
  EvaluationReport evaluation;
  std::vector<CaseOutcome> outcomes;
  std::size_t failures() const;
};

struct HardCaseReport {
  double tolerance = 0.0;
  std::size_t cases = 0;
  std::vector<PrecisionReport> precisions;
  std::string left_out;  ///< why a precision is missing; empty if none is missing
  std::size_t failures() const;
};
/// A line for each combination of precision, distribution and masking. A case has a line if it fails or `all` is true.
ReportBuilder hard_case_report(const HardCaseReport& cases, bool all);

ReportBuilder device_report(const DeviceList& list);

}  // namespace dolp
