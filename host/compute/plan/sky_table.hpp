#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/sky_basis.hpp"

namespace dolp {

/// Tables of the functions of a SkyBasis. Each table is a straight line in each of its cells, which have equal widths
/// in the variable u = sqrt(1 - cos(zenith)).
struct SkyTable {
  std::uint32_t count = 0;
  std::uint32_t log2_cells = 0;     ///< log2 of the number of cells of each function
  std::uint32_t corners = 0;        ///< number of corners (kinks of a function) at which azimuths are split
  std::uint32_t start = 0;          ///< position of the first cell in the `nodes` of append_sky()
  bool has_cusp = false;            ///< a function has a cusp at the zenith
  std::vector<double> corners_deg;  ///< zeniths of the corners at which azimuths are split, the sharpest first
  std::vector<double> error;        ///< for each function: bound of its difference from its table
  std::vector<double> bends;        ///< for each function f: jumps of df/du at unsplit corners, added in quadrature
  std::vector<double> steepness;  ///< for each function f: |df/du| at the zenith, where rounding errors of u are large

  /// start, corners and log2_cells in one word, the member `sky` of DOLP_PUSH_CONSTANTS (interface.glsl)
  std::uint32_t word() const;
};

struct SkyTolerances {
  double integral;  ///< of the moments; decides how many corners split the azimuths
  double table;     ///< decides how many cells a table has
};

/// Appends to `nodes` as many cells as the tolerance needs, up to a limit. If `splits`, the kernel splits the azimuths
/// at the sharpest corners. The cosines of the zeniths of these corners then follow the cells in `nodes`.
SkyTable append_sky(const SkyBasis& basis, const SkyTolerances& tolerances, bool splits,
                    std::vector<std::array<double, 2>>& nodes);

}  // namespace dolp
