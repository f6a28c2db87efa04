// How many nodes the rules of the kernel get for a tolerance.
#pragma once

#include "plan/kernel_data.hpp"

namespace dolp {

/// Calibrated numbers of one masking; dolp-calibrate shows what they cost and reach.
struct RuleModel {
  double margin_digits = 0.0;         ///< digits beyond the tolerance, so that few entries miss it
  double t_nodes = 0.0;               ///< RuleNode::t_nodes
  double t_strip = 1.0;               ///< distance in X to the next singularity off the real axis
  double t_oblique = 0.0;             ///< more nodes for each digit from 65 to 80 degrees
  double t_root_nodes = 0.0;          ///< RuleNode::t_root_nodes
  double t_curvature = 0.0;           ///< more nodes for each digit, for each digit beyond four
  double phi_half_nodes = 0.0;        ///< RuleNode::phi_half_nodes
  double phi_centre_nodes = 0.0;      ///< RuleNode::phi_centre_nodes
  double strip[3] = {1.0, 1.0, 1.0};  ///< RuleNode::strip
  double phi_grazing = 0.0;           ///< RuleNode::strip narrows toward grazing incidence
  double phi_curvature = 0.0;         ///< likewise
  double phi_circle_nodes = 0.0;      ///< RuleNode::phi_circle_nodes
  double phi_circle_growth = 0.0;     ///< RuleNode::phi_circle_growth
  double phi_pole_growth = 0.5;       ///< RuleNode::phi_pole_growth
  double circle_pole = 0.5;           ///< RuleNode::circle_pole
  double phi_cluster_growth = 1.0;    ///< RuleNode::phi_cluster_growth
  double cluster_curvature = 0.0;     ///< like phi_curvature, for arcs with a cluster
  double cluster_pole = 1.0;          ///< RuleNode::cluster_pole_growth
  double t_line = 1.0;                ///< factor of the nodes for each digit where a line or cusp is split off
  double phi_line = 1.0;              ///< likewise
  double cusp_digits = 0.0;           ///< smith: digits by which the cusp is smaller than its formula says
  double line_threshold = 0.0;        ///< multiples of 10^-digits from which a line or cusp is worth its pieces
  double tight_growth = 0.0;          ///< more nodes of t and of clusters for each digit beyond eight
};

/// The numbers for a masking.
const RuleModel& rule_model(Masking masking);

/// Digits that a tolerance asks of the rules.
double rule_digits(Masking masking, double tolerance);

/// The kernel's rule for a number of digits.
kernel::RuleNode rule_node(Masking masking, double digits);

/// Whether a slope distribution needs the line b = pi/2 of `integral`, or smith's cusp, at this many digits.
bool needs_line(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

/// log10 of the size of smith's cusp at theta_r = 0, L ~ (m tan(theta_r))^(2q-2), as far as it is felt at this many
/// digits; below -100 where it is not.
double cusp_digits(Distribution distribution, Masking masking, const SlopeShape& shape, double digits);

}  // namespace dolp
