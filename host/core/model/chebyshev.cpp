#include "model/chebyshev.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace dolp {

std::vector<double> lobatto_points(Eigen::Index count) {
  std::vector<double> points(static_cast<std::size_t>(count));
  const double last = static_cast<double>(count - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // With the sine instead of the cosine, the points are symmetric about 0 to the last bit.
    points[i] = std::sin(0.5 * std::numbers::pi * (last - 2.0 * static_cast<double>(i)) / last);
  }
  return points;
}

Eigen::RowVectorXd cardinal_values(const std::vector<double>& points, double x) {
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::RowVectorXd values = Eigen::RowVectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double distance = x - points[static_cast<std::size_t>(i)];
    if (distance == 0.0) {
      values.setZero();
      values[i] = 1.0;
      return values;
    }
    const double weight = (i == 0 || i == count - 1) ? 0.5 : 1.0;
    values[i] = ((i % 2 == 0) ? weight : -weight) / distance;
  }
  return values / values.sum();
}

Eigen::MatrixXd chebyshev_coefficients(Eigen::Index count) {
  const auto last = static_cast<double>(count - 1);
  Eigen::MatrixXd coefficients(count, count);
  for (Eigen::Index degree = 0; degree < count; ++degree) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const double halves = (i == 0 || i == count - 1 ? 0.5 : 1.0) * (degree == 0 || degree == count - 1 ? 0.5 : 1.0);
      coefficients(degree, i) =
          2.0 / last * halves * std::cos(std::numbers::pi * static_cast<double>(degree * i) / last);
    }
  }
  return coefficients;
}

}  // namespace dolp
