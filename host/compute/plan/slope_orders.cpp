#include "plan/slope_orders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/slopes.hpp"
#include "plan/constants.hpp"
#include "plan/kernel_data.hpp"

namespace dolp {
namespace {

// The part of order k in a moment is at most about kFirstOrder * order_fall(e)^k, where e is the eccentricity. Measured
// over sigma 0.05 to 2, theta 30 to 88 degrees, width ratios 1.2 to 3, gaussian and cauchy, v-cavity masking.
constexpr double kFirstOrder = 1.5;
double order_fall(double eccentricity) { return eccentricity * (0.55 + 0.3 * eccentricity); }

constexpr double kOrdersShare = 0.5;  // the neglected orders may take this share of the tolerance
constexpr double kMostOrders = 24.0;
constexpr double kSectorShare = 1e-3;  // error of the mean over the sectors, as a share of the tolerance
// Safety factor of neglected_orders(): kTailFactor or, if larger, kWideTailFactor / (1 - eccentricity). At grazing
// angles the orders of very unequal widths fall more slowly than order_fall().
constexpr double kTailFactor = 3.0;
constexpr double kWideTailFactor = 1.5;

double wanted_order(double eccentricity, double tolerance) {
  const double fall = order_fall(eccentricity);
  const double neglected = kOrdersShare * tolerance * (1.0 - fall) / kFirstOrder;
  return std::max(std::ceil(std::log(neglected) / std::log(fall)) - 1.0, 1.0);
}

double largest_eccentricity(const MomentsRequest& request) {
  double largest = 0.0;
  for (const SlopeShape& shape : request.shapes) largest = std::max(largest, eccentricity(shape));
  return largest;
}

}  // namespace

SlopeOrders slope_orders(const MomentsRequest& request) {
  const double eccentricity = largest_eccentricity(request);
  if (eccentricity == 0.0) return {};
  const double highest = std::min(wanted_order(eccentricity, request.tolerance), kMostOrders);
  const double sectors = highest + std::ceil(std::log(kSectorShare * request.tolerance) / std::log(eccentricity));
  return {static_cast<std::size_t>(highest), static_cast<std::size_t>(std::ceil(0.5 * sectors))};
}

double largest_width_ratio(double tolerance) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (wanted_order(middle, tolerance) <= kMostOrders ? low : high) = middle;
  }
  return (1.0 + low) / (1.0 - low);
}

int nodes_of_orders(const SlopeOrders& orders) {
  const auto highest = static_cast<double>(orders.highest + DOLP_ROW_WIDTH - 1);  // an invocation computes several
  return static_cast<int>(std::ceil(DOLP_NODES_OF_ORDER * std::numbers::pi * highest));
}

double neglected_orders(double eccentricity, double before_last, double last) {
  const double fall = order_fall(eccentricity);
  const double largest = std::max(std::abs(last), fall * std::abs(before_last));
  return std::max(kTailFactor, kWideTailFactor / (1.0 - eccentricity)) * largest * fall / (1.0 - fall);
}

}  // namespace dolp
