#pragma once

#include <array>
#include <vector>

#include "plan/kernel_data.hpp"

namespace dolp {

/// Numbers from which shaders/physics/orders.glsl computes how many nodes each Gauss rule gets. `dolp-calibrate fit`
/// chose them for the least work at random entries. The work includes repetitions for entries that miss the tolerance.
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

/// Number of correct digits at which the finer of two rules aims. It is so large that the coarser rule meets the
/// tolerance too. The reason: the error bound contains the difference of the rules, about the error of the coarser one.
double rule_digits(const RuleModel& model, double tolerance);

kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// Largest number of bounces at whose change the azimuths are split, in runs with scattering = multiple.
int split_bounces(double digits);

int largest_order(double digits);

/// True if the integral must be split at the kink of the masking to keep its error below kLineShare * tolerance. For
/// smith, the kink is the cusp at theta_r = 0. For `integral`, it is the limit line in shaders/physics/README.md.
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of the relative error of Smith's Lambda if the integral is not split at the cusp. Without a cusp, below -100.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

using RuleNodes = std::vector<std::array<double, 2>>;  // (abscissa, weight) of each node

RuleNodes gauss_legendre(int order);

/// The rules with 1 to `largest_order` nodes, in the sections of physics/quadrature.glsl. The list is never freed.
const RuleNodes& rule_nodes(int largest_order);

}  // namespace dolp
