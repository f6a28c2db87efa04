#pragma once

#include <dolp/options.hpp>
#include <functional>
#include <span>
#include <vector>

#include "model/evaluator.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

/// The layout of the response table over the scene's grid. Errors: InputError if the scene has no response table.
TableLayout response_layout(const SceneValues& scene);

/// Weights of a response table for the entries of a request, in the order of a table.
struct EntryResponses {
  ResponseArray<std::vector<double>> responses;
  std::vector<double> albedo;
};

/// Computes the weights and their error bounds. Weights are NaN where rho has no value. Entries whose response_error
/// exceeds the tolerance times the albedo are computed again with finer quadrature.
EntryResponses compute_responses(MomentsRequest request, const Accuracy& accuracy, ModelEvaluator& evaluator,
                                 const Progress& progress);

/// A request for responses without entries. Its entries need an index, whose moments are not used.
MomentsRequest response_request(const Surface& surface);
inline constexpr OpticalConstants kUnusedIndex{1.5, 0.0};

/// Sum over m of 2^-m |D_m|, where D_m is the sum over the angles beta_j of T_m(x_j) f_j (a_j - b_j). T_m is a
/// Chebyshev polynomial, and x_j is its variable at beta_j. f_j is sin^2(beta_j) for weights of Q (`is_of_q`), and 1
/// for weights of I. If the weights b are exact, the sum is at most response_error of the weights a.
double response_distance(std::span<const double> a, std::span<const double> b, bool is_of_q);

struct ResponseOutcome {
  EvaluationReport evaluation;
  std::size_t entries = 0;
  std::size_t missed = 0;    ///< entries whose response_error exceeds the tolerance times the albedo
  double worst_error = 0.0;  ///< largest ratio of response_error to albedo
  double wall_s = 0.0;
  std::vector<Attribute> attributes = {};  ///< attributes of the table that are known after the run
};

/// Receives a part of the table, and the position of its first value on each axis.
using TakePart = std::function<void(TableValues part, const PerAxis& first)>;
/// Computes a response table, a few directions at a time, and passes each part to `take`.
ResponseOutcome run_responses(const SceneValues& scene, const TableLayout& layout, const RunOptions& options,
                              ModelEvaluator& evaluator, const TakePart& take);

}  // namespace dolp
