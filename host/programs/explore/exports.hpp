// Export of tables from the window, and comparison of a curve with the independent reference.
#pragma once

#include <string>

#include "explore/curve.hpp"

namespace dolp::explore {

/// Computes the table of the scene's grid and writes it as `dolp table` does. Returns what to tell the user.
/// Errors: those of Evaluator::write_table.
std::string export_table(const Scene& scene, const std::string& path, const std::string& command_line,
                         Evaluator& evaluator, const Progress& progress);

/// Compares every tenth point of a finished curve with the independent reference, everything kept. Returns the largest
/// error of DOLP beside its bound, in words.
/// Errors: Cancelled when `progress` returns false.
std::string true_error(const Curve& curve, const Progress& progress);

}  // namespace dolp::explore
