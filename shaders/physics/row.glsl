// Entries that one invocation computes together. They differ only in q, so they share the facets and the reflection.
// The shapes are in ascending order of q. Some members are read only from shape[0], so all shapes have the smallest
// scale and table_scale, and the largest cut and cusp_digits, of the row.
struct Row {
  ShapeNode shape[DOLP_WIDTH];
  uint table[DOLP_WIDTH];  // position of the first node of each entry's masking table
};

// A dummy row, for maskings that do not depend on the slope distribution.
Row no_row() {
  Row row;
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    row.shape[g] =
        ShapeNode(real(1.0), real(1.0), real(1.0), real(1.0), real(1.0), real(1.0), real(1.0), real(0.0));
    row.table[g] = 0u;
  }
  return row;
}

// Masking toward one direction, for each entry of a row: Lambda for smith, 1 - G1 at one slope t for `integral`.
struct MaskingTerms {
  real value[DOLP_WIDTH];
};

MaskingTerms unmasked() {
  MaskingTerms masked;
  for (int g = 0; g < DOLP_WIDTH; ++g) masked.value[g] = real(0.0);
  return masked;
}

// The part of the masking that does not depend on the slope t: Lambda for smith; for `integral`, the integral
// l(cot(theta)) of masking.glsl. At 90 degrees Lambda is so large that G is 0.
MaskingTerms masking_of_direction(Row row, real cos_theta, real sin_theta) {
  MaskingTerms heights = unmasked();
  if (kMasking == DOLP_MASKING_SMITH) {
    real mu = cos_theta / max(sin_theta, real(1e-30));
    TableCell cell = table_cell(row.shape[0], mu);
    real inverse = real(1.0) / max(mu, real(1e-30));
    for (int g = 0; g < DOLP_WIDTH; ++g) heights.value[g] = masking_height(cell, row.table[g]) * inverse;
  }
  if (kMasking == DOLP_MASKING_INTEGRAL) {
    TableCell cell = table_cell(row.shape[0], shadow_cot(cos_theta, sin_theta));
    for (int g = 0; g < DOLP_WIDTH; ++g) heights.value[g] = masking_height(cell, row.table[g]);
  }
  return heights;
}

// 1 - G1 of `integral`. `limited` is always computed: invocations run in lockstep, so a branch would save no time.
MaskingTerms shadows(Row row, MaskingTerms heights, real cos_theta, real sin_theta, real t) {
  ShadowRange range = shadow_range(row.shape[0], cos_theta, sin_theta, t);
  TableCell cell = table_cell(row.shape[0], range.far);
  LimitTerms terms = limit_terms(row.shape[0], range, cell);
  MaskingTerms masked;
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    real limited = limited_shadow(row.shape[g], terms, cell, row.table[g]);
    masked.value[g] = range.kappa * heights.value[g] + (range.is_limited ? limited : real(0.0));
  }
  return masked;
}

// Masking toward the reflected ray. For `integral`, project() does not use it in zone 0, where theta_r < theta.
MaskingTerms masking_of_ray(Row row, real cos_r, real sin_r, real t, int zone) {
  if (kMasking == DOLP_MASKING_SMITH) return masking_of_direction(row, cos_r, sin_r);
  MaskingTerms masked = unmasked();
  if (kMasking == DOLP_MASKING_INTEGRAL && zone > 0) {
    masked = shadows(row, masking_of_direction(row, cos_r, sin_r), cos_r, sin_r, t);
  }
  return masked;
}

// Share of a facet's direct emission that smith masking leaves; 1 for other maskings. `masking_in` is Lambda(theta).
real smith_g1(real masking_in) { return (kMasking == DOLP_MASKING_SMITH) ? real(1.0) / (real(1.0) + masking_in) : real(1.0); }

// A facet's projection, masked toward theta and toward the reflected ray. `zone` is the number of the interval between
// two split lines, counted from phi = 0. In zone 0 theta_r < theta, so `integral` masking depends only on theta.
Projection project(ThetaNode theta, Facet f, int zone, real masking_in, real masking_out) {
  if (kMasking == DOLP_MASKING_NONE) return Projection(f.e, real(0.0));
  if (kMasking == DOLP_MASKING_V_CAVITY) {
    real visible = min(f.e, real(2.0) * min(theta.c, f.cos_r));
    return Projection(visible, f.e - visible);
  }
  if (kMasking == DOLP_MASKING_SMITH) {
    real lambdas = masking_in + masking_out;
    real g = real(1.0) / (real(1.0) + lambdas);
    return Projection(f.e * g, f.e * (lambdas * g));
  }
  real shadow = (zone > 0) ? masking_out : masking_in;
  return Projection(f.e * (real(1.0) - shadow), f.e * shadow);
}
