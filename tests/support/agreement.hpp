#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <dolp/results.hpp>

namespace dolp {

/// Expects that DOLP, Q/I, rho_I and rho_Q of two results differ by at most the sums of their stated errors, or are NaN
/// in both results.
inline void expect_agreement(const PointResult& a, const PointResult& b) {
  const double bound = a[Quantity::kErrorEstimate] + b[Quantity::kErrorEstimate];
  const double rho_i = std::max(a[Quantity::kRhoI], b[Quantity::kRhoI]);
  const double rho_bound = (a[Quantity::kRhoErrorEstimate] + b[Quantity::kRhoErrorEstimate]) * rho_i;
  const auto compare = [&](Quantity quantity, double allowed) {
    if (std::isnan(a[quantity]) && std::isnan(b[quantity])) return;
    EXPECT_NEAR(a[quantity], b[quantity], allowed) << describe(quantity).name;
  };
  for (const Quantity quantity : {Quantity::kDolp, Quantity::kQOverI}) compare(quantity, bound);
  for (const Quantity quantity : {Quantity::kRhoI, Quantity::kRhoQ}) compare(quantity, rho_bound);
}

}  // namespace dolp
