// Sums over the azimuths at one slope: a Gauss rule on each arc of azimuths (arcs.glsl).

// Number of azimuthal orders that an invocation computes. Orders are the entries of a row.
#if DOLP_ORDERS == 1
#define DOLP_ORDER_WIDTH DOLP_WIDTH
#else
#define DOLP_ORDER_WIDTH 1
#endif

// Sums over azimuths. `member` holds (r_i, r_q, albedo, deficit) for each entry of a row, or each azimuthal order.
struct AzimuthSums {
  real4 member[DOLP_WIDTH];
  Columns columns[DOLP_WIDTH];  // running sums, which include all earlier slopes and arcs
  real2 direct[DOLP_ORDER_WIDTH];  // (I, Q) of the direct emission, not yet multiplied by smith masking
  real2 u[DOLP_ORDER_WIDTH];       // U of the reflected light and of the direct emission
  real behind;        // s t sin(phi) at the horizon, subtracted from the deficit; error bounds cover the lost digits
  real evaluations;
};

AzimuthSums no_azimuths(Columns columns[DOLP_WIDTH]) {
  AzimuthSums sums;
  sums.evaluations = real(0.0);
  sums.behind = real(0.0);
  for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) sums.direct[g] = sums.u[g] = real2(real(0.0), real(0.0));
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

// (cos, sin) of 2 k phi, where at = (cos, sin) of phi.
real2 order_factors(int k, real2 at) {
  real2 power = multiply(at, at);
  real2 turn = real2(real(1.0), real(0.0));
  for (int bit = 1; bit < 32; bit *= 2) {  // DOLP_ROW_WIDTH more than the highest order is below 32
    if ((k & bit) != 0) turn = multiply(turn, power);
    power = multiply(power, power);
  }
  return turn;
}

// order_factors() of each entry of the row: 1 and 0 without azimuthal orders.
struct OrderFactors {
  real2 value[DOLP_WIDTH];
};

OrderFactors row_factors(int first, Azimuth at) {
  OrderFactors factors;
  for (int g = 0; g < DOLP_WIDTH; ++g) factors.value[g] = real2(real(1.0), real(0.0));
  if (kHasOrders) {
    real2 phi = real2(at.x, at.sin_phi);
    factors.value[0] = order_factors(first, phi);
    for (int g = 1; g < DOLP_WIDTH; ++g) factors.value[g] = multiply(factors.value[g - 1], multiply(phi, phi));
  }
  return factors;
}

// Adds light that leaves a groove, `light` = (r_i, r_q) and `u`, to the columns with these values.
AzimuthSums add_groove_columns(AzimuthSums sums, OrderFactors weights, ColumnValues values, real2 light, real u) {
  for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) {
    real2 weight = weights.value[g];
    sums.columns[g] = add_columns(sums.columns[g], values, weight.x * light.x, weight.x * light.y);
    if (kHasOrders) sums.columns[g] = add_u_columns(sums.columns[g], values, weight.y * u);
  }
  return sums;
}

