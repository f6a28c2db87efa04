#include "calibrate/calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "base/parallel_ranges.hpp"
#include "evaluate/cpu/text.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFloatRoundoff = 0x1p-24;
constexpr double kDoubleRoundoff = 0x1p-53;

/// What the kernel's sums are bound by beside the doubts of their rules: cut, rounding, tables.
struct BoundsWithoutRules {
  double reflected = 0.0;
  double deficit = 0.0;
};

BoundsWithoutRules bounds_without_rules(kernel::MomentsNode node, const KernelData& data, const MomentsEntry& entry,
                                        double unit_roundoff) {
  BoundsWithoutRules bounds;
  node.deficit_doubt = 0.0;
  node.doubt = 0.0;
  // The bound of r_q is always its own; those of r_i and the deficit may come from each other.
  bounds.reflected = moments_from_kernel(node, data, entry, unit_roundoff).r_q_error;
  // With nothing known of r_i the bound of the deficit is its own.
  node.doubt = kInfinity;
  bounds.deficit = moments_from_kernel(node, data, entry, unit_roundoff).deficit_error;
  return bounds;
}

/// What the bounds of r_q and of the deficit gain from the doubts as they are.
BoundsWithoutRules rule_shares(const kernel::MomentsNode& node, const KernelData& data, const MomentsEntry& entry,
                               double unit_roundoff, const BoundsWithoutRules& rest) {
  kernel::MomentsNode own = node;
  BoundsWithoutRules shares;
  shares.reflected = moments_from_kernel(own, data, entry, unit_roundoff).r_q_error - rest.reflected;
  own.doubt = kInfinity;
  shares.deficit = moments_from_kernel(own, data, entry, unit_roundoff).deficit_error - rest.deficit;
  return shares;
}

/// An error less what the reference may err itself.
double excess(double value, double reference, double reference_error) {
  return std::max(0.0, std::abs(value - reference) - reference_error);
}

double needed_factor(double error, double bound_without_rules, double rule_share) {
  if (error <= bound_without_rules) return 0.0;
  return rule_share > 0.0 ? (error - bound_without_rules) / rule_share : kInfinity;
}

bool is_understated(const Moments& m, const Moments& reference) {
  return !(excess(m.r_i, reference.r_i, reference.r_i_error) <= m.r_i_error &&
           excess(m.r_q, reference.r_q, reference.r_q_error) <= m.r_q_error &&
           excess(m.albedo, reference.albedo, reference.albedo_error) <= m.albedo_error &&
           excess(m.deficit, reference.deficit, reference.deficit_error) <= m.deficit_error);
}

PointCalibration point_calibration(const kernel::MomentsNode& node, const KernelData& data, const MomentsEntry& entry,
                                   double unit_roundoff, const Moments& reference) {
  const Moments stated = moments_from_kernel(node, data, entry, unit_roundoff);
  const BoundsWithoutRules bounds = bounds_without_rules(node, data, entry, unit_roundoff);
  const double error_q = excess(node.r_q, reference.r_q, reference.r_q_error);
  const double summed = std::max(excess(node.r_i, reference.r_i, reference.r_i_error), error_q);
  const double given = std::max(excess(stated.r_i, reference.r_i, reference.r_i_error), error_q);
  const double deficit = excess(node.deficit, reference.deficit, reference.deficit_error);
  const double estimate = std::max(stated.r_i_error, stated.r_q_error);
  PointCalibration point;
  point.evaluations = node.evaluations;
  point.error = summed / reference.r_i;
  point.estimate = estimate / reference.r_i;
  const BoundsWithoutRules shares = rule_shares(node, data, entry, unit_roundoff, bounds);
  point.factor = needed_factor(summed, bounds.reflected, shares.reflected);
  point.deficit_factor = needed_factor(deficit, bounds.deficit, shares.deficit);
  point.estimate_to_error = given > 0.0 ? estimate / given : kInfinity;
  point.is_understated = is_understated(stated, reference);
  return point;
}

