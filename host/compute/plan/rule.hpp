// The Gauss rules of the kernel: their nodes, and how many nodes a tolerance needs.
#pragma once

#include <array>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Fitted numbers of a masking's rules; all other numbers follow from the places of the integrand's singularities
/// (shaders/physics/orders.glsl). `dolp-calibrate fit` finds the numbers with the least work on random entries,
/// repeated computations included.
struct RuleModel {
  double margin_digits = 0.0;  ///< digits of the coarser rule beyond the tolerance
  double t_nodes = 0.0;        ///< kernel::RuleNode, field by field
  double t_digits = 0.0;
  double t_fall = 0.0;
  double phi_nodes = 0.0;
  double phi_digits = 0.0;
  double cluster_stretch = 1.0;  ///< smith: nodes per digit that make the cusp worth a cluster
};

/// The fitted numbers of a masking, or of all bounces in its grooves.
const RuleModel& rule_model(Masking masking, Scattering scattering = Scattering::kSingle);

/// Digits that a tolerance requires of the finer rule. The coarser rule must meet the tolerance, because their distance
/// is the bound.
double rule_digits(const RuleModel& model, double tolerance);

/// The kernel's rule for a tolerance.
kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// The bounces at which a beam that ends in a groove splits the azimuths.
int split_bounces(double digits);

/// The largest order of the rules for a number of digits.
int largest_order(double digits);

/// True if the line b = pi/2 of `integral`, or smith's cusp, must be a split: without it, rules of `digits` digits
/// would have an error of more than kLineShare of the tolerance.
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of the error by smith's cusp at theta_r = 0 in rules that do not split there, as a share of L; below -100
/// where there is no cusp.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

/// (abscissa, weight) of each node.
using RuleNodes = std::vector<std::array<double, 2>>;

/// Gauss-Legendre rule on [-1, 1] with ascending abscissae.
/// Accuracy: 1e-15 (tests/compute/plan_test.cpp integrates polynomials of degree 2 * order - 1).
RuleNodes gauss_legendre(int order);

/// The sections of shaders/physics/quadrature.glsl, with the orders 1 to `largest_order` in each. Computed once; the
/// reference stays valid.
const RuleNodes& rule_nodes(int largest_order);

}  // namespace dolp
