// Moments with functions g of the zenith of the reflected ray, |g| <= 1: what a sky that changes with the zenith adds to
// its mean (README.md beside this file, section 11).
//
// A function is a table over u = sqrt(1 - cos(theta_r)) = sqrt(2) sin(theta_r / 2), in which corners at the zenith are
// corners too: straight lines in cells of one width, (value at the start, change over the cell), behind the nodes of the
// rules. host/compute/plan/sky_table.cpp fills it.

// The tables among the rule nodes: read once, because devices read push constants again in each turn of a loop.
struct SkyPlace {
  int cells;  // of a function
  int start;  // of the first cell
  int corners;
};

#if DOLP_MOST_SKY > 0
struct SkyValues {
  real g[DOLP_MOST_SKY];
};

struct SkySums {
  real i[DOLP_MOST_SKY];
  real q[DOLP_MOST_SKY];
};

SkySums no_sky() {
  SkySums sums;
  for (int k = 0; k < DOLP_MOST_SKY; ++k) {
    sums.i[k] = real(0.0);
    sums.q[k] = real(0.0);
  }
  return sums;
}

SkyValues sky_at(SkyPlace table, real cos_r) {
  int cells = table.cells;
  real place = sqrt(max(real(1.0) - cos_r, real(0.0))) * real(cells);
  int cell = min(int(place), cells - 1);
  real within = place - real(cell);
  SkyValues sky;
  for (int k = 0; k < DOLP_MOST_SKY; ++k) {
    sky.g[k] = real(0.0);
    if (k < int(kSkyCount)) {
      real2 node = rule_node(table.start + k * cells + cell);
      sky.g[k] = node.x + within * node.y;
    }
  }
  return sky;
}

SkySums add_reflected(SkySums sums, SkyValues sky, real r_i, real r_q) {
  for (int k = 0; k < DOLP_MOST_SKY; ++k) {
    if (k < int(kSkyCount)) {
      sums.i[k] += r_i * sky.g[k];
      sums.q[k] += r_q * sky.g[k];
    }
  }
  return sums;
}

SkySums add_scaled(SkySums sums, real factor, SkySums more) {
  for (int k = 0; k < DOLP_MOST_SKY; ++k) {
    if (k < int(kSkyCount)) {
      sums.i[k] += factor * more.i[k];
      sums.q[k] += factor * more.q[k];
    }
  }
  return sums;
}
SkyPlace sky_place() { return SkyPlace(sky_cells(), sky_start(), pushed_corners()); }

// cos(theta_r) of a corner, which splits the azimuths; they ascend in the zenith.
real cos_of_corner(SkyPlace table, int i) { return rule_node(table.start + int(kSkyCount) * table.cells + i).x; }
#else
struct SkyValues {
  real none;
};

struct SkySums {
  real none;
};

SkySums no_sky() { return SkySums(real(0.0)); }
SkyPlace sky_place() { return SkyPlace(1, 0, 0); }
SkyValues sky_at(SkyPlace, real) { return SkyValues(real(0.0)); }
real cos_of_corner(SkyPlace, int) { return real(0.0); }
SkySums add_reflected(SkySums sums, SkyValues, real, real) { return sums; }
SkySums add_scaled(SkySums sums, real, SkySums) { return sums; }
#endif