AzimuthSums arc_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Slope slope, Arc arc, int zone,
                     bool leaves, int order, Columns columns[DOLP_WIDTH]) {
  AzimuthSums sums = no_azimuths(columns);
  int first_node = rule_offset(arc.section, order);
  for (int i = 0; i < order; ++i) {
    Azimuth at = azimuth(arc, place_on_arc(arc, rule_node(first_node + i)));
    OrderFactors factors = row_factors(slope.order, at);
    if (kIsMultiple) {
      GrooveLight light = reflected_in_groove(rule, theta, index, slope.t, at.x, at.sin_phi);
      OrderFactors weights;
      for (int g = 0; g < DOLP_WIDTH; ++g) weights.value[g] = at.weight * factors.value[g];
      for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) {
        sums.member[g] += weights.value[g].x * light.moments;
        if (kHasOrders) sums.u[g].x += weights.value[g].y * (light.before_u + light.last_u);
      }
      sums = add_groove_columns(sums, weights, sky_at(slope.sky, light.cos_before), light.before, light.before_u);
      sums = add_groove_columns(sums, weights, sky_at(slope.sky, light.cos_last), light.last, light.last_u);
    } else {
      Facet f = facet(theta, index, slope.t, at.x, at.sin_phi);
      MaskingTerms masking_out = masking_of_ray(row, f.cos_r, sine_of_ray(theta, row, f, slope.t, at), slope.t, zone);
      ColumnValues values = column_values(rule, slope.sky, f.cos_beta, f.cos_r);
      real2 per_projection = column_factors(slope, f);
      for (int g = 0; g < DOLP_WIDTH; ++g) {
        Projection part = project(theta, f, zone, slope.masking_in.value[g], masking_out.value[g]);
        real turned = at.weight * factors.value[g].x;
        real leaving = leaves ? turned : real(0.0);
        sums.member[g] += leaving * reflected(f, part);
        real projection = leaving * part.visible;
        if (kColumns == DOLP_COLUMNS_DIRECT) projection = turned * seen_directly(theta, f);
        projection *= slope.weight[g];
        sums.columns[g] =
            add_columns(sums.columns[g], values, projection * per_projection.x, projection * per_projection.y);
        if (kHasOrders) {
          real tilted = at.weight * factors.value[g].y * f.m02;
          real reflected_u = leaves ? tilted * part.visible : real(0.0);
          sums.u[g] += real2(reflected_u, -tilted * seen_directly(theta, f));
          sums.columns[g] = add_u_columns(sums.columns[g], values, slope.weight[g] * reflected_u);
        }
      }
      for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) {
        if (kHasDirect) sums.direct[g] += at.weight * factors.value[g].x * emitted(theta, f);
      }
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

// The azimuth at which the local angle of incidence reaches a kink of measured reflectances.
real2 kink_line(ThetaNode theta, IndexNode index, Slope slope, int kink) {
  real t = slope.t;
  return line_at(cos_of_kink(index, kink) * sqrt(real(1.0) + t * t) - theta.c, max(theta.s * t, real(1e-30)));
}

// Sums over the azimuths from 0 to pi. Split lines divide the azimuths into zones. The line at which total reflection
// begins divides a zone into two arcs. Corners (kinks) of a sky and kinks of measured reflectances divide the arcs
// further; both are in ascending order of the azimuth.
AzimuthSums azimuth_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Slope slope, SplitLines lines,
                         Columns columns[DOLP_WIDTH]) {
  AzimuthSums sums = no_azimuths(columns);
  bool is_critical = kTotalReflection && index.critical_cos > real(0.0);
  int kinks = row_kinks(index);
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
    int passed = 0;  // kinks before `start`
    for (int split = 0; split <= slope.sky.corners + kinks; ++split) {
      int corner = split - passed;
      real2 stop = to;
      if (corner < slope.sky.corners) stop = clamp_half_angle(corner_line(theta, slope, corner), start, to);
      if (kHasCurves && passed < kinks) {
        real2 at_kink = clamp_half_angle(kink_line(theta, index, slope, passed), start, to);
        bool is_next = corner >= slope.sky.corners || is_before(at_kink, stop);
        stop = is_next ? at_kink : stop;
        passed += is_next ? 1 : 0;
      }
      // A loop of one turn is faster than an `if`: in lockstep, devices run both branches of an `if`, but skip a loop.
      for (bool run_once = is_before(start, stop); run_once; run_once = false) {
        bool is_first = !is_before(from, start);
        Arc arc = masked_arc(rule, row.shape[0], slope, make_arc(start, stop), zone, is_first);
        if (kTotalReflection) {
          bool is_last = !is_before(stop, to);
          bool is_beside = is_second ? is_first : is_last;
          is_beside = is_critical && is_beside;
          arc = critical_arc(theta, index, slope, arc, !is_second, is_beside);
        }
        real nodes = arc_nodes(rule, theta, row.shape[0], index, slope, arc, zone);
        // The nodes that resolve cos(2 k phi) are in both rules. Without them the coarser rule would say nothing.
        real highest = real(slope.order + DOLP_ORDER_WIDTH - 1);
        int resolving = kHasOrders ? int(ceil(real(DOLP_NODES_OF_ORDER) * highest * arc.span)) : 0;
        int order = order_between(nodes, max(slope.most_azimuths - resolving, 1));
        if (slope.is_coarse) order = coarse_order(order);
        if (kHasOrders) order = min(order + resolving, slope.most_azimuths - (slope.is_coarse ? 1 : 0));
        AzimuthSums more = arc_sums(rule, theta, row, index, slope, arc, zone, zone < lines.leaving, order,
                                    sums.columns);
        for (int g = 0; g < DOLP_WIDTH; ++g) {
          sums.member[g] += more.member[g];
          sums.columns[g] = more.columns[g];
        }
        for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) {
          sums.direct[g] += more.direct[g];
          sums.u[g] += more.u[g];
        }
        sums.evaluations += more.evaluations;
      }
      start = stop;
    }
  }
  return sums;
}

