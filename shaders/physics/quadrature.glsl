// The nodes of the quadrature rules. host/compute/plan/rule.cpp fills one buffer with pairs (abscissa, weight). The
// buffer has five sections. In each section the rule of order n begins at position n (n - 1) / 2.
//   gauss: Gauss-Legendre on [0, 1], for pieces of the slope axis
// The other sections are for arcs of azimuths. Let psi be the azimuth measured from the centre of the arc, tau =
// tan(psi/4) and T = Arc::extent. The abscissa is tau / T, so dpsi = 4 T / (1 + tau^2) d(tau/T).
//   centre: Gauss-Legendre on [-1, 1], for an arc between two split lines
//   half: positive nodes of the Gauss-Legendre rule of order 2n on [-1, 1], for an arc that begins at 0 or ends at pi;
//     the integrand is symmetric about 0 and pi
//   circle: tan(psi/4) at the midpoints of n equal parts of [0, pi], for an arc from 0 to pi
//   cluster: Gauss-Legendre on [0, 1] in sqrt(tau / T), for an arc with a cusp or square root at its centre

CONST int kSectionGauss = 0;
CONST int kSectionCentre = 1;
CONST int kSectionHalf = 2;
CONST int kSectionCircle = 3;
CONST int kSectionCluster = 4;

int gauss_offset(int order) { return order * (order - 1) / 2; }

int rule_offset(int section, int order) {
  return section * (largest_order() * (largest_order() + 1) / 2) + gauss_offset(order);
}
