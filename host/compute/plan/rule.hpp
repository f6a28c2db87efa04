#pragma once

#include <array>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Numbers from which shaders/physics/orders.glsl computes how many nodes a rule has. `dolp-calibrate fit` has fitted
/// them: they minimise the work for random entries, including entries that are computed twice.
struct RuleModel {
  double margin_digits = 0.0;  ///< digits of the coarser rule, minus the digits of the tolerance
  double t_nodes = 0.0;        ///< this and all members below: see kernel::RuleNode
  double t_digits = 0.0;
  double t_fall = 0.0;
  double phi_nodes = 0.0;
  double phi_digits = 0.0;
  double cluster_stretch = 1.0;
};

/// The fitted numbers of a masking or, for kMultiple, of grooves with all bounces.
const RuleModel& rule_model(Masking masking, Scattering scattering = Scattering::kSingle);

/// Decimal digits that the finer rule needs so that the coarser rule meets the tolerance. The coarser rule must meet
/// it, because the error bound is about the error of the coarser rule.
double rule_digits(const RuleModel& model, double tolerance);

kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// In grooves the azimuths are split where the number of bounces changes, up to the number that this function returns.
int split_bounces(double digits);

int largest_order(double digits);

/// True if the error without a split at the kink of the masking exceeds kLineShare * tolerance. The kink is the cusp of
/// smith masking (theta_r = 0) or the limit line of `integral` masking (shaders/physics/README.md, section 8).
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of the relative error of Smith's Lambda if rules are not split at its cusp. Below -100 if there is no cusp.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

using RuleNodes = std::vector<std::array<double, 2>>;  // (abscissa, weight) of each node

/// Ascending nodes on [-1, 1]. Accuracy: 1e-15 (tests/compute/plan/plan_test.cpp, polynomials of degree 2 * order - 1).
RuleNodes gauss_legendre(int order);

/// Nodes for all sections of physics/quadrature.glsl, each with 1 to `largest_order` nodes. The result stays valid.
const RuleNodes& rule_nodes(int largest_order);

}  // namespace dolp
