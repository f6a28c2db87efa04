// Response tables: the weights with which facets of each local angle of incidence enter the moments of a surface,
// whatever its material (include/dolp/response.hpp).
#pragma once

#include <dolp/options.hpp>
#include <functional>
#include <span>
#include <vector>

#include "model/evaluator.hpp"
#include "scene/scene.hpp"
#include "table/table.hpp"

namespace dolp {

/// The response table over the scene's grid before anything is computed. Errors: InputError for a scene that has none.
TableLayout response_layout(const SceneValues& scene);

/// Shape: as in a table with the request's entries.
struct EntryResponses {
  ResponseArray<std::vector<double>> responses;
  std::vector<double> albedo;
};

/// Weights and bounds of the entries of a request; NaN where rho has no value. Only the surface, layout, directions and
/// shapes of the request count. Entries whose response_error exceeds the tolerance times the albedo are computed again,
/// with finer rules.
///
/// Equation: w_j = (2 / K) (C_0 / 2 + sum over 0 < m < K of C_m T_m(x_j)) / cos(theta), C_m the moments with Chebyshev
///   polynomials T_m(x), x = 2 asinh(cos(beta) / c0) / asinh(1 / c0) - 1, instead of reflectances, x_j the zeros of
///   T_K, K = 24, c0 = 0.01.
/// Accuracy: tests Responses_*.
EntryResponses responses_of(MomentsRequest request, const Accuracy& accuracy, ModelEvaluator& evaluator,
                            const Progress& progress);

/// A request for the responses of a surface, without directions and shapes.
MomentsRequest response_request(const Surface& surface);

/// Distance of two weights response_i, or response_q, of an entry, as response_error bounds it: the sum over m of 2^-m
/// |C_m - C'_m|, C_m = sum over j of T_m(x_j) w_j.
double response_distance(std::span<const double> a, std::span<const double> b, bool is_of_q);

/// Outcome of a run.
struct ResponseOutcome {
  EvaluationReport evaluation;
  std::size_t entries = 0;
  std::size_t missed = 0;    ///< entries whose response_error exceeds the tolerance times the albedo
  double worst_error = 0.0;  ///< largest response_error over the albedo
  double wall_s = 0.0;
  std::vector<Attribute> attributes = {};  ///< attributes of the table that are known after the run
};

/// Computes a response table part by part, some directions at a time.
using TakePart = std::function<void(TableValues part, const PerAxis& first)>;
ResponseOutcome run_responses(const SceneValues& scene, const TableLayout& layout, const RunOptions& options,
                              ModelEvaluator& evaluator, const TakePart& take);

}  // namespace dolp
