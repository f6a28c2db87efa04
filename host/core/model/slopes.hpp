#pragma once

#include "model/choices.hpp"

namespace dolp {

struct SlopeShape {
  double sigma = 0.0;
  double q = 2.0;  ///< ignored by the gaussian
  friend bool operator==(const SlopeShape&, const SlopeShape&) = default;
};

double slope_width(const SlopeShape& shape);  ///< m = sqrt(2) sigma, the unit of slopes

/// Slope width sigma of the sea in a wind of U m/s.
/// Equation: the mean square slope, summed over both horizontal directions, is 2 sigma^2 = 0.003 + 0.00512 U.
/// Source: Cox and Munk, J. Opt. Soc. Am. 44 (1954) 838: clean sea, U from 1 to 14 m/s, 12.5 m above the water.
double sigma_of_wind(double wind_m_s);
double wind_of_sigma(double sigma);

/// Share of the facets that are steeper than a slope.
/// Equation: exp(-u^2) for the gaussian, (1 + u^2)^(1 - q) for the cauchy distribution, with u = slope / m.
/// Domain: slope >= 0. With sigma = 0 no facet is steeper.
double steeper_share(Distribution distribution, const SlopeShape& shape, double slope);

/// ln(D / 4) at a slope. D is the density of the facet normals in 1/sr, and the pBRDF contains D / 4.
/// Domain: sigma > 0; the cauchy distribution needs q > 1.
double log_density(Distribution distribution, const SlopeShape& shape, double slope);

/// The slope u, in units of m, beyond which the power law (1 + u^2)^-exponent is less than `share`.
/// Domain: share in (0, 1], exponent > 0. The result is finite even for a tiny exponent.
double power_law_reach(double share, double exponent);

/// Gamma(x + 1/2) / Gamma(x) with an error of a few roundings. Domain: x > 0 of any size.
double gamma_ratio(double x);

}  // namespace dolp
