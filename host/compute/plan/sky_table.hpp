#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/sky_basis.hpp"

namespace dolp {

/// The functions of a basis over u = sqrt(1 - cos(zenith)), as straight lines in cells of equal width.
struct SkyTable {
  std::uint32_t count = 0;
  std::uint32_t log2_cells = 0;     ///< log2 of the cells of each function
  std::uint32_t corners = 0;        ///< corners (kinks) that split the azimuths; their cosines follow the cells
  std::uint32_t start = 0;          ///< position of the first cell among the rule nodes
  bool has_cusp = false;            ///< a function has a cusp at the zenith
  std::vector<double> corners_deg;  ///< zeniths of the corners that split, the sharpest first
  std::vector<double> error;        ///< bound of the difference between each function and its table
  /// For each function: root of the sum of its squared jumps of the derivative, at corners that split no azimuths.
  std::vector<double> bends;
  std::vector<double> steepness;  ///< largest slope of each function in u at the zenith, where 1 - cos loses digits

  /// start, corners and log2_cells in one word, the member `sky` of DOLP_PUSH_CONSTANTS (interface.glsl)
  std::uint32_t word() const;
};

/// Appends as many cells to `nodes` as the tolerance needs, up to kMostSkyCells or kMostTightSkyCells. If `splits`,
/// also appends the cosines of the sharpest corners (kinks), at which the azimuths are to be split.
SkyTable append_sky(const SkyBasis& basis, double tolerance, bool splits, std::vector<std::array<double, 2>>& nodes);

}  // namespace dolp
