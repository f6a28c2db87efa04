// What leaves the window as a file.
#pragma once

#include <string>

#include "evaluate/evaluator.hpp"
#include "explore/curve.hpp"
#include "scene/scene.hpp"

namespace dolp::explore {

/// A curve with the columns of `dolp eval`: theta_deg, sigma, q, then the results.
std::string curve_csv(const Curve& curve);

/// Computes the table of the scene's grid and writes it as `dolp table` does. Returns what to tell the user.
/// Errors: those of check_output_path, write_table and the evaluator; Cancelled when `progress` returns false. Nothing
/// is written then.
std::string export_table(const Scene& scene, const std::string& path, const std::string& command_line,
                         MomentsEvaluator& evaluator, const Progress& progress);

/// Compares every tenth entry of a finished curve with the independent reference, everything kept. Returns the largest
/// error of DOLP beside its bound, in words.
/// Errors: Cancelled when `progress` returns false.
std::string true_error(const Curve& curve, const Progress& progress);

}  // namespace dolp::explore
