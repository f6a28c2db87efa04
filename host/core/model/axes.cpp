#include "model/axes.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

namespace dolp {

Axes axes_of(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q,
             std::vector<double> wavelength_um, std::vector<double> n, std::vector<double> k) {
  Axes axes;
  axes[Axis::kWavelength] = std::move(wavelength_um);
  axes[Axis::kN] = std::move(n);
  axes[Axis::kK] = std::move(k);
  axes[Axis::kTheta] = std::move(theta_deg);
  axes[Axis::kSigma] = std::move(sigma);
  axes[Axis::kQ] = std::move(q);
  return axes;
}

Axes part_of(const Axes& axes, const PerAxis& first, const PerAxis& count) {
  Axes part;
  for (const Axis axis : kAllAxes) {
    const auto begin = axes[axis].begin() + static_cast<std::ptrdiff_t>(first[axis]);
    if (!axes[axis].empty()) part[axis] = {begin, begin + static_cast<std::ptrdiff_t>(count[axis])};
  }
  return part;
}

PerAxis place_of(std::size_t position, const PerAxis& counts) {
  PerAxis place = {};
  for (std::size_t i = kAxisCount; i-- > 0 && position > 0; position /= counts[i]) place[i] = position % counts[i];
  return place;
}

PerAxis counts_of(const Axes& axes) {
  PerAxis counts;
  std::ranges::transform(axes, counts.begin(),
                         [](const auto& values) { return std::max<std::size_t>(values.size(), 1); });
  return counts;
}

std::size_t size_of(const PerAxis& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{1}, std::multiplies<>());
}

}  // namespace dolp