MomentsRequest request_of(const std::vector<StoredCase>& cases, const std::vector<std::size_t>& positions,
                          double tolerance) {
  MomentsRequest request;
  request.distribution = cases[positions.front()].distribution;
  request.masking = cases[positions.front()].masking;
  request.tolerance = tolerance;
  for (const std::size_t position : positions) {
    const auto number = static_cast<std::uint32_t>(request.entries.size());
    request.theta_deg.push_back(cases[position].theta_deg);
    request.shapes.push_back(cases[position].shape);
    request.indices.push_back(cases[position].index);
    request.entries.push_back({number, number, number});
  }
  return request;
}

std::vector<PointCalibration> calibrate_points(const std::vector<StoredCase>& cases,
                                               const std::vector<std::size_t>& positions, double tolerance,
                                               bool in_double) {
  const KernelData data = kernel_data(request_of(cases, positions, tolerance));
  const std::unique_ptr<KernelText> text = in_double ? make_kernel_text_double(data) : make_kernel_text_float(data);
  const double unit_roundoff = in_double ? kDoubleRoundoff : kFloatRoundoff;
  std::vector<PointCalibration> points(positions.size());
  const auto one = [&](std::size_t i) {
    if (data.needs_masking_table()) text->build_masking_table(i);
    const MomentsEntry& entry = data.entries[i];
    points[i] = point_calibration(text->moments(entry), data, entry, unit_roundoff, cases[positions[i]].moments);
    points[i].position = positions[i];
  };
  parallel_for(points.size(), one, nullptr);
  return points;
}

/// One number of every point.
template <class Value>
std::vector<double> values_of(const std::vector<PointCalibration>& points, Value value) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const PointCalibration& point : points) values.push_back(value(point));
  return values;
}

GroupCalibration summarised(std::vector<PointCalibration> points, double tolerance) {
  GroupCalibration group;
  group.tolerance = tolerance;
  group.evaluations = spread_of(values_of(points, [](const auto& p) { return p.evaluations; }));
  group.error_over_tolerance = spread_of(values_of(points, [&](const auto& p) { return p.error / tolerance; }));
  group.factor = spread_of(values_of(points, [](const auto& p) { return p.factor; }));
  group.deficit_factor = spread_of(values_of(points, [](const auto& p) { return p.deficit_factor; }));
  group.estimate_to_error = spread_of(values_of(points, [](const auto& p) { return p.estimate_to_error; })).median;
  const auto missed = std::ranges::count_if(points, [&](const auto& p) { return !(p.estimate <= tolerance); });
  group.missed_share = static_cast<double>(missed) / static_cast<double>(points.size());
  group.understated =
      static_cast<std::size_t>(std::ranges::count_if(points, [](const auto& p) { return p.is_understated; }));
  std::ranges::stable_sort(points, [](const auto& a, const auto& b) {
    return std::max(a.factor, a.deficit_factor) > std::max(b.factor, b.deficit_factor);
  });
  group.points = std::move(points);
  return group;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  for (double& value : values) {
    if (std::isnan(value)) value = kInfinity;
  }
  std::ranges::sort(values);
  const auto quantile = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
    return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
  };
  return {quantile(0.5), quantile(0.95), quantile(0.98), values.back()};
}

bool is_calibration_case(const StoredCase& stored) { return stored.shape.sigma > 0.0 && stored.moments.r_i > 0.0; }

std::vector<GroupCalibration> calibrate(const std::vector<StoredCase>& cases, double tolerance, bool in_double) {
  std::map<std::pair<Masking, Distribution>, std::vector<std::size_t>> positions;
  for (std::size_t i = 0; i < cases.size(); ++i) positions[{cases[i].masking, cases[i].distribution}].push_back(i);
  std::vector<GroupCalibration> groups;
  for (const auto& [model, own] : positions) {
    groups.push_back(summarised(calibrate_points(cases, own, tolerance, in_double), tolerance));
    groups.back().masking = model.first;
    groups.back().distribution = model.second;
  }
  return groups;
}

}  // namespace dolp
