// The specular Mueller pBRDF of one geometry, all 16 elements (MODEL.md sections 1 and 2, eqs. 4, 7, 15).
//
// The Jones matrix turns s and p into the facet's plane by eta_i, reflects, and turns back by eta_r into the plane of
// the reflected beam; s of the facet is cos(eta) s + sin(eta) p, so that sin(eta) has the sign of sin(dphi) with the
// frames s = k x z, p = k x s (in eq. 4 as printed it has the other). On Stokes vectors (I, Q, U, V) with
// U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p) that is
//   Q' = cos(2 eta_i) Q + sin(2 eta_i) U,   U' = -sin(2 eta_i) Q + cos(2 eta_i) U,   the facet's matrix
//   [A B 0 0; B A 0 0; 0 0 C -S; 0 0 S C],   A, B = (R_s +- R_p)/2,   C + i S = r_s* r_p,   and the reverse by eta_r.
// Without cancellation: r_s* r_p = -a (c w - sin^2 beta) / (conj(c + w) (N^2 c + w)), a as in fresnel.glsl.

real2 multiply(real2 a, real2 b) { return real2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// r_s* r_p, as (Re, Im).
real2 cross_amplitude(IndexNode index, real cos_beta, real sin2_beta) {
  real2 w = sqrt_upper(index.n2m1_re + cos_beta * cos_beta, index.n2m1_im);
  real2 s_sum = real2(cos_beta + w.x, w.y);
  real2 p_sum = real2((index.n2m1_re + real(1.0)) * cos_beta + w.x, index.n2m1_im * cos_beta + w.y);
  real a = (index.n2m1_re * index.n2m1_re + index.n2m1_im * index.n2m1_im) / (s_sum.x * s_sum.x + s_sum.y * s_sum.y);
  real2 denominator = multiply(real2(s_sum.x, -s_sum.y), p_sum);
  real norm = denominator.x * denominator.x + denominator.y * denominator.y;
  real2 numerator = real2(sin2_beta - cos_beta * w.x, -cos_beta * w.y);
  real2 quotient = multiply(numerator, real2(denominator.x, -denominator.y));
  return real2(a * quotient.x / norm, a * quotient.y / norm);
}

// G of one geometry.
real attenuation(GeometryNode g, ShapeNode shape, uint table) {
  if (kMasking == DOLP_MASKING_NONE) return real(1.0);
  bool incident_is_lower = g.c_i < g.c_r;
  real lower_cos = incident_is_lower ? g.c_i : g.c_r;
  real lower_sin = incident_is_lower ? g.s_i : g.s_r;
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    return min(real(1.0), real(2.0) * lower_cos / (sqrt(real(1.0) + g.slope * g.slope) * g.cos_beta));
  }
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    return real(1.0) - shadowed_integral(shape, table, lower_cos, lower_sin, g.slope);
  }
  real lambdas = smith_lambda(shape, table, g.c_i, g.s_i) + smith_lambda(shape, table, g.c_r, g.s_r);
  return real(1.0) / (real(1.0) + lambdas);
}

// f cos(theta_i) cos(theta_r) for k_s = 1 [1/sr], row by row: finite at grazing incidence.
MuellerNode mueller(GeometryNode g, ShapeNode shape, IndexNode index, uint table) {
  real sec2 = real(1.0) + g.slope * g.slope;
  real density = slope_profile(shape, g.slope) / (shape.m * shape.m) * sec2 * sec2;
  real scale = real(0.25) * density * attenuation(g, shape, table);
  Fresnel f = fresnel(index, g.cos_beta);
  real half_split = real(0.5) * f.split_over_sin2 * g.sin2_beta;
  real a = scale * (f.r_s - half_split);
  real b = scale * half_split;
  real2 cross = cross_amplitude(index, g.cos_beta, g.sin2_beta);
  real c = scale * cross.x;
  real s = scale * cross.y;
  MuellerNode result;
  result.m[0] = a;
  result.m[1] = b * g.cos_2eta_i;
  result.m[2] = b * g.sin_2eta_i;
  result.m[3] = real(0.0);
  result.m[4] = b * g.cos_2eta_r;
  result.m[5] = a * g.cos_2eta_i * g.cos_2eta_r + c * g.sin_2eta_i * g.sin_2eta_r;
  result.m[6] = a * g.sin_2eta_i * g.cos_2eta_r - c * g.cos_2eta_i * g.sin_2eta_r;
  result.m[7] = s * g.sin_2eta_r;
  result.m[8] = b * g.sin_2eta_r;
  result.m[9] = a * g.cos_2eta_i * g.sin_2eta_r - c * g.sin_2eta_i * g.cos_2eta_r;
  result.m[10] = a * g.sin_2eta_i * g.sin_2eta_r + c * g.cos_2eta_i * g.cos_2eta_r;
  result.m[11] = -s * g.cos_2eta_r;
  result.m[12] = real(0.0);
  result.m[13] = -s * g.sin_2eta_i;
  result.m[14] = s * g.cos_2eta_i;
  result.m[15] = c;
  return result;
}
