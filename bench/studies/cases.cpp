#include "studies/cases.hpp"

#include <cmath>
#include <numbers>

namespace dolp::bench {
namespace {

constexpr double kSpread = 1e-3;

/// Element i of a sequence that fills the interval (-1, 1) evenly and never repeats. The element is 2 x - 1, where x is
/// the fractional part of i * irrational.
double even_offset(std::size_t i, double irrational) {
  const double x = irrational * static_cast<double>(i);
  return 2.0 * (x - std::floor(x)) - 1.0;
}

}  // namespace

const std::vector<Case>& cases() {
  static const std::vector<Case> list = {
      {"easy", "dielectric, no masking", Masking::kNone, 30.0, {0.3, 2.0}, {1.508, 0.0}},
      {"median", "stainless steel of the paper", Masking::kIntegral, 60.0, {0.445, 2.0}, {1.508, 0.0}},
      {"rough", "aviation aluminium of the paper", Masking::kSmith, 75.0, {0.905, 2.0}, {1.373, 0.0}},
      {"hard", "smooth metal near grazing", Masking::kVCavity, 85.0, {0.1, 3.0}, {27.0, 90.0}},
      {"worst", "heaviest tails at grazing", Masking::kIntegral, 89.0, {1.0, 1.1}, {1.508, 0.0}},
  };
  return list;
}

MomentsRequest neighbourhood(const Case& which, std::size_t count) {
  MomentsRequest request;
  request.masking = which.masking;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta_deg = which.theta_deg * (1.0 + kSpread * (i > 0 ? even_offset(i, std::numbers::phi) : 0.0));
    SlopeShape shape = which.shape;
    shape.sigma *= 1.0 + kSpread * (i > 0 ? even_offset(i, std::numbers::sqrt2) : 0.0);
    shape.q *= 1.0 + kSpread * (i > 0 ? even_offset(i, std::numbers::sqrt3) : 0.0);
    request.append({theta_deg, shape, which.index});
  }
  return request;
}

}  // namespace dolp::bench
