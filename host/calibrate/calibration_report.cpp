#include "calibrate/calibration_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plan/rule.hpp"
#include "scene/names.hpp"

namespace dolp {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kHeader =
    "tolerance masking  slopes   points  evaluations     error / tolerance    factor of doubts  of deficit's      "
    "estimate  share   under-\n"
    "                                    median   95 %  median   98 %  worst    98 %  worst     98 %  worst       "
    "/ error  missed  stated\n";

/// JSON has no infinity and no NaN.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string group_line(const GroupCalibration& g) {
  return fmt::format(
      "{:<9.0e} {:<8} {:<8} {:>6}  {:>6.0f} {:>6.0f}  {:>6.1g} {:>6.1g} {:>6.1g}  {:>6.2g} {:>6.2g}   "
      "{:>6.2g} {:>6.2g}     {:>8.2g}  {:>6.4f}  {:>6}\n",
      g.tolerance, name_of(g.masking), name_of(g.distribution), g.points.size(), g.evaluations.median,
      g.evaluations.q95, g.error_over_tolerance.median, g.error_over_tolerance.q98, g.error_over_tolerance.worst,
      g.factor.q98, g.factor.worst, g.deficit_factor.q98, g.deficit_factor.worst, g.estimate_to_error, g.missed_share,
      g.understated);
}

std::string point_line(const StoredCase& stored, const PointCalibration& p, double tolerance) {
  return fmt::format(
      "    factor {:.2g} deficit {:.2g}  error/tol {:.2g} estimate/tol {:.2g}  evaluations {:.0f}{}  theta {:.9g} "
      "sigma "
      "{:.5g} q {:.6g} n {:.6g} k {:.6g}  {}\n",
      p.factor, p.deficit_factor, p.error / tolerance, p.estimate / tolerance, p.evaluations,
      p.is_understated ? "  UNDERSTATED" : "", stored.theta_deg, stored.shape.sigma, stored.shape.q, stored.index.n,
      stored.index.k, stored.name);
}

Json spread_json(const Spread& spread) {
  return {{"median", number(spread.median)},
          {"q95", number(spread.q95)},
          {"q98", number(spread.q98)},
          {"worst", number(spread.worst)}};
}

Json point_json(const StoredCase& stored, const PointCalibration& p) {
  return {{"case", stored.name},
          {"theta_deg", stored.theta_deg},
          {"sigma", stored.shape.sigma},
          {"q", stored.shape.q},
          {"n", stored.index.n},
          {"k", stored.index.k},
          {"evaluations", p.evaluations},
          {"error", number(p.error)},
          {"estimate", number(p.estimate)},
          {"factor", number(p.factor)},
          {"deficit_factor", number(p.deficit_factor)},
          {"understated", p.is_understated}};
}

Json group_json(const CalibrationReport& report, const GroupCalibration& g) {
  Json worst = Json::array();
  for (std::size_t i = 0; i < std::min(report.worst, g.points.size()); ++i) {
    worst.push_back(point_json(report.cases[g.points[i].position], g.points[i]));
  }
  return {{"tolerance", g.tolerance},
          {"masking", name_of(g.masking)},
          {"distribution", name_of(g.distribution)},
          {"points", g.points.size()},
          {"evaluations", spread_json(g.evaluations)},
          {"error_over_tolerance", spread_json(g.error_over_tolerance)},
          {"needed_factor", spread_json(g.factor)},
          {"needed_deficit_factor", spread_json(g.deficit_factor)},
          {"estimate_to_error", number(g.estimate_to_error)},
          {"missed_share", g.missed_share},
          {"understated", g.understated},
          {"worst_points", worst}};
}

}  // namespace

std::string calibration_text(const CalibrationReport& report) {
  std::string text = fmt::format("{} reference points, {}\n{}", report.cases.size(), report.precision, kHeader);
  for (const GroupCalibration& group : report.groups) {
    text += group_line(group);
    for (std::size_t i = 0; i < std::min(report.worst, group.points.size()); ++i) {
      text += point_line(report.cases[group.points[i].position], group.points[i], group.tolerance);
    }
  }
  return text;
}

Json calibration_json(const CalibrationReport& report) {
  Json groups = Json::array();
  for (const GroupCalibration& group : report.groups) groups.push_back(group_json(report, group));
  return {{"precision", report.precision}, {"cases", report.cases.size()}, {"groups", groups}};
}

}  // namespace dolp
