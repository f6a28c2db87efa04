// The functions of a sky as the kernels read them (shaders/physics/columns.glsl).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/sky_basis.hpp"

namespace dolp {

/// Tables of the functions of a basis over u = sqrt(1 - cos(zenith)): straight lines in cells of equal width.
struct SkyTable {
  std::uint32_t count = 0;          ///< number of functions
  std::uint32_t log2_cells = 0;     ///< log2 of the cells of each function
  std::uint32_t corners = 0;        ///< corners that split the azimuths; their cosines follow the cells
  std::uint32_t start = 0;          ///< position of the first cell among the rule nodes
  bool has_cusp = false;            ///< a function has a cusp at the zenith
  std::vector<double> corners_deg;  ///< zeniths of these corners, the sharpest first
  std::vector<double> error;        ///< bound of the table's distance from each function
  /// for each function: root of the sum of squares of its changes of slope in u, at the corners that do not split
  std::vector<double> bends;
  std::vector<double> steepness;  ///< largest slope of each function in u at the zenith, where 1 - cos loses digits

  /// The member `sky` of DOLP_PUSH_CONSTANTS (interface.glsl).
  std::uint32_t word() const;
};

/// Appends the cells of the basis to the nodes of the rules: as many as the tolerance needs, up to 2^15, for tight
/// tolerances up to 2^18. If `splits` is true, also appends the cosines of the sharpest corners. A corner of the sky is
/// rounded off only in the cell that contains it.
SkyTable append_sky(const SkyBasis& basis, double tolerance, bool splits, std::vector<std::array<double, 2>>& nodes);

}  // namespace dolp
