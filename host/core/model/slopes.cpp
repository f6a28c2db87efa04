#include "model/slopes.hpp"

#include <algorithm>
#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

#include "model/angles.hpp"

namespace dolp {
namespace {

constexpr std::size_t kSectorsOfShare = 16;  // sectors for steeper_share(), which needs few digits

constexpr double kLargestExponent = 500.0;  // limit of the exponent in power_law_reach, so that exp does not overflow

double log1p_square(double x) { return x > 1e8 ? 2.0 * std::log(x) : std::log1p(x * x); }

}  // namespace

double slope_width(const SlopeShape& shape) { return std::sqrt(2.0) * shape.sigma; }

bool is_elliptic(const SlopeShape& shape) { return shape.sigma_cross > 0.0 && shape.sigma_cross != shape.sigma; }

double widest_sigma(const SlopeShape& shape) { return std::max(shape.sigma, shape.sigma_cross); }

double narrowest_sigma(const SlopeShape& shape) {
  return is_elliptic(shape) ? std::min(shape.sigma, shape.sigma_cross) : shape.sigma;
}

SlopeShape mean_isotropic(const SlopeShape& shape) {
  return {is_elliptic(shape) ? std::sqrt(shape.sigma * shape.sigma_cross) : shape.sigma, shape.q};
}

SlopeShape in_view_plane(const SlopeShape& shape) {
  if (!is_elliptic(shape)) return {shape.sigma, shape.q};
  const CosSin turn = cos_sin_deg(shape.azimuth_deg);
  return {std::hypot(shape.sigma * turn.cos, shape.sigma_cross * turn.sin), shape.q};
}

double eccentricity(const SlopeShape& shape) {
  return is_elliptic(shape) ? std::abs(shape.sigma - shape.sigma_cross) / (shape.sigma + shape.sigma_cross) : 0.0;
}

std::vector<SlopeSector> slope_sectors(const SlopeShape& shape, std::size_t count) {
  if (!is_elliptic(shape)) return {{.sigma = shape.sigma}};
  std::vector<SlopeSector> sectors;
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = (static_cast<double>(i) + 0.5) * 0.5 * std::numbers::pi / static_cast<double>(count);
    const double sigma = 1.0 / std::hypot(std::cos(azimuth) / shape.sigma, std::sin(azimuth) / shape.sigma_cross);
    const double share = sigma / shape.sigma * (sigma / shape.sigma_cross) / static_cast<double>(count);
    sectors.push_back({sigma, azimuth, share});
  }
  return sectors;
}

double sigma_of_wind(double wind_m_s) { return std::sqrt(0.5 * (0.003 + 0.00512 * wind_m_s)); }

double wind_of_sigma(double sigma) { return (2.0 * sigma * sigma - 0.003) / 0.00512; }

double sigma_along_wind(double wind_m_s) { return std::sqrt(0.00316 * wind_m_s); }

double sigma_in_wind(double wind_m_s, WindModel model) {
  return model == WindModel::kDirectional ? sigma_along_wind(wind_m_s) : sigma_of_wind(wind_m_s);
}

double sigma_across_wind(double sigma_along) {
  return std::sqrt(0.003 + 0.00192 / 0.00316 * sigma_along * sigma_along);
}

SlopeShape CrossSlopes::shape(double sigma, double q) const {
  const bool follows_wind = wind_model == WindModel::kDirectional;
  return {sigma, q, follows_wind ? sigma_across_wind(sigma) : sigma_cross, azimuth_deg};
}

double steeper_share(Distribution distribution, const SlopeShape& shape, double slope) {
  if (shape.sigma == 0.0) return 0.0;
  if (is_elliptic(shape)) {
    double sum = 0.0;
    for (const SlopeSector& sector : slope_sectors(shape, kSectorsOfShare)) {
      sum += sector.share * steeper_share(distribution, {.sigma = sector.sigma, .q = shape.q}, slope);
    }
    return sum;
  }
  const double u = slope / slope_width(shape);
  return distribution == Distribution::kGaussian ? std::exp(-u * u) : std::exp((1.0 - shape.q) * std::log1p(u * u));
}

double log_density(Distribution distribution, const SlopeShape& shape, double slope, double azimuth) {
  if (is_elliptic(shape)) {
    // The isotropic density of the mean width at a scaled slope; both fronts have the factor 1 / (m m_cross).
    const double mean = std::sqrt(shape.sigma * shape.sigma_cross);
    const double from_axis = azimuth - shape.azimuth_deg * std::numbers::pi / 180.0;
    const double scaled =
        slope * std::hypot(std::cos(from_axis) * mean / shape.sigma, std::sin(from_axis) * mean / shape.sigma_cross);
    return log_density(distribution, {mean, shape.q}, scaled, 0.0) + 2.0 * (log1p_square(slope) - log1p_square(scaled));
  }
  const double m = slope_width(shape);
  const double front = 2.0 * log1p_square(slope) - std::log(4.0 * std::numbers::pi) - 2.0 * std::log(m);
  const double u = slope / m;
  if (distribution == Distribution::kGaussian) return front - u * u;
  return front + std::log(shape.q - 1.0) - shape.q * log1p_square(u);
}

double power_law_reach(double share, double exponent) {
  return std::sqrt(std::expm1(std::min(-std::log(share) / exponent, kLargestExponent)));
}

double gamma_ratio(double x) {
  // By default Boost computes in long double. This would take most of the host's time for a slope distribution.
  const boost::math::policies::policy<boost::math::policies::promote_double<false>> in_double;
  if (x < 1.0) return boost::math::tgamma_ratio(x + 0.5, x, in_double);
  return boost::math::tgamma_delta_ratio(x + 0.5, -0.5, in_double);
}

}  // namespace dolp
