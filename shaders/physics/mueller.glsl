// The specular Mueller pBRDF of one geometry, all 16 elements (shaders/physics/README.md, sections 1 and 2, eqs. 4, 7,
// 15).
//
// The Jones matrix turns s and p into the facet's plane by eta_i, reflects, and turns back by eta_r into the plane of
// the reflected beam; s of the facet is cos(eta) s + sin(eta) p, so that sin(eta) has the sign of sin(dphi) with the
// frames s = k x z, p = k x s (in eq. 4 as printed it has the other). On Stokes vectors (I, Q, U, V) with
// U = 2 Re(E_s* E_p), V = 2 Im(E_s* E_p) that is
//   Q' = cos(2 eta_i) Q + sin(2 eta_i) U,   U' = -sin(2 eta_i) Q + cos(2 eta_i) U,   the facet's matrix
//   [A B 0 0; B A 0 0; 0 0 C -S; 0 0 S C],   A, B = (R_s +- R_p)/2,   C + i S = r_s* r_p,   and the reverse by eta_r.
// Without cancellation: r_s* r_p = a (sin^2 beta - c w) / (conj(c + w) (N^2 c + w)), a as in fresnel.glsl.

// r_s* r_p, as (Re, Im), from R_s, w, c + w and N^2 c + w: R_s (sin^2 beta - c w) (c + w) / (N^2 c + w), since a = R_s B.
real2 cross_amplitude(real r_s, GeometryNode g, real2 w, real2 s_sum, real2 p_sum) {
  real2 numerator = multiply(real2(g.sin2_beta - g.cos_beta * w.x, -g.cos_beta * w.y), s_sum);
  real norm = max(p_sum.x * p_sum.x + p_sum.y * p_sum.y, kSmallestSquare);
  real2 quotient = multiply(numerator, real2(p_sum.x / norm, -p_sum.y / norm));
  return real2(r_s * quotient.x, r_s * quotient.y);
}

// G of one geometry.
real attenuation(GeometryNode g, ShapeNode shape) {
  if (kMasking == DOLP_MASKING_NONE) return real(1.0);
  if (kMasking == DOLP_MASKING_SMITH) {
    return real(1.0) / (real(1.0) + in_plane_lambda(shape, g.c_i, g.s_i) + in_plane_lambda(shape, g.c_r, g.s_r));
  }
  bool incident_is_lower = g.c_i * g.s_r < g.c_r * g.s_i;  // near the normal the cosines of a float are all 1
  real lower_cos = incident_is_lower ? g.c_i : g.c_r;
  real lower_sin = incident_is_lower ? g.s_i : g.s_r;
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    return min(real(1.0), real(2.0) * lower_cos / (sqrt(real(1.0) + g.slope * g.slope) * g.cos_beta));
  }
  return real(1.0) - in_plane_shadowed(shape, lower_cos, lower_sin, g.slope);
}

// f cos(theta_i) cos(theta_r) for k_s = 1 [1/sr], row by row, over the power of two of the density: finite at grazing
// incidence.
MuellerNode mueller(BeamNode beam) {
  GeometryNode g = beam.g;
  real2 w = sqrt_upper(beam.w2_re, beam.n2m1_im);
  real2 s_sum = real2(g.cos_beta + w.x, w.y);
  real2 p_sum = real2(beam.n2_re * g.cos_beta + w.x, beam.n2m1_im * g.cos_beta + w.y);
  Fresnel f = fresnel_of_sums(real2(beam.n2m1_re, beam.n2m1_im), g.cos_beta, w, s_sum, p_sum);
  real scale = beam.density * attenuation(g, beam.shape);
  real half_split = real(0.5) * f.split_over_sin2 * g.sin2_beta;
  real a = scale * (f.r_s - half_split);
  real b = scale * half_split;
  real2 cross = cross_amplitude(f.r_s, g, w, s_sum, p_sum);
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
