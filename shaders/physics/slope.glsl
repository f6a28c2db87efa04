// The slope distribution (MODEL.md section 2, eqs. 1 and 8). Slope t = tan(alpha), m = sqrt(2) sigma.

// P(t), the density over the slope plane: integral of P(t) t dt dphi over the plane is 1. Equals D cos^4(alpha).
real slope_density(ShapeNode shape, real t) {
  real u = t / shape.m;
  real exponent = u * u;
  if (kDistribution == DOLP_CAUCHY) exponent = shape.q * log1p_real(exponent);
  return shape.norm * exp_real(-exponent);
}

// 2 pi times the integral of P(t') t' over t' > t: the share of the facets that are steeper than t.
real slope_tail(ShapeNode shape, real t) {
  real u = t / shape.m;
  real exponent = u * u;
  if (kDistribution == DOLP_CAUCHY) exponent = (shape.q - real(1.0)) * log1p_real(exponent);
  return exp_real(-exponent);
}

// p(tau), the density of the slope in one plane: the marginal of P.
real marginal_density(ShapeNode shape, real tau) {
  real u = tau / shape.m;
  real exponent = u * u;
  if (kDistribution == DOLP_CAUCHY) exponent = (shape.q - real(0.5)) * log1p_real(exponent);
  return shape.marginal_norm * exp_real(-exponent);
}
