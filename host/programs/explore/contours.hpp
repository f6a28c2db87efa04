// Lines of equal value in a map.
#pragma once

#include <vector>

#include "explore/heat_map.hpp"

namespace dolp::explore {

/// A piece of a line; positions from 0 to 1 along both axes of the map.
struct Segment {
  double x0, y0, x1, y1;
};

/// The lines where a field has `level`, by marching squares with linear interpolation. Squares with a corner that is
/// not good have none.
std::vector<Segment> contour(const MapField& field, double level);

/// The levels of a field's contour lines: round values, seven at most.
std::vector<double> contour_levels(double low, double high, bool is_log);

}  // namespace dolp::explore
