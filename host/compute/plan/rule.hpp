#pragma once

#include <array>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Numbers that `dolp-calibrate fit` has fitted to minimise the work for random entries, including repetitions. The
/// rest of a rule follows from the positions of the integrand's singularities (shaders/physics/orders.glsl).
struct RuleModel {
  double margin_digits = 0.0;  ///< digits of the coarser rule in addition to the tolerance's digits
  double t_nodes = 0.0;        ///< t_nodes to phi_digits: see kernel::RuleNode
  double t_digits = 0.0;
  double t_fall = 0.0;
  double phi_nodes = 0.0;
  double phi_digits = 0.0;
  double cluster_stretch = 1.0;  ///< see kernel::RuleNode
};

/// The fitted numbers of a masking or, for kMultiple, of grooves with all bounces.
const RuleModel& rule_model(Masking masking, Scattering scattering = Scattering::kSingle);

/// Digits that the finer rule needs. They let the coarser rule, whose error is about the error bound, meet the
/// tolerance.
double rule_digits(const RuleModel& model, double tolerance);

kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// The largest k for which the azimuths are split where the beam of k bounces in a groove ends.
int split_bounces(double digits);

int largest_order(double digits);

/// True if the error without a split at the kink of the masking exceeds kLineShare of `tolerance`. The kink is smith's
/// cusp, or the line b = pi/2 of `integral` (shaders/physics/arcs.glsl).
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of the error without a split at smith's cusp, relative to Smith's Lambda. Below -100 if there is no cusp.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

using RuleNodes = std::vector<std::array<double, 2>>;  // (abscissa, weight) of each node

/// Ascending nodes on [-1, 1]. Accuracy: 1e-15 (tests/compute/plan/plan_test.cpp, polynomials of degree 2 * order - 1).
RuleNodes gauss_legendre(int order);

/// The sections of physics/quadrature.glsl, each with the orders 1 to `largest_order`. The result stays valid.
const RuleNodes& rule_nodes(int largest_order);

}  // namespace dolp
