#pragma once

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace dolp::reference {

template <std::size_t N>
using Values = std::array<double, N>;

template <std::size_t N>
struct Integral {
  Values<N> value{};
  Values<N> error{};
};

struct Goal {
  double relative = 1e-9;        ///< allowed error of an integral, divided by a scale such as the integral itself
  std::size_t max_panels = 400;  ///< at this number of panels the quadrature stops and returns the error reached
  int subdivisions = 1;          ///< initial number of panels between two neighbouring break points
};

/// The ends of the first panels: both ends of the interval, and all break points between them.
class Breaks {
 public:
  Breaks(double low, double high) : points_{low, high} {}
  void add(double point) {
    if (point > points_[0] && point < points_[1]) points_.push_back(point);
  }
  std::vector<double> sorted() const {
    std::vector<double> points = points_;
    std::sort(points.begin(), points.end());
    return points;
  }

 private:
  std::vector<double> points_;
};

/// 21-point Kronrod rule. The error is pessimistic: the difference from the 10-point Gauss rule, plus rounding.
template <std::size_t N, class Integrand>
Integral<N> kronrod_panel(const Integrand& integrand, double low, double high) {
  using Kronrod = boost::math::quadrature::gauss_kronrod<double, 21>;
  static const auto nodes = Kronrod::abscissa();
  static const auto kronrod_weights = Kronrod::weights();
  static const auto gauss_weights = boost::math::quadrature::gauss<double, 10>::weights();
  const double centre = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  std::array<Values<N>, 21> samples;
  samples[0] = integrand(centre);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    samples[2 * i - 1] = integrand(centre - half * nodes[i]);
    samples[2 * i] = integrand(centre + half * nodes[i]);
  }
  Integral<N> result;
  for (std::size_t k = 0; k < N; ++k) {
    double kronrod = kronrod_weights[0] * samples[0][k];
    double gauss = 0.0;
    double magnitude = kronrod_weights[0] * std::abs(samples[0][k]);
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const double pair = samples[2 * i - 1][k] + samples[2 * i][k];
      kronrod += kronrod_weights[i] * pair;
      if (i % 2 == 1) gauss += gauss_weights[i / 2] * pair;
      magnitude += kronrod_weights[i] * (std::abs(samples[2 * i - 1][k]) + std::abs(samples[2 * i][k]));
    }
    result.value[k] = half * kronrod;
    result.error[k] = half * (std::abs(kronrod - gauss) + 4.0 * std::numeric_limits<double>::epsilon() * magnitude);
  }
  return result;
}

/// Maps s in [0, 1] to an interval. An integrand with a square root or a 3/2 power at an end becomes smooth in s.
struct SmoothMap {
  double low;
  double high;
  double at(double s) const {
    const double r = 1.0 - s;
    return s < 0.5 ? low + (high - low) * s * s * (3.0 - 2.0 * s) : high - (high - low) * r * r * (1.0 + 2.0 * s);
  }
  double derivative(double s) const { return 6.0 * (high - low) * s * (1.0 - s); }
};

/// The part of a SmoothMap from s = `low` to s = `high`, and its integral.
template <std::size_t N>
struct Panel {
  SmoothMap map;
  double low;
  double high;
  Integral<N> integral;
};

template <std::size_t N, class Integrand>
Panel<N> make_panel(const Integrand& integrand, const SmoothMap& map, double low, double high) {
  const auto in_s = [&](double s) {
    Values<N> values = integrand(map.at(s));
    for (double& value : values) value *= map.derivative(s);
    return values;
  };
  return {map, low, high, kronrod_panel<N>(in_s, low, high)};
}

template <std::size_t N>
Integral<N> sum_panels(const std::vector<Panel<N>>& panels) {
  Integral<N> total;
  for (const Panel<N>& panel : panels) {
    for (std::size_t k = 0; k < N; ++k) {
      total.value[k] += panel.integral.value[k];
      total.error[k] += panel.integral.error[k];
    }
  }
  return total;
}

/// The largest of the errors, each divided by its scale. A component with an infinite scale does not count.
template <std::size_t N>
double scaled_error(const Values<N>& error, const Values<N>& scale) {
  double worst = 0.0;
  for (std::size_t k = 0; k < N; ++k) {
    if (error[k] > 0.0) worst = std::max(worst, error[k] / scale[k]);
  }
  return worst;
}

/// Halves the worst panel until every error is at most goal.relative times its scale, or there are max_panels panels.
template <std::size_t N, class Integrand, class Scale>
Integral<N> integrate(const Integrand& integrand, const Breaks& breaks, const Goal& goal, const Scale& scale) {
  const std::vector<double> points = breaks.sorted();
  std::vector<Panel<N>> panels;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const SmoothMap map{points[i], points[i + 1]};
    for (int j = 0; j < goal.subdivisions; ++j) {
      const double low = static_cast<double>(j) / goal.subdivisions;
      const double high = static_cast<double>(j + 1) / goal.subdivisions;
      panels.push_back(make_panel<N>(integrand, map, low, high));
    }
  }
  while (panels.size() < goal.max_panels) {
    const Integral<N> total = sum_panels(panels);
    const Values<N> scales = scale(total.value);
    if (scaled_error(total.error, scales) <= goal.relative) break;
    const auto worst = std::max_element(panels.begin(), panels.end(), [&](const Panel<N>& a, const Panel<N>& b) {
      return scaled_error(a.integral.error, scales) < scaled_error(b.integral.error, scales);
    });
    const Panel<N> whole = *worst;
    const double middle = 0.5 * (whole.low + whole.high);
    if (middle <= whole.low || middle >= whole.high) break;
    *worst = make_panel<N>(integrand, whole.map, whole.low, middle);
    panels.push_back(make_panel<N>(integrand, whole.map, middle, whole.high));
  }
  return sum_panels(panels);
}

}  // namespace dolp::reference
