#pragma once

#include <array>
#include <complex>
#include <vector>

#include "model/facet_optics.hpp"

namespace dolp {

/// A table of R_s, 1 - R_s and (R_s - R_p) / sin^2(beta), in cells of equal width. A cell has a cubic for each
/// function. The variable is v = sqrt(cos(beta)) with films, and u = sqrt(1 - cos(beta)) for measured reflectances,
/// which are straight lines in beta between rows. DOLP_CURVE_NODES pairs of coefficients in `nodes` store a cell
/// (physics/fresnel.glsl). Measured reflectances have a kink at each row. So the cells are followed by a pair for each
/// cell: the place of a row in the cell (beyond its end if there is none), and the position in `nodes` of the cubics
/// beyond the row. These cubics come last.
struct ReflectanceCurve {
  std::vector<std::array<double, 2>> nodes;
  std::size_t cells = 0;
  double error = 0.0;      ///< bound of the errors of R_s, 1 - R_s and R_s - R_p that the cubics give
  double steepness = 0.0;  ///< largest 2 |df/dln(cos(beta))| of the three functions f; for the third, times sin^2(beta)
  std::complex<double> pole;  ///< complex cos(beta) of a pole; sets the numbers of nodes, see steepest_pole()
};

/// Kinks of measured reflectances, which are straight lines between rows. The size of a kink is how far the lines
/// beside a row differ from a smooth curve.
struct RowKinks {
  std::vector<double> split_deg;  ///< angles at which slopes and azimuths are split, the sharpest first
  double unsplit = 0.0;           ///< sizes of the other kinks, added in quadrature
};

/// The kinks of an index. At most `most` of them are split. Without measured reflectances, there are none.
RowKinks row_kinks(const FacetOptics& optics, double tolerance, std::size_t most);

/// Doubles the number of cells until the error is at most a share of the tolerance, or the number reaches its limit.
/// The tolerance is relative to reflectance_level(). Domain: optics that are not bare.
/// Accuracy: tests ReflectanceCurve_*.
ReflectanceCurve reflectance_curve(const FacetOptics& optics, double tolerance);

}  // namespace dolp
