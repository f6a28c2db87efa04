// Geometric attenuation G (MODEL.md section 2): v-cavity in closed form, `integral` and smith from a table of
// one-dimensional integrals of the in-plane slope density p, one table for each shape.
//
// With Pt(x) = int_x^inf p, C(x) = int_x^inf g p and l(x) = int_x^inf g(tau) p(tau) (tau - x) dtau, where g = 1 for
// smith and 1 / sqrt(1 + tau^2) for `integral`:   l' = -C,  C' = -g p,  Pt' = -p.
//   smith, height-correlated:  G = 1 / (1 + L(theta) + L(theta_r)),  L = l(mu) / mu,  mu = cot(theta).
//   `integral`, eqs. (9)-(12), for kappa = sqrt(1 + t^2) / (mu + t) and d = (1 - mu^2) - 2 mu t:
//     d <= 0:  1 - G1 = kappa l(mu)                                 (the limit b of the second integral is pi/2)
//     d > 0:   1 - G1 = kappa [l(mu) - l(tb) - (tb - mu) C(tb)] + Pt(tb),   tb = (t (1 - mu^2) + 2 mu) / d.
// A table holds (l, C, Pt, p) at v = 1 + tau / table_scale = 2^octave (1 + cell / 16).

CONST uint kFirstNodeBits = 0x3f800000u >> 19;  // exponent and four mantissa bits of v = 1.0f

// v of a node: its float has the node's number in the exponent and the first four bits of the mantissa.
real masking_node_v(uint node) { return real(uintBitsToFloat((node + kFirstNodeBits) << 19)); }

real masking_node_tau(ShapeNode shape, uint node) { return (masking_node_v(node) - real(1.0)) * shape.table_scale; }

// The weight g of the tables' integrals.
real masking_weight(real tau) {
  return (kMasking == DOLP_MASKING_SMITH) ? real(1.0) : real(1.0) / sqrt(real(1.0) + tau * tau);
}

// (l, C, Pt) at tau >= 0 by cubic Hermite interpolation with the exact derivatives. Beyond the table's end the value at
// the end is used: only facets within 1e-5 of the line d = 0 and directions within 2e-5 of the normal look there.
real4 masking_tails(ShapeNode shape, uint table, real tau) {
  real v = min(real(1.0) + tau / shape.table_scale, masking_node_v(uint(DOLP_MASKING_NODES - 1)));
  uint cell = min((floatBitsToUint(float(v)) >> 19) - kFirstNodeBits, uint(DOLP_MASKING_NODES - 2));
  real v0 = masking_node_v(cell);
  real v1 = masking_node_v(cell + 1u);
  real4 f0 = masking_node(table + cell);
  real4 f1 = masking_node(table + cell + 1u);
  real h = (v1 - v0) * shape.table_scale;
  real tau0 = masking_node_tau(shape, cell);
  real tau1 = masking_node_tau(shape, cell + 1u);
  real y = (v - v0) / (v1 - v0);
  real4 d0 = -h * real4(f0.y, f0.w * masking_weight(tau0), f0.w, real(0.0));
  real4 d1 = -h * real4(f1.y, f1.w * masking_weight(tau1), f1.w, real(0.0));
  real4 rise = f1 - f0;
  real4 curve = (d0 - rise) * (real(1.0) - y) + (rise - d1) * y;
  return f0 + y * (rise + (real(1.0) - y) * curve);
}

// 1 - G1(theta, alpha) for the direction (cos_theta, sin_theta) and the facet slope t.
real shadowed_integral(ShapeNode shape, uint table, real cos_theta, real sin_theta, real t) {
  real s = max(sin_theta, real(1e-10));
  real mu = cos_theta / s;
  real height = masking_tails(shape, table, mu).x;
  real kappa = s * sqrt(real(1.0) + t * t) / (cos_theta + s * t);
  real difference = s * s - cos_theta * cos_theta;
  real twice_product = real(2.0) * s * cos_theta;
  real d = difference - twice_product * t;
  if (d <= real(0.0)) return kappa * height;
  real tau = min((difference * t + twice_product) / d, masking_node_tau(shape, uint(DOLP_MASKING_NODES - 1)));
  real4 tails = masking_tails(shape, table, tau);
  return kappa * (height - tails.x - (tau - mu) * tails.y) + tails.z;
}

// Smith's L of a direction; at 90 degrees a number so large that G is 0.
real smith_lambda(ShapeNode shape, uint table, real cos_theta, real sin_theta) {
  real mu = cos_theta / max(sin_theta, real(1e-10));
  return masking_tails(shape, table, mu).x / max(mu, real(1e-30));
}
