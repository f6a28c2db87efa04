#pragma once

#include <cstddef>
#include <vector>

#include "model/choices.hpp"

namespace dolp {

struct SlopeShape {
  double sigma = 0.0;
  double q = 2.0;  ///< ignored by the gaussian
  /// Slopes that differ along and across: the width is `sigma` along the x axis of the surface and `sigma_cross` along
  /// its y axis. 0 means sigma.
  double sigma_cross = 0.0;
  double azimuth_deg = 0.0;  ///< from the viewer's horizontal direction to the x axis, counter-clockwise from above
  friend bool operator==(const SlopeShape&, const SlopeShape&) = default;
};

double slope_width(const SlopeShape& shape);  ///< m = sqrt(2) sigma, the unit of slopes

bool is_elliptic(const SlopeShape& shape);     ///< true if the widths along and across differ
double widest_sigma(const SlopeShape& shape);  ///< larger one of the widths along and across
double narrowest_sigma(const SlopeShape& shape);
SlopeShape mean_isotropic(const SlopeShape& shape);  ///< with as many facets near the mean normal
double eccentricity(const SlopeShape& shape);        ///< |sigma - sigma_cross| / (sigma + sigma_cross)
/// Isotropic, with the same slopes in the vertical plane through the viewer.
SlopeShape in_view_plane(const SlopeShape& shape);

/// The facets of an elliptic distribution whose slopes point to one azimuth. They are distributed like the facets of an
/// isotropic distribution of the width `sigma`.
struct SlopeSector {
  double sigma = 0.0;
  double azimuth = 0.0;  ///< from the x axis of the surface, in radians
  double share = 1.0;    ///< of the facets; all shares add up to 1
};

/// Sectors of equal angles in a quarter turn. A sum over all sectors, in all four quarters, replaces an integral over
/// the azimuths of an elliptic distribution. For an integrand cos(2 k azimuth) times the density, the error is at most
/// 2 e^(2 count - k) of the facets, with the eccentricity e.
/// Equation: at the azimuth a, P is sigma_a^2 / (sigma sigma_cross) times the isotropic density of the width sigma_a,
/// with 1 / sigma_a^2 = cos^2(a) / sigma^2 + sin^2(a) / sigma_cross^2.
std::vector<SlopeSector> slope_sectors(const SlopeShape& shape, std::size_t count);

/// Slope width sigma of the sea in a wind of U m/s.
/// Equation: the mean square slope, summed over both horizontal directions, is 2 sigma^2 = 0.003 + 0.00512 U.
/// Source: Cox and Munk, J. Opt. Soc. Am. 44 (1954) 838: clean sea, U from 1 to 14 m/s, 12.5 m above the water.
double sigma_of_wind(double wind_m_s);
double wind_of_sigma(double sigma);

/// Slope widths of the sea along and across the wind.
/// Equation: sigma^2 = 0.00316 U along and 0.003 + 0.00192 U across. Source: as sigma_of_wind().
double sigma_along_wind(double wind_m_s);
double sigma_across_wind(double sigma_along);

/// The width sigma by either model: sigma_of_wind() or sigma_along_wind().
double sigma_in_wind(double wind_m_s, WindModel model);

/// What a scene says about slopes that differ along and across.
struct CrossSlopes {
  double sigma_cross = 0.0;                      ///< SlopeShape::sigma_cross
  double azimuth_deg = 0.0;                      ///< SlopeShape::azimuth_deg
  WindModel wind_model = WindModel::kIsotropic;  ///< directional: the wind that gives sigma also gives sigma_cross
  SlopeShape shape(double sigma, double q) const;
};

/// Share of the facets that are steeper than a slope.
/// Equation: exp(-u^2) for the gaussian, (1 + u^2)^(1 - q) for the cauchy distribution, with u = slope / m.
/// Domain: slope >= 0. With sigma = 0 no facet is steeper. For an elliptic distribution it is the mean over its
/// sectors.
double steeper_share(Distribution distribution, const SlopeShape& shape, double slope);

/// ln(D / 4) at a slope. D is the density of the facet normals in 1/sr, and the pBRDF contains D / 4. `azimuth`: of the
/// normal from the viewer's horizontal direction, in radians; only an elliptic distribution depends on it.
/// Domain: sigma > 0; the cauchy distribution needs q > 1.
double log_density(Distribution distribution, const SlopeShape& shape, double slope, double azimuth);

/// The slope u, in units of m, beyond which the power law (1 + u^2)^-exponent is less than `share`.
/// Domain: share in (0, 1], exponent > 0. The result is finite even for a tiny exponent.
double power_law_reach(double share, double exponent);

/// Gamma(x + 1/2) / Gamma(x) with an error of a few roundings. Domain: x > 0 of any size.
double gamma_ratio(double x);

}  // namespace dolp
