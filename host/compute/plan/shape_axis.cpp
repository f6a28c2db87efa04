#include "plan/shape_axis.hpp"
#include "model/choices.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/chebyshev.hpp"
#include "plan/constants.hpp"

namespace dolp {
namespace {

constexpr double kGrazing_deg = 89.9;

bool is_grazing(double theta_deg) { return theta_deg > kGrazing_deg; }

double nodes_needed(const ShapeParameter& parameter, double half_length, double digits) {
  const double per_digit = std::log(10.0) / std::asinh(parameter.strip / half_length);
  return std::max(std::ceil(kFirstShapeNodes + digits * per_digit), kLeastShapeNodes);
}

ShapeAxis without_interpolation(const std::vector<double>& values) {
  const auto count = static_cast<Eigen::Index>(values.size());
  return {values, Eigen::MatrixXd::Identity(count, count), {}};
}

}  // namespace

ShapeParameter sigma_parameter(Distribution distribution) {
  return {0.0, distribution == Distribution::kGaussian ? 0.78 : 1.15};
}

ShapeParameter q_parameter(const MomentsRequest& request) {
  const bool needs_mean_slope =
      request.masking == Masking::kSmith ||
      (!keeps_projected_area(request.masking) && std::ranges::all_of(request.theta_deg, is_grazing));
  const bool has_mean_slope = request.distribution == Distribution::kCauchy && std::ranges::min(request.q) > 1.5;
  return {needs_mean_slope && has_mean_slope ? 1.5 : 1.0, 1.45};
}

std::vector<std::vector<std::size_t>> split_grazing_directions(const MomentsRequest& request) {
  std::vector<std::vector<std::size_t>> groups(2);
  for (std::size_t i = 0; i < request.theta_deg.size(); ++i) {
    const bool is_apart = !keeps_projected_area(request.masking) && is_grazing(request.theta_deg[i]);
    groups[is_apart ? 1 : 0].push_back(i);
  }
  std::erase_if(groups, [](const std::vector<std::size_t>& group) { return group.empty(); });
  return groups;
}

ShapeAxis shape_axis(const ShapeParameter& parameter, const std::vector<double>& values, double digits) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  const double start = std::log(*least - parameter.origin);
  const double end = std::log(*largest - parameter.origin);
  const double half_length = 0.5 * (end - start);
  if (half_length <= 0.0) return without_interpolation(values);
  const double count = nodes_needed(parameter, half_length, digits);
  if (!(count * kLeastAxisGain <= static_cast<double>(values.size()))) return without_interpolation(values);

  ShapeAxis axis;
  const auto nodes = static_cast<Eigen::Index>(count);
  const std::vector<double> points = lobatto_points(nodes);
  for (const double point : points) {
    axis.nodes.push_back(parameter.origin + std::exp(0.5 * (start + end) + half_length * point));
  }
  axis.nodes.front() = *largest;
  axis.nodes.back() = *least;
  axis.cardinal.resize(static_cast<Eigen::Index>(values.size()), nodes);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = (std::log(values[i] - parameter.origin) - 0.5 * (start + end)) / half_length;
    axis.cardinal.row(static_cast<Eigen::Index>(i)) = cardinal_values(points, std::clamp(x, -1.0, 1.0));
  }
  axis.coefficients = chebyshev_coefficients(nodes);
  return axis;
}

}  // namespace dolp
