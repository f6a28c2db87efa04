// The nodes of the rules, one buffer of (abscissa, weight) in five sections; within a section the rule of order n
// starts at n (n - 1) / 2. host/compute/plan/rule.cpp fills it.
//   gauss   Gauss-Legendre on [0, 1]
//   centre  Gauss-Legendre on [-1, 1]                              an arc between two split lines
//   half    the positive nodes of the rule of order 2n on [-1, 1]  an arc from phi = 0 or pi, even about that end
//   circle  tan(psi/4) of the midpoints of n equal parts of [0, pi]: the whole half circle, spectral for periodic f
//   cluster Gauss-Legendre on [0, 1] in sqrt(tau / T): an arc from a cusp or square root at its centre
// centre, half, circle and cluster hold abscissae of tau / T, where tau = tan(psi/4) and
// dpsi = 4 T / (1 + tau^2) d(tau/T).

CONST int kSectionGauss = 0;
CONST int kSectionCentre = 1;
CONST int kSectionHalf = 2;
CONST int kSectionCircle = 3;
CONST int kSectionCluster = 4;

int gauss_offset(int order) { return order * (order - 1) / 2; }

int rule_offset(int section, int order) {
  return section * (largest_order() * (largest_order() + 1) / 2) + gauss_offset(order);
}
