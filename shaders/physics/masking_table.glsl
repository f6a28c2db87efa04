// Builds a masking table (masking.glsl) from its far end inwards. All terms are positive, so no digits are lost.

CONST int kTableOrder = 4;  // Gauss order; 4 suffices because v = 1 + tau / table_scale grows by at most 9/8 in a cell

// The growth of l, C and Pt (masking.glsl) from tau1 down to tau0, and p(tau0). `beyond` is (l, C, Pt, p) at tau1.
real4 masking_cell(ShapeNode shape, real tau0, real tau1, real4 beyond) {
  real h = tau1 - tau0;
  real height = real(0.0);
  real first = real(0.0);
  real probability = real(0.0);
  for (int i = 0; i < kTableOrder; ++i) {
    real2 node = rule_node(gauss_offset(kTableOrder) + i);
    real rise = h * node.x;
    real tau = tau0 + rise;
    real weight = h * node.y * marginal_density(shape, tau);
    real weighted = weight * masking_weight(tau);
    probability += weight;
    first += weighted;
    height += weighted * rise;
  }
  return real4(h * beyond.y + height, first, probability, marginal_density(shape, tau0));
}

// (l, C, Pt, p) at the end of the table. Beyond it, p is a power law tau^(1-2q) for the cauchy, and 0 for the gaussian.
real4 masking_table_end(ShapeNode shape, real tau) {
  real p = marginal_density(shape, tau);
  if (kDistribution == DOLP_GAUSSIAN) return real4(real(0.0), real(0.0), real(0.0), p);
  real a = real(2.0) * shape.q_minus_1;
  real tail = p * tau / a;
  if (kMasking == DOLP_MASKING_SMITH) return real4(tail * tau / shape.two_q_minus_3, tail, tail, p);
  real weight = masking_weight(tau);
  return real4(tail * tau * weight / (a + real(1.0)), tail * a * weight / (a + real(1.0)), tail, p);
}

// Heavy tails add hundreds of nearly equal terms, so sums are compensated (Kahan 1965). `table`: position of node 0.
void build_masking_table(ShapeNode shape, uint table) {
  real tau1 = masking_node_tau(shape, kMaskingNodes - 1u);
  real4 tails = masking_table_end(shape, tau1);
  real4 carry = real4(real(0.0));
  store_masking_node(table + kMaskingNodes - 1u, tails);
  for (int node = int(kMaskingNodes) - 2; node >= 0; --node) {
    real tau0 = masking_node_tau(shape, uint(node));
    real4 cell = masking_cell(shape, tau0, tau1, tails);
    precise real4 term = cell - carry;
    precise real4 sum = tails + term;
    precise real4 lost = (sum - tails) - term;
    carry = lost;
    tails = real4(sum.x, sum.y, sum.z, cell.w);
    store_masking_node(table + uint(node), tails);
    tau1 = tau0;
  }
}
