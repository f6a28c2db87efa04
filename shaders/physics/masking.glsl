// Geometric attenuation G (MODEL.md section 2): v-cavity in closed form, `integral` and smith from a table of
// one-dimensional integrals of the in-plane slope density p, one table for each shape.
//
// With Pt(x) = int_x^inf p, C(x) = int_x^inf g p and l(x) = int_x^inf g(tau) p(tau) (tau - x) dtau, where g = 1 for
// smith and 1 / sqrt(1 + tau^2) for `integral`:   l' = -C,  C' = -g p,  Pt' = -p.
//   smith, height-correlated:  G = 1 / (1 + L(theta) + L(theta_r)),  L = l(mu) / mu,  mu = cot(theta).
//   `integral`, eqs. (9)-(12), for kappa = sqrt(1 + t^2) / (mu + t) and d = (1 - mu^2) - 2 mu t:
//     d <= 0:  1 - G1 = kappa l(mu)                                 (the limit b of the second integral is pi/2)
//     d > 0:   1 - G1 = kappa [l(mu) - l(tb) - (tb - mu) C(tb)] + Pt(tb),   tb = (t (1 - mu^2) + 2 mu) / d.
// A table holds (l, C, Pt, p) at v = 1 + tau / table_scale = 2^octave (1 + cell / 2^kCellBits).

#ifdef DOLP_DOUBLE
CONST uint kCellBits = DOLP_MASKING_CELL_BITS_DOUBLE;
#else
CONST uint kCellBits = DOLP_MASKING_CELL_BITS_FLOAT;
#endif
CONST uint kMaskingNodes = DOLP_MASKING_NODES(kCellBits);
CONST uint kUnusedBits = 23u - kCellBits;
CONST uint kFirstNodeBits = 0x3f800000u >> kUnusedBits;  // exponent and leading mantissa bits of v = 1.0f

// v of a node: its float has the node's number in the exponent and the first bits of the mantissa.
real masking_node_v(uint node) { return real(uintBitsToFloat((node + kFirstNodeBits) << kUnusedBits)); }

real masking_node_tau(ShapeNode shape, uint node) { return (masking_node_v(node) - real(1.0)) * shape.table_scale; }

// The weight g of the tables' integrals.
real masking_weight(real tau) {
  return (kMasking == DOLP_MASKING_SMITH) ? real(1.0) : real(1.0) / sqrt(real(1.0) + tau * tau);
}

// -p'/p and -g'/g.
real marginal_decay(ShapeNode shape, real tau) {
  real u = tau / shape.m;
  if (kDistribution == DOLP_GAUSSIAN) return real(2.0) * u / shape.m;
  return (real(2.0) * shape.q_minus_1 + real(1.0)) * u / (shape.m * (real(1.0) + u * u));
}
real weight_decay(real tau) {
  return (kMasking == DOLP_MASKING_SMITH) ? real(0.0) : tau / (real(1.0) + tau * tau);
}

// Where tau lies in the table. Beyond the table's end the value at the end is used: only facets within 1e-5 of the line
// d = 0 and directions within 2e-5 of the normal look there.
struct TableCell {
  uint node;   // the one before tau
  real width;  // in tau
  real y;      // tau in the cell, 0 to 1
};

TableCell table_cell(ShapeNode shape, real tau) {
  real v = min(real(1.0) + tau / shape.table_scale, masking_node_v(kMaskingNodes - 1u));
  TableCell cell;
  cell.node = min((floatBitsToUint(float(v)) >> kUnusedBits) - kFirstNodeBits, kMaskingNodes - 2u);
  real v0 = masking_node_v(cell.node);
  real step = masking_node_v(cell.node + 1u) - v0;
  cell.width = step * shape.table_scale;
  cell.y = (v - v0) / step;
  return cell;
}

// Quintic Hermite interpolation of a function with values f, derivatives d and second derivatives e, by the cell's
// width and its square, at the ends of a cell.
real hermite(real f0, real f1, real d0, real d1, real e0, real e1, real y) {
  real z = real(1.0) - y;
  real rise = f1 - f0;
  real a = d0 - rise;  // of the cubic
  real b = rise - d1;
  real c = real(0.5) * e0 + real(2.0) * a - b;  // of what the cubic leaves
  real d = real(0.5) * e1 - a + real(2.0) * b;
  return f0 + y * (rise + z * (a * z + b * y + y * z * (c * z + d * y)));
}

// l at tau >= 0: l' = -C, l'' = g p.
real masking_height(ShapeNode shape, uint table, real tau) {
  TableCell cell = table_cell(shape, tau);
  real4 f0 = masking_node(table + cell.node);
  real4 f1 = masking_node(table + cell.node + 1u);
  real h = cell.width;
  real e0 = h * h * f0.w * masking_weight(masking_node_tau(shape, cell.node));
  real e1 = h * h * f1.w * masking_weight(masking_node_tau(shape, cell.node + 1u));
  return hermite(f0.x, f1.x, -h * f0.y, -h * f1.y, e0, e1, cell.y);
}

// (l, C, Pt) at tau >= 0.
real4 masking_tails(ShapeNode shape, uint table, real tau) {
  TableCell cell = table_cell(shape, tau);
  real4 f0 = masking_node(table + cell.node);
  real4 f1 = masking_node(table + cell.node + 1u);
  real tau0 = masking_node_tau(shape, cell.node);
  real tau1 = masking_node_tau(shape, cell.node + 1u);
  real h = cell.width;
  real gp0 = h * f0.w * masking_weight(tau0);
  real gp1 = h * f1.w * masking_weight(tau1);
  real p0_decay = h * marginal_decay(shape, tau0);
  real p1_decay = h * marginal_decay(shape, tau1);
  real height = hermite(f0.x, f1.x, -h * f0.y, -h * f1.y, h * gp0, h * gp1, cell.y);
  real first = hermite(f0.y, f1.y, -gp0, -gp1, gp0 * (p0_decay + h * weight_decay(tau0)),
                       gp1 * (p1_decay + h * weight_decay(tau1)), cell.y);
  real tail = hermite(f0.z, f1.z, -h * f0.w, -h * f1.w, h * f0.w * p0_decay, h * f1.w * p1_decay, cell.y);
  return real4(height, first, tail, real(0.0));
}

// 1 - G1(theta, alpha) for the direction (cos_theta, sin_theta) and the facet slope t.
real shadowed_integral(ShapeNode shape, uint table, real cos_theta, real sin_theta, real t) {
  real s = max(sin_theta, real(1e-10));
  real mu = cos_theta / s;
  real height = masking_height(shape, table, mu);
  real kappa = s * sqrt(real(1.0) + t * t) / (cos_theta + s * t);
  real difference = s * s - cos_theta * cos_theta;
  real twice_product = real(2.0) * s * cos_theta;
  real d = difference - twice_product * t;
  if (d <= real(0.0)) return kappa * height;
  real tau = min((difference * t + twice_product) / d, masking_node_tau(shape, kMaskingNodes - 1u));
  real4 tails = masking_tails(shape, table, tau);
  return kappa * (height - tails.x - (tau - mu) * tails.y) + tails.z;
}

// Smith's L of a direction; at 90 degrees a number so large that G is 0.
real smith_lambda(ShapeNode shape, uint table, real cos_theta, real sin_theta) {
  real mu = cos_theta / max(sin_theta, real(1e-30));
  return masking_height(shape, table, mu) / max(mu, real(1e-30));
}
