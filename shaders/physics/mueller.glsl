// The specular Mueller pBRDF of one geometry (README.md beside this file, sections 1 and 2, eqs. 4, 7 and 15).
// For Stokes vectors (I, Q, U, V) with U = 2 Re(E_s* E_p) and V = 2 Im(E_s* E_p), the matrix M is a product of three:
//   turn by eta_i:  Q' = cos(2 eta_i) Q + sin(2 eta_i) U,  U' = -sin(2 eta_i) Q + cos(2 eta_i) U
//   reflection:     [A B 0 0; B A 0 0; 0 0 C -S; 0 0 S C] with A, B = (R_s +- R_p)/2 and C + i S = r_s* r_p
//   turn by -eta_r
// Let s and p be the polarisation vectors of a direction. A turn by eta replaces s by the s vector of the facet,
// cos(eta) s + sin(eta) p. sin(eta) has the sign of sin(dphi); eq. 4 as printed in the paper has the opposite sign.

real attenuation(GeometryNode g, ShapeNode shape) {
  if (kMasking == DOLP_MASKING_NONE) return real(1.0);
  if (kMasking == DOLP_MASKING_SMITH) {
    return real(1.0) / (real(1.0) + in_plane_lambda(shape, g.c_i, g.s_i) + in_plane_lambda(shape, g.c_r, g.s_r));
  }
  bool incident_is_lower = g.c_i * g.s_r < g.c_r * g.s_i;  // compares tangents: a cosine near 1 loses digits
  real lower_cos = incident_is_lower ? g.c_i : g.c_r;
  real lower_sin = incident_is_lower ? g.s_i : g.s_r;
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    return min(real(1.0), real(2.0) * lower_cos / (sqrt(real(1.0) + g.slope * g.slope) * g.cos_beta));
  }
  return real(1.0) - in_plane_shadowed(shape, lower_cos, lower_sin, g.slope);
}

// The pBRDF for k_s = 1, times cos(theta_i) cos(theta_r). Like BeamNode::density, it is divided by 2^Beam::power.
MuellerNode mueller(BeamNode beam) {
  GeometryNode g = beam.g;
  real scale = beam.density * attenuation(g, beam.shape);
  real a = scale * beam.m00;
  real b = scale * beam.m01;
  real c = scale * beam.cross_re;
  real s = scale * beam.cross_im;
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
