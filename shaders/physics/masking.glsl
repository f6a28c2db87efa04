// Geometric attenuation G by the maskings `integral` and smith (README.md beside this file, sections 2 and 8). Each
// slope distribution has a table of integrals of p(tau), the density of the slopes tau in the plane of incidence. With
// g = 1 for smith and g = 1 / sqrt(1 + tau^2) for `integral`, the integrals are
//   Pt(x) = int_x^inf p dtau,   C(x) = int_x^inf g p dtau,   l(x) = int_x^inf g p (tau - x) dtau.
// The masking follows from these integrals. Let mu = cot(theta), and let t be the slope of the facet.
//   smith, height-correlated:  G = 1 / (1 + Lambda(theta) + Lambda(theta_r)),  Lambda(theta) = l(mu) / mu.
//   `integral`, eqs. (9)-(12) of the paper, for kappa = sqrt(1 + t^2) / (mu + t) and d = (1 - mu^2) - 2 mu t:
//     d <= 0:  1 - G1 = kappa l(mu)
//     d > 0:   1 - G1 = kappa [l(mu) - l(tb) - (tb - mu) C(tb)] + Pt(tb),   tb = (t (1 - mu^2) + 2 mu) / d.
// A table holds (l, C, Pt, p) at nodes of the variable v = 1 + tau / table_scale. The nodes divide each octave of
// v, from 2^j to 2^(j + 1), into 2^kCellBits equal cells.

#ifdef DOLP_DOUBLE
CONST uint kCellBits = DOLP_MASKING_CELL_BITS_DOUBLE;
#else
CONST uint kCellBits = DOLP_MASKING_CELL_BITS_FLOAT;
#endif
CONST uint kMaskingNodes = DOLP_MASKING_NODES(kCellBits);
CONST uint kUnusedBits = 23u - kCellBits;
CONST uint kFirstNodeBits = 0x3f800000u >> kUnusedBits;  // exponent and leading mantissa bits of v = 1.0f

// v of a node. Only the leading bits of v differ between nodes. Read as an integer, they are node + kFirstNodeBits.
real masking_node_v(uint node) { return real(uintBitsToFloat((node + kFirstNodeBits) << kUnusedBits)); }

real masking_node_tau(ShapeNode shape, uint node) { return (masking_node_v(node) - real(1.0)) * shape.table_scale; }

// The factor g in the integrals C and l (head of this file).
real masking_weight(real tau) {
  return (kMasking == DOLP_MASKING_SMITH) ? real(1.0) : real(1.0) / sqrt(real(1.0) + tau * tau);
}

// Relative decrease of p and g: -p'/p is marginal_decay() times marginal_decay_factor(), and -g'/g is weight_decay().
real marginal_decay(ShapeNode shape, real tau) {
  real u = tau / shape.m;
  if (kDistribution == DOLP_GAUSSIAN) return real(2.0) * u / shape.m;
  return u / (shape.m * (real(1.0) + u * u));
}
real marginal_decay_factor(ShapeNode shape) {
  return (kDistribution == DOLP_GAUSSIAN) ? real(1.0) : real(2.0) * shape.q_minus_1 + real(1.0);
}
real weight_decay(real tau) {
  return (kMasking == DOLP_MASKING_SMITH) ? real(0.0) : tau / (real(1.0) + tau * tau);
}

// The cell of a table that contains tau, and the weights of the quintic Hermite interpolation in this cell. f0, d0 and
// e0 multiply the value, the first and the second derivative at the start of the cell; f1, d1 and e1 those at its end.
struct TableCell {
  uint node;  // the last node at or before tau
  real f0;
  real f1;
  real d0;
  real d1;
  real e0;
  real e1;
  real g0;  // the factor g at the start of the cell
  real g1;
};

TableCell table_cell(ShapeNode shape, real tau) {
  real v = min(real(1.0) + tau / shape.table_scale, masking_node_v(kMaskingNodes - 1u));
  TableCell cell;
  cell.node = min((floatBitsToUint(float(v)) >> kUnusedBits) - kFirstNodeBits, kMaskingNodes - 2u);
  real v0 = masking_node_v(cell.node);
  real step = masking_node_v(cell.node + 1u) - v0;
  real y = (v - v0) / step;
  real z = real(1.0) - y;
  real h = step * shape.table_scale;
  real y2 = y * y;
  real z2 = z * z;
  real y3 = y2 * y;
  real z3 = z2 * z;
  cell.f0 = z3 * (real(1.0) + real(3.0) * y + real(6.0) * y2);
  cell.f1 = y3 * (real(1.0) + real(3.0) * z + real(6.0) * z2);
  cell.d0 = h * y * z3 * (real(1.0) + real(3.0) * y);
  cell.d1 = -h * z * y3 * (real(1.0) + real(3.0) * z);
  cell.e0 = real(0.5) * h * h * y2 * z3;
  cell.e1 = real(0.5) * h * h * z2 * y3;
  cell.g0 = masking_weight(masking_node_tau(shape, cell.node));
  cell.g1 = masking_weight(masking_node_tau(shape, cell.node + 1u));
  return cell;
}

