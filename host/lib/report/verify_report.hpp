#pragma once

#include <dolp/options.hpp>
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

/// The hard cases in one precision.
struct PrecisionCheck {
  EvaluationReport evaluation;
  std::vector<CaseOutcome> outcomes;
};
/// A line for each combination of precision, distribution and masking. A case has a line if it fails, or with
/// DeviceCheckOptions::all. `checks` is not empty. `left_out`: why a precision is missing; empty if none is missing.
ReportBuilder hard_case_report(const std::vector<PrecisionCheck>& checks, const DeviceCheckOptions& options,
                               const std::string& left_out);

ReportBuilder device_report(const DeviceList& list);

}  // namespace dolp
