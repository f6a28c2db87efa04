// How many nodes the rules of the kernel get for a tolerance.
#pragma once

#include "plan/kernel_data.hpp"

namespace dolp {

/// Share of the finer rule's nodes, hence of its digits, that the coarser rule of a pair has: coarse_order of
/// shaders/physics/orders.glsl.
inline constexpr double kCoarseShare = 0.8;

/// What is fitted of a masking's rules: everything else follows from where the integrand's singularities lie
/// (shaders/physics/orders.glsl). `dolp-calibrate fit` finds the numbers: the least work on random entries, entries
/// that have to be computed again included.
struct RuleModel {
  double margin_digits = 0.0;  ///< digits of the coarser rule beyond the tolerance
  double t_nodes = 0.0;        ///< kernel::RuleNode, field by field
  double t_digits = 0.0;
  double t_fall = 0.0;
  double phi_nodes = 0.0;
  double phi_digits = 0.0;
  double cluster_stretch = 1.0;  ///< smith: nodes for each digit from which on the cusp is worth a cluster
};

/// The fitted numbers of a masking, or of all bounces in its grooves.
const RuleModel& rule_model(Masking masking, Scattering scattering = Scattering::kSingle);

/// Digits that a tolerance asks of the finer rule: the coarser one must meet it, because their distance is the bound.
double rule_digits(const RuleModel& model, double tolerance);

/// The kernel's rule for a tolerance.
kernel::RuleNode rule_node(const RuleModel& model, double tolerance);

/// The bounces at which a beam that ends in a groove splits the azimuths.
int split_bounces(double digits);

/// The largest order of the rules for a number of digits.
int largest_order(double digits);

/// Whether a slope distribution needs the line b = pi/2 of `integral`, or smith's cusp, as a split: whether without one
/// rules of so many digits would be wrong by a share of the tolerance.
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits, double tolerance);

/// log10 of what smith's cusp at theta_r = 0 costs rules that do not split there, as a share of L; below -100 where it
/// is none.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

}  // namespace dolp
