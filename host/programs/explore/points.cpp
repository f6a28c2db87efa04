#include "explore/points.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

constexpr std::uint32_t kNoDolpPromised = kReflectanceOutsideZeroToOne | kOutsideModelDomain | kIntensityNotPositive;

/// The scene with the grid of a list; axes that the scene's own has beside these keep the scene's value.
Scene with_grid(const Scene& scene, const PointList& list) {
  std::vector<Setting> axes = {{"theta_deg", list.theta_deg}, {"sigma", list.sigma}, {"q", list.q}};
  for (const auto& [axis, of] :
       {std::pair{"wavelength_um", "spectrum.wavelength_um"}, {"n", "surface.n"}, {"k", "surface.k"}}) {
    if (!scene.numbers(std::string("grid.") + axis).empty()) axes.push_back({axis, scene.number(of).value()});
  }
  return scene.with_grid(axes);
}

}  // namespace

std::size_t PointList::size() const { return is_grid ? theta_deg.size() * sigma.size() * q.size() : theta_deg.size(); }

Results evaluate(Evaluator& evaluator, const Scene& scene, const PointList& list, const RunOptions& options) {
  if (!list.is_grid) return evaluator.evaluate(scene, list.columns(), options);
  const Table table = evaluator.table(with_grid(scene, list), options);
  return {{table.results()}, table.results().quantities(), table.stokes_units()};
}

std::vector<Column> PointList::columns() const {
  std::vector<Column> columns = {{"theta_deg", theta_deg}, {"sigma", sigma}, {"q", q}};
  if (!wavelength_um.empty()) columns.push_back({"wavelength_um", wavelength_um});
  return columns;
}

std::vector<Point> points_of(const PointList& list, const Results& results) {
  const std::pair<double Point::*, Quantity> members[] = {{&Point::dolp, Quantity::kDolp},
                                                          {&Point::dolp_low, Quantity::kDolpLow},
                                                          {&Point::dolp_high, Quantity::kDolpHigh},
                                                          {&Point::error_estimate, Quantity::kErrorEstimate},
                                                          {&Point::stokes_i, Quantity::kStokesI},
                                                          {&Point::stokes_q, Quantity::kStokesQ},
                                                          {&Point::rho_i, Quantity::kRhoI},
                                                          {&Point::rho_q, Quantity::kRhoQ},
                                                          {&Point::rho_error_estimate, Quantity::kRhoErrorEstimate},
                                                          {&Point::albedo, Quantity::kAlbedo}};
  std::vector<Point> points(list.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t shapes = list.is_grid ? list.sigma.size() * list.q.size() : 1;
    points[i].theta_deg = list.theta_deg[i / shapes];
    points[i].sigma = list.sigma[list.is_grid ? i / list.q.size() % list.sigma.size() : i];
    points[i].q = list.q[list.is_grid ? i % list.q.size() : i];
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointResult result = results.at(i);
    for (const auto& [member, quantity] : members) points[i].*member = result[quantity];
    points[i].status = result.status;
  }
  return points;
}

bool is_good(const Point& point) { return (point.status & kNoDolpPromised) == 0 && std::isfinite(point.dolp); }

bool has_bracket(const Point& point) { return std::isfinite(point.dolp_low) && std::isfinite(point.dolp_high); }

PointList points_at(const Scene& scene, std::vector<double> theta_deg) {
  const std::size_t count = theta_deg.size();
  const auto all = [&](const char* key) { return std::vector<double>(count, scene.number(key).value()); };
  return {std::move(theta_deg), all("surface.sigma"), all("surface.q")};
}

std::vector<double> zeniths(double from_deg, double to_deg, std::size_t count) {
  std::vector<double> theta_deg(count, from_deg);
  const double last = static_cast<double>(count - 1);
  for (std::size_t i = 1; i < count; ++i) {
    const double done = static_cast<double>(i);
    theta_deg[i] = ((last - done) * from_deg + done * to_deg) / last;
  }
  return theta_deg;
}

}  // namespace dolp::explore
