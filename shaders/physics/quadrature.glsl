// The nodes of the Gauss rules: one buffer of pairs (abscissa, weight), filled by host/compute/plan/rule.cpp. In each
// of its five sections the rule of order n begins at position n (n - 1) / 2.
//   gauss: Gauss-Legendre on [0, 1]
//   centre: Gauss-Legendre on [-1, 1], for an arc of azimuths between two split lines
//   half: positive nodes of the Gauss-Legendre rule of order 2n on [-1, 1], for an arc that begins or ends at phi = 0
//     or pi, about which the integrand is even
//   circle: tan(psi/4) at the midpoints of n equal parts of [0, pi], for all azimuths as one arc; converges
//     geometrically, because the integrand is periodic
//   cluster: Gauss-Legendre on [0, 1] in sqrt(tau / T), for an arc with a cusp or square root at its centre
// The abscissae of the last four sections are tau / T. Here psi is the azimuth measured from the centre of the arc,
// tau = tan(psi/4) and T = Arc::extent, so dpsi = 4 T / (1 + tau^2) d(tau/T).

CONST int kSectionGauss = 0;
CONST int kSectionCentre = 1;
CONST int kSectionHalf = 2;
CONST int kSectionCircle = 3;
CONST int kSectionCluster = 4;

int gauss_offset(int order) { return order * (order - 1) / 2; }

int rule_offset(int section, int order) {
  return section * (largest_order() * (largest_order() + 1) / 2) + gauss_offset(order);
}
