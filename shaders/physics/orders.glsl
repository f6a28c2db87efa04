// How many nodes a piece of the slope axis or an arc of the azimuth gets.
//
// A Gauss rule of n nodes on an interval of half length h, with the integrand's next singularity at a distance d beside
// it, is wrong by rho^(-2n), rho = exp(asinh(d/h)): a decimal digit costs ln(10) / (2 asinh(d/h)) nodes. What d is worth
// follows from a scan of the domain (host/plan/rule.cpp). The less a piece carries, the fewer digits it needs.

CONST real kHalfLn10 = real(1.15129254649702284);
CONST real kInverseLn10 = real(0.43429448190325182765);
CONST real kLn10 = real(2.30258509299404568402);
CONST real kDoubtPower = real(0.75);
CONST real kLeastWeight = real(1e-20);  // so that at 90 degrees all slopes weigh the same

real nodes_per_digit(real distance_over_half_length) {
  return kHalfLn10 / asinh_real(max(distance_over_half_length, real(1e-3)));
}

// What facets of slope t add to the albedo, c + s t without masking. The cavities let through no more than 2 c.
real weight_of_slope(ThetaNode theta, real t) {
  real bare = theta.c + theta.s * t;
  return kMasking == DOLP_MASKING_V_CAVITY ? min(bare, max(real(2.0) * theta.c, kLeastWeight)) : bare;
}

// The same of all facets.
real weight_of_shape(ThetaNode theta, ShapeNode shape) { return weight_of_slope(theta, real(0.6) * shape.m); }

// Digits that are wanted of the slopes in [a, b]: fewer by log10 of the share of the albedo they carry.
real digits_of_piece(RuleNode rule, ThetaNode theta, ShapeNode shape, real a, real b, real mass) {
  real typical = weight_of_slope(theta, clamp(shape.m, a, b));
  real share = min(mass * typical / weight_of_shape(theta, shape), real(1.0));
  return max(rule.digits + kInverseLn10 * log_unit(share), real(0.0));
}

// Digits that are wanted of the azimuths at slope t, one of `order` slopes of a piece, that stands for `mass` of the
// facets: less than of the piece where it carries less than its part.
real digits_of_slope(RuleNode rule, ThetaNode theta, ShapeNode shape, real digits, int order, real t, real mass) {
  real share = real(order) * mass * weight_of_slope(theta, t) / weight_of_shape(theta, shape);
  return clamp(rule.digits + kInverseLn10 * log_unit(min(share, real(1.0))), real(0.0), digits);
}

int order_between(real nodes, real limit) { return int(clamp(floor(nodes + real(0.5)), real(1.0), limit)); }

// Digits that a rule loses whose nodes are cut down to a limit. For d of its digits less, the nodes are
// (digits - d) (growth - curvature d), up to a factor.
real lost_digits(real digits, real growth, real curvature, real nodes, real limit) {
  if (nodes <= limit) return real(0.0);
  real cut = (real(1.0) - limit / nodes) * digits * growth;
  real slope = growth + curvature * digits;
  return real(2.0) * cut / (slope + sqrt(max(slope * slope - real(4.0) * curvature * cut, real(0.0))));
}

// Slope axis: nodes of a piece of length `extent` in X with `roots` at its ends.
real nodes_t(RuleNode rule, ThetaNode theta, real digits, real extent, real roots) {
  real per_digit = theta.t_growth * rule.t_growth * nodes_per_digit(real(2.0) * rule.t_strip / max(extent, real(1e-9)));
  return max(rule.t_nodes + digits * per_digit + rule.t_root_nodes * roots, real(2.0));
}

// Length of an arc in phi, from tan of its quarter: 4 atan(quarter), a percent too long at most.
real arc_length(real quarter) { return real(4.0) * quarter / (real(1.0) + real(0.28) * quarter * quarter); }

real half_arc_nodes(RuleNode rule, real digits, real distance, real length) {
  return real(0.5) * digits * rule.phi_growth * nodes_per_digit(distance / length);
}

// How far a sum may be off by one rule, up to a factor that host/plan/doubt_model.cpp knows. Where the integrand is smooth, the
// error of n nodes is to the null rule's value as that is to the sum; where it is not, it is what the orders were made
// for, 10^-digits. The geometric mean of the two is the closest to the truth over the domain.
real doubt(real sum, real null, real digits) {
  real whole = abs(sum);
  return min(exp_real(-kDoubtPower * kLn10 * digits) * sqrt(whole * abs(null)), whole);
}
