#pragma once

#include <array>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Numbers from which shaders/physics/orders.glsl computes how many nodes each Gauss rule gets. `dolp-calibrate fit`
/// found the numbers with the least work for random entries. Entries that miss the tolerance cost a second computation.
struct RuleModel {
  double margin_digits = 0.0;  ///< digits of the coarser rule (see rule_digits()) minus digits of the tolerance
  double t_nodes = 0.0;        ///< this and all members below: see kernel::RuleNode
  double t_digits = 0.0;
  double t_fall = 0.0;
  double phi_nodes = 0.0;
  double phi_digits = 0.0;
  double cluster_stretch = 1.0;
};

/// The fitted numbers for a masking with single scattering, or for grooves with all bounces (kMultiple).
const RuleModel& rule_model(Masking masking, Scattering scattering = Scattering::kSingle);

/// Decimal digits for the finer of two rules, so many that the coarser rule meets the tolerance too. The error bound
/// contains the difference of the two rules, which is about the error of the coarser rule.
double rule_digits(const RuleModel& model, double tolerance);

kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// With all bounces, azimuths are split where the number of bounces changes, but not beyond this number of bounces.
int split_bounces(double digits);

int largest_order(double digits);

/// True if the integral must be split at the kink of the masking: without the split its error exceeds kLineShare *
/// tolerance. For smith, the kink is a cusp at theta_r = 0; for `integral`, the limit line (shaders/physics/README.md).
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of the relative error of Smith's Lambda without a split at its cusp (theta_r = 0). Below -100 without a cusp.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

using RuleNodes = std::vector<std::array<double, 2>>;  // (abscissa, weight) of each node

/// The Gauss-Legendre rule with `order` nodes on [-1, 1], in ascending order.
RuleNodes gauss_legendre(int order);

/// The rules with 1 to `largest_order` nodes, in the sections of physics/quadrature.glsl. The list is never freed.
const RuleNodes& rule_nodes(int largest_order);

}  // namespace dolp
