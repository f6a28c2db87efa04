// Computes G of `integral` and smith masking for one pair of directions, without a masking table: a pBRDF needs G only
// once or twice. Gauss rules integrate over tau, the slope of a facet in the plane of incidence. Let p(tau) be the
// density of these slopes, mu = cot(theta), and kappa = sqrt(1 + t^2) / (mu + t) for the facet slope t. Then
//   smith, height-correlated:  Lambda(theta) = (1 / mu) int_mu^inf p(tau) (tau - mu) dtau
//   `integral`:  1 - G1 = int_mu^inf p(tau) min(1, kappa (tau - mu) / sqrt(1 + tau^2)) dtau
// The second formula is eqs. (9)-(12) of the paper with tau = tan(gamma). The minimum is 1 for tau > tb (masking.glsl).
// The variable of the rules is X = asinh(tau / scale). The rules end at a steep slope. Beyond this slope, the Cauchy
// density p is nearly a power law, so the integral has a closed form.

#ifdef DOLP_DOUBLE
CONST int kInPlaneOrder = 16;  // order of the Gauss rule on a panel, whose length in X is at most 1
CONST real kPowerLawSlope = real(1e7);
#else
CONST int kInPlaneOrder = 8;
CONST real kPowerLawSlope = real(1e4);
#endif

CONST real kSmallestSine = real(1e-18);
CONST real kLargestSwitch = real(1e20);  // upper limit of tb (masking.glsl); hardly any slope is larger

CONST uint kWeightOne = 0u;
CONST uint kWeightVisible = 1u;  // weight tau - mu for smith, (tau - mu) / sqrt(1 + tau^2) for `integral`

real in_plane_end(ShapeNode shape) { return min(shape.cut, kPowerLawSlope * max(shape.m, real(1.0))); }

// Integral of p times `weight` over the slopes from `from` to `to`; 0 if to <= from.
real in_plane_sum(ShapeNode shape, uint weight, real mu, real from, real to) {
  if (to <= from) return real(0.0);
  real start = asinh_real(from / shape.scale);
  real extent = asinh_real(to / shape.scale) - start;
  int panels = int(extent) + 1;
  real length = extent / real(panels);
  real sum = real(0.0);
  for (int panel = 0; panel < panels; ++panel) {
    for (int i = 0; i < kInPlaneOrder; ++i) {
      real2 node = rule_node(gauss_offset(kInPlaneOrder) + i);
      real2 hyperbolic = sinh_cosh(start + length * (real(panel) + node.x));
      real tau = shape.scale * hyperbolic.x;
      real visible = max(tau - mu, real(0.0)) * masking_weight(tau);
      real weighted = (weight == kWeightOne) ? real(1.0) : visible;
      sum += node.y * weighted * marginal_density(shape, tau) * hyperbolic.y;
    }
  }
  return sum * length * shape.scale;
}

// Integral of p times `weight` over all slopes above `from`, where p ~ tau^(1 - 2q). For the gaussian it counts as 0.
real power_law_sum(ShapeNode shape, uint weight, real mu, real from) {
  if (kDistribution == DOLP_GAUSSIAN) return real(0.0);
  real a = real(2.0) * shape.q_minus_1;
  real tail = marginal_density(shape, from) * from / a;
  if (weight == kWeightOne) return tail;
  if (kMasking == DOLP_MASKING_SMITH) return tail * ((from - mu) + from / shape.two_q_minus_3);
  return tail * (real(1.0) + a * (real(1.0) - mu / from)) / (a + real(1.0));
}

real in_plane_beyond(ShapeNode shape, uint weight, real mu, real from) {
  real end = in_plane_end(shape);
  return in_plane_sum(shape, weight, mu, from, end) + power_law_sum(shape, weight, mu, max(from, end));
}

// Smith's Lambda for one direction. At 90 degrees Lambda is so large that G is 0.
real in_plane_lambda(ShapeNode shape, real cos_theta, real sin_theta) {
  real mu = max(cos_theta / max(sin_theta, kSmallestSine), real(1e-30));
  return in_plane_beyond(shape, kWeightVisible, mu, mu) / mu;
}

// 1 - G1(theta, alpha) of `integral` for the facet slope t.
real in_plane_shadowed(ShapeNode shape, real cos_theta, real sin_theta, real t) {
  real s = max(sin_theta, kSmallestSine);
  real mu = cos_theta / s;
  real kappa = s * sqrt(real(1.0) + t * t) / (cos_theta + s * t);
  real difference = s * s - cos_theta * cos_theta;
  real twice_product = real(2.0) * s * cos_theta;
  real d = difference - twice_product * t;
  if (d <= real(0.0)) return kappa * in_plane_beyond(shape, kWeightVisible, mu, mu);
  real end = in_plane_end(shape);
  real tb = min((difference * t + twice_product) / d, kLargestSwitch);
  real partly = in_plane_sum(shape, kWeightVisible, mu, mu, min(tb, end));
  if (tb > end) {
    real from = min(max(mu, end), tb);
    partly += power_law_sum(shape, kWeightVisible, mu, from) - power_law_sum(shape, kWeightVisible, mu, tb);
  }
  return kappa * partly + in_plane_beyond(shape, kWeightOne, mu, tb);
}