// Interpolates l from l, l' = -C and l'' = g p at both ends of the cell. `table` is the position of the first node.
real masking_height(TableCell cell, uint table) {
  real4 n0 = masking_node(table + cell.node);
  real4 n1 = masking_node(table + cell.node + 1u);
  return (cell.f0 * n0.x + cell.f1 * n1.x) - (cell.d0 * n0.y + cell.d1 * n1.y) +
         (cell.e0 * cell.g0 * n0.w + cell.e1 * cell.g1 * n1.w);
}

// The arguments at which the masking tables are read for 1 - G1(theta, alpha).
struct ShadowRange {
  real kappa;
  bool is_limited;  // true if d > 0; then 1 - G1 contains integrals from tb (head of this file)
  real far;         // tb
  real gap;         // tb - mu
};

real shadow_cot(real cos_theta, real sin_theta) { return cos_theta / max(sin_theta, real(1e-10)); }

ShadowRange shadow_range(ShapeNode shape, real cos_theta, real sin_theta, real t) {
  real s = max(sin_theta, real(1e-10));
  real mu = cos_theta / s;
  real difference = s * s - cos_theta * cos_theta;
  real twice_product = real(2.0) * s * cos_theta;
  real d = difference - twice_product * t;
  ShadowRange range;
  range.kappa = s * sqrt(real(1.0) + t * t) / (cos_theta + s * t);
  range.is_limited = d > real(0.0);
  real far = choose(range.is_limited, (difference * t + twice_product) / d, mu);
  far = min(far, masking_node_tau(shape, kMaskingNodes - 1u));
  range.far = far;
  range.gap = far - mu;
  return range;
}

// Weights of l, C, p and Pt at both ends of the cell that contains tb (head of this file). The weighted sum is the term
// Pt(tb) - kappa [l(tb) + (tb - mu) C(tb)]. If d > 0, 1 - G1 is kappa l(mu) plus this term.
struct LimitTerms {
  real l0;
  real l1;
  real c0;
  real c1;
  real p0;  // p has the weight p0 + decay0 * marginal_decay_factor(). Only this factor depends on q: a row shares p0.
  real p1;
  real decay0;
  real decay1;
  real tail0;
  real tail1;
};

LimitTerms limit_terms(ShapeNode shape, ShadowRange range, TableCell cell) {
  real tau0 = masking_node_tau(shape, cell.node);
  real tau1 = masking_node_tau(shape, cell.node + 1u);
  real lever = range.kappa * range.gap;
  LimitTerms terms;
  terms.l0 = -range.kappa * cell.f0;
  terms.l1 = -range.kappa * cell.f1;
  terms.c0 = range.kappa * cell.d0 - lever * cell.f0;
  terms.c1 = range.kappa * cell.d1 - lever * cell.f1;
  terms.p0 = -cell.g0 * (range.kappa * cell.e0 + lever * (cell.e0 * weight_decay(tau0) - cell.d0)) - cell.d0;
  terms.p1 = -cell.g1 * (range.kappa * cell.e1 + lever * (cell.e1 * weight_decay(tau1) - cell.d1)) - cell.d1;
  terms.decay0 = cell.e0 * marginal_decay(shape, tau0) * (real(1.0) - lever * cell.g0);
  terms.decay1 = cell.e1 * marginal_decay(shape, tau1) * (real(1.0) - lever * cell.g1);
  terms.tail0 = cell.f0;
  terms.tail1 = cell.f1;
  return terms;
}

real limited_shadow(ShapeNode shape, LimitTerms terms, TableCell cell, uint table) {
  real4 n0 = masking_node(table + cell.node);
  real4 n1 = masking_node(table + cell.node + 1u);
  real factor = marginal_decay_factor(shape);
  return (terms.tail0 * n0.z + terms.tail1 * n1.z) + (terms.l0 * n0.x + terms.l1 * n1.x) +
         (terms.c0 * n0.y + terms.c1 * n1.y) + (terms.p0 + factor * terms.decay0) * n0.w +
         (terms.p1 + factor * terms.decay1) * n1.w;
}
