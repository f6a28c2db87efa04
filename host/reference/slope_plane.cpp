#include "reference/slope_plane.hpp"

namespace dolp::reference {

using std::numbers::pi;

namespace {

constexpr int kBisections = 60;
constexpr int kMostSteps = 150;
constexpr int kPlainSteps = 12;
constexpr std::size_t kMostBends = 40;  // if there are more bends, each is tiny, and chi_breaks() ignores them
// t_breaks() computes the regime at kStepsPerDecade slopes t per decade. It adds slopes at which 1 / gamma rises from 1
// to kMostInverse in steps of kStepInverse. gamma is the half-angle of the groove, t = cot(gamma).
constexpr double kStepInverse = 0.04;
constexpr double kMostInverse = 10.0;
constexpr int kStepsPerDecade = 16;
constexpr double kSmallestShare = 1e-7;  // smallest scanned slope, relative to the width of the distribution
// For grazing views the integrand varies quickly where chi or t is below about cot(theta). Break points are added at
// cot(theta) and at its products with powers of kPlaneLayerGrowth, up to kThinLayer for chi, kThinLayer * width for t.
constexpr double kThinLayer = 0.05;
constexpr double kPlaneLayerGrowth = 8.0;

// Finds the positions between the ascending `points` at which `regime` changes, by bisection to the last bits.
std::vector<double> changes(const std::vector<double>& points, const std::function<std::uint64_t(double)>& regime) {
  std::vector<double> found;
  std::uint64_t below = regime(points.front());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const std::uint64_t above = regime(points[i + 1]);
    double start = points[i];
    while (below != above) {
      double low = start;
      double high = points[i + 1];
      std::uint64_t at_high = above;
      for (int j = 0; j < kBisections; ++j) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        const std::uint64_t at_middle = regime(middle);
        if (at_middle == below) {
          low = middle;
        } else {
          high = middle;
          at_high = at_middle;
        }
      }
      found.push_back(high);
      start = high;
      below = at_high;
      if (high >= points[i + 1]) break;
    }
    below = above;
  }
  return found;
}

}  // namespace

std::vector<double> RegimeScan::chi_breaks(double t) const {
  std::vector<double> layers{0.5 * pi - steps_.ridge_rad};
  const double layer = view_.cos / std::max(view_.sin, 1e-300);
  for (double x = layer; x < kThinLayer; x *= kPlaneLayerGrowth) layers.push_back(std::asin(x));
  const double gamma = std::atan2(1.0, t);
  const double exact_steps = steps_.per_gamma * theta_rad_ / gamma;
  if (exact_steps > kMostSteps) return layers;
  const int steps = static_cast<int>(exact_steps) + 1;
  std::vector<double> points;
  for (int i = 0; i <= kPlainSteps; ++i) points.push_back(0.5 * pi * i / kPlainSteps);
  // Equal steps of psi, the zenith of the projected view (ScanSteps): tan(psi) = tan(theta) sin(chi).
  for (int i = 1; i < steps; ++i) {
    const double psi = theta_rad_ * i / steps;
    points.push_back(std::asin(std::min(1.0, std::tan(psi) * layer)));
  }
  double half = 0.5 * pi / kPlainSteps;
  for (int i = 0; i < steps_.halvings; ++i) points.push_back(half *= 0.5);
  std::sort(points.begin(), points.end());
  std::vector<double> found = changes(points, [&](double chi) { return regime_(slope_point(t, chi)); });
  if (found.size() > kMostBends) found.clear();
  found.insert(found.end(), layers.begin(), layers.end());
  return found;
}

std::vector<double> RegimeScan::t_breaks(double width, double end) const {
  std::vector<double> points;
  const double decade = std::pow(10.0, 1.0 / kStepsPerDecade);
  for (double t = kSmallestShare * std::min(width, 1.0); t < end; t *= decade) points.push_back(t);
  for (double inverse = 1.0; inverse < kMostInverse; inverse += kStepInverse) {
    const double t = std::tan(0.5 * pi - 1.0 / inverse);
    if (t < end) points.push_back(t);
  }
  points.push_back(end);
  std::sort(points.begin(), points.end());
  std::vector<double> found;
  for (const double chi : {0.0, 0.5 * pi}) {
    const std::vector<double> more = changes(points, [&](double t) { return regime_(slope_point(t, chi)); });
    found.insert(found.end(), more.begin(), more.end());
  }
  const double layer = view_.cos / std::max(view_.sin, 1e-300);
  for (double t = std::max(layer, points.front()); t < kThinLayer * width; t *= kPlaneLayerGrowth) found.push_back(t);
  return found;
}

}  // namespace dolp::reference
