// Fresnel reflection for N = n + ik, in forms without cancellation.
// With c = cos(beta), w = sqrt(N^2 - sin^2 beta) = sqrt((N^2 - 1) + c^2), B = |c + w|^2, a = |N^2 - 1|^2 / B:
//   R_s = |c - w|^2 / B = a / B                      because (c - w)(c + w) = 1 - N^2
//   (R_s - R_p) / sin^2(beta) = 4 c Re(w) a / |N^2 c + w|^2
//   1 - R_s = 4 c Re(w) / B
// The quotient (R_s - R_p) / sin^2(beta) keeps its digits at normal incidence. Its users multiply it by sin^2(beta).

CONST real kSmallestSquare = real(1e-37);

struct Fresnel {
  real r_s;
  real absorbed_s;         // 1 - R_s
  real split_over_sin2;    // (R_s - R_p) / sin^2(beta)
  real2 w;                 // w of the head of this file; 0 for reflectances from a table
};

// sqrt(re + i im) for im >= 0, as (Re, Im), both >= 0 and each without cancellation.
real2 sqrt_upper(real re, real im) {
  real modulus = sqrt(re * re + im * im);
  real larger = sqrt(real(0.5) * (modulus + abs(re)));
  real smaller = choose(larger > real(0.0), real(0.5) * im / larger, real(0.0));
  return real2(re >= real(0.0) ? larger : smaller, re >= real(0.0) ? smaller : larger);
}

// Reflection by a bare surface, without films. Domain: 0 < cos_beta <= 1.
Fresnel fresnel(IndexNode index, real cos_beta) {
  real2 n2m1 = real2(index.n2m1_re, index.n2m1_im);
  real2 w = sqrt_upper(n2m1.x + cos_beta * cos_beta, n2m1.y);
  real2 s_sum = real2(cos_beta + w.x, w.y);
  real2 p_sum = real2((n2m1.x + real(1.0)) * cos_beta + w.x, n2m1.y * cos_beta + w.y);  // N^2 c + w
  // Without the lower limit, N = 1 at grazing incidence would give 0/0 if the squares underflow.
  real inverse_b = real(1.0) / max(s_sum.x * s_sum.x + s_sum.y * s_sum.y, kSmallestSquare);
  real a = (n2m1.x * n2m1.x + n2m1.y * n2m1.y) * inverse_b;
  real transmitted = real(4.0) * cos_beta * w.x;
  Fresnel f;
  f.r_s = a * inverse_b;
  f.absorbed_s = transmitted * inverse_b;
  f.split_over_sin2 = transmitted * a / max(p_sum.x * p_sum.x + p_sum.y * p_sum.y, kSmallestSquare);
  f.w = w;
  return f;
}

// Measured reflectances have kinks at the measured angles. The azimuths are split at the sharpest kinks: their number
// and the cosines of their angles, in ascending order of the angle, precede the table, from back to front.
int curve_start(IndexNode index) { return DOLP_CURVE_ALIGNMENT * int(index.curve_start); }

int row_kinks(IndexNode index) {
  if (!kHasCurves || index.curve_cells >= real(0.0)) return 0;
  return int(table_node(curve_start(index) - 1).x);
}

real cos_of_kink(IndexNode index, int i) { return table_node(curve_start(index) - 2 - i).x; }

// Reads R_s, 1 - R_s and (R_s - R_p) / sin^2(beta) of films or of measured reflectances from a table
// (host/compute/plan/reflectance_curve.cpp). Each cell of the table has cubics in sqrt(cos(beta)) (films) or in
// sqrt(1 - cos(beta)) (measured). Measured reflectances have a kink at each measured angle. So beyond the angle in a
// cell, other cubics follow.
Fresnel reflectance_at(IndexNode index, real cos_beta) {
  bool is_measured = index.curve_cells < real(0.0);
  int cells = int(abs(index.curve_cells));
  // Rounding may make cos(beta) negative at grazing incidence, or larger than 1 at normal incidence.
  real position = sqrt(max(is_measured ? real(1.0) - cos_beta : cos_beta, real(0.0))) * real(cells);
  int cell = min(int(position), cells - 1);
  real x = position - real(cell);
  int start = curve_start(index);
  int first = start + DOLP_CURVE_NODES * cell;
  if (is_measured) {
    real2 kink = table_node(start + DOLP_CURVE_NODES * cells + cell);
    if (x > kink.x) first = start + int(kink.y);
  }
  real value[3];
  for (int i = 0; i < 3; ++i) {
    real2 low = table_node(first + 2 * i);
    real2 high = table_node(first + 2 * i + 1);
    value[i] = low.x + x * (low.y + x * (high.x + x * high.y));
  }
  return Fresnel(max(value[0], real(0.0)), max(value[1], real(0.0)), value[2], real2(real(0.0), real(0.0)));
}
