struct Slope {
  real t;
  real digits;        // digits required of the sum over the azimuths
  MaskingTerms masking_in;
  bool has_split_line;
  int most_azimuths;
  bool is_coarse;
  SkyPlace sky;
  real weight[DOLP_WIDTH];  // factor of this slope in AzimuthSums::columns, for each entry of the row (row.glsl)
};

// Sums over azimuths. `member` holds (r_i, r_q, albedo, deficit) for each entry of a row.
struct AzimuthSums {
  real4 member[DOLP_WIDTH];
  Columns columns[DOLP_WIDTH];  // running sums, which include all earlier slopes and arcs
  real2 direct;       // (I, Q) of the direct emission, not yet multiplied by smith masking
  real behind;        // s t sin(phi) at the horizon, subtracted from the deficit; error bounds cover the lost digits
  real evaluations;
};

AzimuthSums no_azimuths(Columns columns[DOLP_WIDTH]) {
  AzimuthSums sums;
  sums.evaluations = real(0.0);
  sums.behind = real(0.0);
  sums.direct = real2(real(0.0), real(0.0));
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    sums.member[g] = real4(real(0.0));
    sums.columns[g] = columns[g];
  }
  return sums;
}

// sin(theta_r). If q is just above 3/2 (is_diverging), G changes steeply near theta_r = 0, where 1 - cos(theta_r) has
// few digits. Then the function computes the sine as the length of the horizontal part of the reflected ray.
real sine_of_ray(ThetaNode theta, Row row, Facet f, real t, Azimuth at) {
  if (!is_diverging(row.shape[0])) return sqrt((real(1.0) - f.cos_r) * (real(1.0) + f.cos_r));
  real turned = real(2.0) * f.e * t / (real(1.0) + t * t);
  real along = turned * at.x - theta.s;
  real across = turned * at.sin_phi;
  return sqrt(along * along + across * across);
}

// Factors of the integrand in the two sums of a column (columns.glsl): x for Columns::i, y for Columns::q.
real2 column_factors(Slope slope, Facet f) {
  if (kColumns == DOLP_COLUMNS_SKY) return real2(f.m00, f.m01);
  real sky = (kColumns == DOLP_COLUMNS_SKY_RESPONSE) ? sky_function(slope.sky, 0, f.cos_r) : real(1.0);
  return real2(sky, sky * f.rotation);
}

AzimuthSums arc_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Slope slope, Arc arc, int zone,
                     bool leaves, int order, Columns columns[DOLP_WIDTH]) {
  AzimuthSums sums = no_azimuths(columns);
  int first_node = rule_offset(arc.section, order);
  for (int i = 0; i < order; ++i) {
    Azimuth at = azimuth(arc, place_on_arc(arc, rule_node(first_node + i)));
    if (kIsMultiple) {
      GrooveLight light = reflected_in_groove(rule, theta, index, slope.t, at.x, at.sin_phi);
      sums.member[0] += at.weight * light.moments;
      real weight = slope.weight[0] * at.weight;
      ColumnValues before = sky_at(slope.sky, light.cos_before);
      sums.columns[0] = add_columns(sums.columns[0], before, weight * light.before.x, weight * light.before.y);
      ColumnValues last = sky_at(slope.sky, light.cos_last);
      sums.columns[0] = add_columns(sums.columns[0], last, weight * light.last.x, weight * light.last.y);
    } else {
      Facet f = facet(theta, index, slope.t, at.x, at.sin_phi);
      MaskingTerms masking_out = masking_of_ray(row, f.cos_r, sine_of_ray(theta, row, f, slope.t, at), slope.t, zone);
      real leaving = leaves ? at.weight : real(0.0);
      ColumnValues values = column_values(rule, slope.sky, f.cos_beta, f.cos_r);
      real2 per_projection = column_factors(slope, f);
      for (int g = 0; g < DOLP_WIDTH; ++g) {
        Projection part = project(theta, f, zone, slope.masking_in.value[g], masking_out.value[g]);
        sums.member[g] += leaving * reflected(f, part);
        real projection = leaving * part.visible;
        if (kColumns == DOLP_COLUMNS_DIRECT) projection = at.weight * seen_directly(theta, f);
        projection *= slope.weight[g];
        sums.columns[g] =
            add_columns(sums.columns[g], values, projection * per_projection.x, projection * per_projection.y);
      }
      if (kHasDirect) sums.direct += at.weight * emitted(theta, f);
    }
  }
  sums.evaluations = real(order);
  return sums;
}

// The azimuth at which the zenith theta_r of the reflected ray reaches a corner (kink) of the sky.
real2 corner_line(ThetaNode theta, Slope slope, int corner) {
  real t = slope.t;
  real level = real(0.5) * (cos_of_corner(slope.sky, corner) + theta.c) * (real(1.0) + t * t) - theta.c;
  return line_at(level, max(theta.s * t, real(1e-30)));
}

