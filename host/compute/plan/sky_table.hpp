// The functions of a sky as the kernels read them (shaders/physics/columns.glsl).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/sky_basis.hpp"

namespace dolp {

/// Tables of the functions of a basis over u = sqrt(1 - cos(zenith)), straight lines between equal steps.
struct SkyTable {
  std::uint32_t count = 0;          ///< of functions
  std::uint32_t log2_cells = 0;     ///< of each
  std::uint32_t corners = 0;        ///< that split the azimuths; their cosines follow the cells
  std::uint32_t start = 0;          ///< position of the first cell among the rule nodes
  bool has_cusp = false;            ///< at the zenith
  std::vector<double> corners_deg;  ///< the same, the sharpest first
  std::vector<double> error;        ///< bound of the distance from each function
  std::vector<double> bends;      ///< of each function, the root of the sum of squares of its other corners' bends in u
  std::vector<double> steepness;  ///< largest slope of each function in u at the zenith, where 1 - cos loses its digits

  /// DOLP_PUSH_CONSTANTS.
  std::uint32_t word() const;
};

/// Appends the cells of the basis to the nodes of the rules: as many as the tolerance asks for, up to 2^15 in all, for
/// tight tolerances up to 2^18; with `splits` the cosines of the sharpest corners, too. Corners of a sky are corners of
/// its table but for the cell in which they lie.
SkyTable append_sky(const SkyBasis& basis, double tolerance, bool splits, std::vector<std::array<double, 2>>& nodes);

}  // namespace dolp
