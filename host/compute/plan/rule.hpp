// The Gauss rules of the kernel: their nodes, and how many nodes a tolerance needs.
#pragma once

#include <array>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Fitted numbers of a masking's rules. All other numbers follow from the positions of the integrand's singularities
/// (shaders/physics/orders.glsl). `dolp-calibrate fit` finds the numbers that minimise the work for random entries,
/// with repeated computations.
struct RuleModel {
  double margin_digits = 0.0;  ///< digits of the coarser rule in addition to the tolerance's digits
  double t_nodes = 0.0;        ///< t_nodes to phi_digits: see the members of kernel::RuleNode
  double t_digits = 0.0;
  double t_fall = 0.0;
  double phi_nodes = 0.0;
  double phi_digits = 0.0;
  double cluster_stretch = 1.0;  ///< smith: nodes per digit from which a cluster at the cusp pays
};

/// The fitted numbers of a masking, or of its grooves with all bounces.
const RuleModel& rule_model(Masking masking, Scattering scattering = Scattering::kSingle);

/// Digits that the finer rule needs for a tolerance. The coarser rule must meet the tolerance, because the difference
/// of both rules, which is the bound, is nearly its error.
double rule_digits(const RuleModel& model, double tolerance);

/// The kernel's rule for a tolerance.
kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// The largest k for which the azimuths are split where the beam of k bounces in a groove ends.
int split_bounces(double digits);

/// The largest order of the rules for a number of digits.
int largest_order(double digits);

/// True if the rules must split at the line b = pi/2 of `integral`, or at smith's cusp. Without the split, rules of
/// `digits` digits would have an error above kLineShare of the tolerance.
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of the error that smith's cusp at theta_r = 0 causes in rules that do not split there, relative to Smith's
/// Lambda. Below -100 if there is no cusp.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

/// (abscissa, weight) of each node.
using RuleNodes = std::vector<std::array<double, 2>>;

/// Gauss-Legendre rule on [-1, 1] with ascending abscissae.
/// Accuracy: 1e-15 (tests/compute/plan_test.cpp integrates polynomials of degree 2 * order - 1).
RuleNodes gauss_legendre(int order);

/// The sections of shaders/physics/quadrature.glsl, each with the orders 1 to `largest_order`. The reference stays
/// valid: the nodes are computed only once.
const RuleNodes& rule_nodes(int largest_order);

}  // namespace dolp