// Sums over the azimuths from 0 to pi. Split lines divide the azimuths into zones. The line at which total reflection
// begins divides a zone into two arcs, and corners (kinks) of a sky divide the arcs further.
AzimuthSums azimuth_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Slope slope, SplitLines lines,
                         Columns columns[DOLP_WIDTH]) {
  AzimuthSums sums = no_azimuths(columns);
  bool is_critical = kTotalReflection && index.critical_cos > real(0.0);
  real2 last = real2(real(1.0), real(0.0));
  int halves = is_critical ? 1 : 0;
  for (int part = 0; part < (lines.arcs << halves); ++part) {
    int zone = part >> halves;
    bool is_odd = (part & 1) == 1;
    bool is_second = is_critical && is_odd;
    bool is_first_half = is_critical && !is_second;
    real2 from = last;
    real2 to = lines.end[zone];
    last = is_first_half ? last : to;
    if (kTotalReflection) {
      real2 middle = clamp_half_angle(lines.critical, from, to);
      from = is_second ? middle : from;
      to = is_first_half ? middle : to;
    }
    real2 start = from;
    for (int corner = 0; corner <= slope.sky.corners; ++corner) {
      real2 stop = to;
      if (corner < slope.sky.corners) stop = clamp_half_angle(corner_line(theta, slope, corner), start, to);
      // A loop of one turn is faster than an `if`: in lockstep, devices run both branches of an `if`, but skip a loop.
      for (bool run_once = is_before(start, stop); run_once; run_once = false) {
        bool is_first = !is_before(from, start);
        Arc arc = masked_arc(rule, theta, row.shape[0], slope.has_split_line, slope.t, slope.digits,
                             make_arc(start, stop), zone, is_first);
        if (kTotalReflection) {
          bool is_last = !is_before(stop, to);
          bool is_beside = is_second ? is_first : is_last;
          is_beside = is_critical && is_beside;
          arc = critical_arc(theta, index, slope.t, slope.digits, arc, !is_second, is_beside);
        }
        real nodes = arc_nodes(rule, theta, row.shape[0], index, slope.has_split_line, slope.t, slope.digits, arc, zone);
        int order = order_between(nodes, slope.most_azimuths);
        if (slope.is_coarse) order = coarse_order(order);
        AzimuthSums more = arc_sums(rule, theta, row, index, slope, arc, zone, zone < lines.leaving, order,
                                    sums.columns);
        for (int g = 0; g < DOLP_WIDTH; ++g) {
          sums.member[g] += more.member[g];
          sums.columns[g] = more.columns[g];
        }
        sums.direct += more.direct;
        sums.evaluations += more.evaluations;
      }
      start = stop;
    }
  }
  return sums;
}

// Sums over all facets of slope t. With single scattering, the deficit (light that does not leave the surface) includes
// the projection e of each facet that reflects below the horizon, even if e < 0. With all bounces every ray leaves.
AzimuthSums slope_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Slope slope,
                       Columns columns[DOLP_WIDTH]) {
  SplitLines lines = split_lines(rule, theta, index, slope.t, slope.has_split_line, slope.digits);
  AzimuthSums sums = azimuth_sums(rule, theta, row, index, slope, lines, columns);
  if (!kIsMultiple) {
    sums.behind = real(2.0) * theta.s * slope.t * lines.horizon.x * lines.horizon.y;
    real below = theta.c * real(4.0) * atan_unit(lines.horizon.x / (real(1.0) + lines.horizon.y));
    for (int g = 0; g < DOLP_WIDTH; ++g) sums.member[g].w += below - sums.behind;
  }
  return sums;
}

struct SlopeResult {
  AzimuthNode node;
  Columns columns;
};

// The sums at one slope, for slopes.comp. The masking does not depend on the slope distribution: no_row() is enough.
SlopeResult integrate_azimuths(RuleNode rule, ThetaNode theta, IndexNode index, SlopeNode slope_node) {
  Slope slope;
  slope.t = slope_node.t;
  slope.digits = slope_node.digits;
  slope.masking_in = unmasked();
  slope.has_split_line = false;
  slope.most_azimuths = int(slope_node.most_azimuths);
  slope.is_coarse = slope_node.is_coarse > real(0.5);
  slope.sky = sky_place();
  Columns columns[DOLP_WIDTH];
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    slope.weight[g] = real(1.0);
    columns[g] = no_columns();
  }
  AzimuthSums sums = slope_sums(rule, theta, no_row(), index, slope, columns);
  real4 all = sums.member[0];
  SlopeResult result;
  result.node = AzimuthNode(all.x, all.y, all.z, all.w, sums.behind, sums.direct.x, sums.direct.y, sums.evaluations);
  result.columns = sums.columns[0];
  return result;
}
