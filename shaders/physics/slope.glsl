// The slope distribution (README.md beside this file, section 2, eqs. 1 and 8), with t = tan(alpha), m = sqrt(2) sigma
// and u = t / m. Its density in the slope plane is
//   P(t) = (q - 1) / (pi m^2) (1 + u^2)^-q (cauchy) or exp(-u^2) / (pi m^2) (gaussian).
// The integral of P t dt dphi over the slope plane is 1. With D, the distribution of normals, P = D cos^4(alpha).

// (cos, sin) of gamma = pi/2 - alpha.
real2 facet_turn(real t) {
  real r = real(1.0) / sqrt(real(1.0) + t * t);
  return real2(t * r, r);
}

// The share of facets that are steeper than t is exp(-exponent_factor(shape) * common_exponent(t / m)).
real common_exponent(real u) { return (kDistribution == DOLP_CAUCHY) ? log1p_square(u) : u * u; }
real exponent_factor(ShapeNode shape) { return (kDistribution == DOLP_CAUCHY) ? shape.q_minus_1 : real(1.0); }
real slope_tail_exponent(ShapeNode shape, real t) { return exponent_factor(shape) * common_exponent(t / shape.m); }

real slope_tail(ShapeNode shape, real t) { return exp_real(-slope_tail_exponent(shape, t)); }

// P(t) t m: the share of facets per radian of azimuth and per du. `exponent` is common_exponent(u). The formula has
// neither m^2 nor t^2, so it does not overflow.
real slope_density(ShapeNode shape, real u, real exponent) {
  real shape_factor = (kDistribution == DOLP_CAUCHY) ? shape.q_minus_1 / (u + real(1.0) / u) : u;
  return shape_factor * exp_real(-exponent_factor(shape) * exponent) / kPi;
}

// p(tau), the density of the slopes tau in one vertical plane, a marginal of P.
real marginal_density(ShapeNode shape, real tau) {
  real u = tau / shape.m;
  real exponent = (kDistribution == DOLP_CAUCHY) ? (shape.q_minus_1 + real(0.5)) * log1p_square(u) : u * u;
  return shape.marginal_norm * exp_real(-exponent);
}

CONST real kDivergingSlope = real(0.2);  // for 2q - 3 below this, the mean slope is very large
bool is_diverging(ShapeNode shape) {
  return kMasking == DOLP_MASKING_SMITH && kDistribution == DOLP_CAUCHY && shape.two_q_minus_3 < kDivergingSlope;
}
