// Columns are sums over the facets. They have other integrands than r_i and r_q. A column is of one of two kinds:
//   sky: the integrand of r_i or r_q times a function g of the zenith theta_r of the reflected ray, |g| <= 1. These
//     columns are needed for a sky that changes with the zenith (README.md beside this file, section 11).
//   response: Chebyshev polynomials of the angle of incidence replace the reflectances in the integrand. The moments of
//     any index are weighted sums of responses (section 8). There are responses of the reflected light, of the
//     reflected light times one function g, and of the direct emission.
// A function g is stored as straight lines over u = sqrt(1 - cos(theta_r)), in cells of equal width. A cell stores the
// value at its start and the change over the cell (host/compute/plan/sky_table.cpp).

// Copies of push constants about the tables of a sky: devices would read push constants again in each turn of a loop.
struct SkyPlace {
  int cells;    // number of cells of each function's table
  int start;    // position of the first cell
  int corners;  // number of zeniths at which the sky has a corner (kink)
};

#if DOLP_MOST_COLUMNS > 0
struct ColumnValues {
  real f[DOLP_MOST_COLUMNS];
};

// Sums for each column function f: `i` corresponds to r_i, `q` to r_q and, with azimuthal orders, `u` to r_u.
struct Columns {
  real i[DOLP_MOST_COLUMNS];
  real q[DOLP_MOST_COLUMNS];
  real u[DOLP_MOST_COLUMNS];
};

Columns no_columns() {
  Columns sums;
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    sums.i[k] = real(0.0);
    sums.q[k] = real(0.0);
    sums.u[k] = real(0.0);
  }
  return sums;
}

real sky_function(SkyPlace table, int k, real cos_r) {
  int cells = table.cells;
  real position = sqrt(max(real(1.0) - cos_r, real(0.0))) * real(cells);
  int cell = min(int(position), cells - 1);
  real2 node = table_node(table.start + k * cells + cell);
  return node.x + (position - real(cell)) * node.y;
}

ColumnValues sky_at(SkyPlace table, real cos_r) {
  ColumnValues values;
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    values.f[k] = real(0.0);
    if (k < int(kColumnCount)) values.f[k] = sky_function(table, k, cos_r);
  }
  return values;
}

// Chebyshev polynomials T_k(2 asinh(c / c0) / asinh(1 / c0) - 1), with c = cos(beta) and c0 = 1 / response_scale.
ColumnValues chebyshev_at(RuleNode rule, real cos_beta) {
  real x = asinh_real(cos_beta * rule.response_scale) * rule.response_norm - real(1.0);
  ColumnValues values;
  values.f[0] = real(1.0);
  values.f[1] = x;
  for (int k = 2; k < DOLP_MOST_COLUMNS; ++k) {
    values.f[k] = real(0.0);
    if (k < int(kColumnCount)) values.f[k] = real(2.0) * x * values.f[k - 1] - values.f[k - 2];
  }
  return values;
}

ColumnValues column_values(RuleNode rule, SkyPlace table, real cos_beta, real cos_r) {
  if (kColumns == DOLP_COLUMNS_SKY) return sky_at(table, cos_r);
  return chebyshev_at(rule, cos_beta);
}

Columns add_columns(Columns sums, ColumnValues values, real i, real q) {
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    if (k < int(kColumnCount)) {
      sums.i[k] += i * values.f[k];
      sums.q[k] += q * values.f[k];
    }
  }
  return sums;
}

Columns add_u_columns(Columns sums, ColumnValues values, real u) {
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    if (k < int(kColumnCount)) sums.u[k] += u * values.f[k];
  }
  return sums;
}

Columns scaled_columns(Columns sums, real factor) {
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    if (k < int(kColumnCount)) {
      sums.i[k] *= factor;
      sums.q[k] *= factor;
    }
  }
  return sums;
}

void store_azimuth_columns(int member, Columns sums) {
  uint each = kHasOrders ? 3u : 2u;
  uint first = uint(member) * each * kColumnCount;
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    if (k < int(kColumnCount)) {
      store_column(first + each * uint(k), sums.i[k]);
      store_column(first + each * uint(k) + 1u, sums.q[k]);
      if (kHasOrders) store_column(first + each * uint(k) + 2u, sums.u[k]);
    }
  }
}

void store_columns(int member, bool is_coarse, Columns sums) {
  uint first = uint(member) * kColumnCount * DOLP_COLUMN_PARTS + (is_coarse ? 0u : 2u);
  for (int k = 0; k < DOLP_MOST_COLUMNS; ++k) {
    if (k < int(kColumnCount)) {
      store_column(first + uint(DOLP_COLUMN_PARTS * k), sums.i[k]);
      store_column(first + uint(DOLP_COLUMN_PARTS * k + 1), sums.q[k]);
    }
  }
}

SkyPlace sky_place() { return SkyPlace(sky_cells(), sky_start(), pushed_corners()); }

// cos(theta_r) at corner i of the sky. Corners are in ascending order of the zenith.
real cos_of_corner(SkyPlace table, int i) { return table_node(table.start + sky_functions() * table.cells + i).x; }
#else
struct ColumnValues {
  real none;
};

struct Columns {
  real none;
};

Columns no_columns() { return Columns(real(0.0)); }
SkyPlace sky_place() { return SkyPlace(1, 0, 0); }
real sky_function(SkyPlace, int, real) { return real(0.0); }
ColumnValues sky_at(SkyPlace, real) { return ColumnValues(real(0.0)); }
ColumnValues column_values(RuleNode, SkyPlace, real, real) { return ColumnValues(real(0.0)); }
real cos_of_corner(SkyPlace, int) { return real(0.0); }
Columns add_columns(Columns sums, ColumnValues, real, real) { return sums; }
Columns add_u_columns(Columns sums, ColumnValues, real) { return sums; }
Columns scaled_columns(Columns sums, real) { return sums; }
void store_columns(int, bool, Columns) {}
void store_azimuth_columns(int, Columns) {}
#endif