// Integral of e cos(2 k phi) over the facets of order k > 0 that reflect below the horizon, at the half angle `horizon`.
real below_horizon(ThetaNode theta, real t, int order, real2 horizon) {
  real2 at = real2(cosine(horizon), real(2.0) * horizon.x * horizon.y);
  real2 turn = order_factors(order, at);
  real k2 = real(2 * order);
  real after = (turn.y * at.x + turn.x * at.y) / (k2 + real(1.0));   // sin((2 k + 1) phi) / (2 k + 1)
  real before = (turn.y * at.x - turn.x * at.y) / (k2 - real(1.0));
  return -theta.c * turn.y / k2 - real(0.5) * theta.s * t * (after + before);
}

// Sums over all facets of slope t. With single scattering, the deficit (light that does not leave the surface) includes
// the projection e of each facet that reflects below the horizon, even if e < 0. With all bounces every ray leaves.
AzimuthSums slope_sums(RuleNode rule, ThetaNode theta, Row row, IndexNode index, Slope slope,
                       Columns columns[DOLP_WIDTH]) {
  SplitLines lines = split_lines(rule, theta, index, slope.t, slope.has_split_line, slope.digits);
  slope.singular = singularities_at(theta, row.shape[0], index, slope);
  AzimuthSums sums = azimuth_sums(rule, theta, row, index, slope, lines, columns);
  if (!kIsMultiple) {
    sums.behind = real(2.0) * theta.s * slope.t * lines.horizon.x * lines.horizon.y;
    real below = theta.c * real(4.0) * atan_unit(lines.horizon.x / (real(1.0) + lines.horizon.y));
    for (int g = 0; g < DOLP_WIDTH; ++g) {
      int k = kHasOrders ? slope.order + g : 0;
      sums.member[g].w += (k > 0) ? below_horizon(theta, slope.t, k, lines.horizon) : below - sums.behind;
    }
  }
  return sums;
}

// The sums for each azimuthal order that the invocation computes; without orders, for one entry.
struct SlopeResult {
  AzimuthNode node[DOLP_ORDER_WIDTH];
  Columns columns[DOLP_ORDER_WIDTH];
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
  slope.order = int(slope_node.order);
  slope.sky = sky_place();
  Columns columns[DOLP_WIDTH];
  for (int g = 0; g < DOLP_WIDTH; ++g) {
    slope.weight[g] = real(1.0);
    columns[g] = no_columns();
  }
  AzimuthSums sums = slope_sums(rule, theta, no_row(), index, slope, columns);
  SlopeResult result;
  for (int g = 0; g < DOLP_ORDER_WIDTH; ++g) {
    real4 all = sums.member[g];
    result.node[g] = AzimuthNode(all.x, all.y, all.z, all.w, sums.behind, sums.direct[g].x, sums.direct[g].y, sums.u[g].x,
                                 sums.u[g].y, (g == 0) ? sums.evaluations : real(0.0));
    result.columns[g] = sums.columns[g];
  }
  return result;
}
