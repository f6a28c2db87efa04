// Points of curves and maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "explore/library.hpp"

namespace dolp::explore {

/// Points to compute: columns of one length, or the axes of a grid.
struct PointList {
  std::vector<double> theta_deg, sigma, q;
  std::vector<double> wavelength_um = {};  ///< of each point; empty: the scene's, as on a grid
  bool is_grid = false;                    ///< all combinations, q fastest: what they share is computed once

  std::size_t size() const;
  std::vector<Column> columns() const;
};

/// Errors: those of Evaluator.
Results evaluate(Evaluator& evaluator, const Scene& scene, const PointList& list, const RunOptions& options);

/// A point with what was computed there, in the units of a table; NaN where there is nothing.
struct Point {
  double theta_deg, sigma, q;
  double dolp, dolp_low, dolp_high, error_estimate;
  double stokes_i, stokes_q;
  double rho_i, rho_q, rho_error_estimate, albedo;
  std::uint32_t status;
};

std::vector<Point> points_of(const PointList& list, const Results& results);

/// True where status has none of the bits that make DOLP meaningless or void its promise.
bool is_good(const Point& point);

/// True where the point has limits between which DOLP lies with all bounces.
bool has_bracket(const Point& point);

/// Zeniths of a scene's surface.
PointList points_at(const Scene& scene, std::vector<double> theta_deg);

/// `count` zeniths from `from` to `to`, both included.
std::vector<double> zeniths(double from_deg, double to_deg, std::size_t count);

}  // namespace dolp::explore
