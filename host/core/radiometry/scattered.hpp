#pragma once

namespace dolp {

/// Unpolarised light scattered from one direction into another: the first column of f_s cos(theta_i) cos(theta_r) for
/// k_s = 1.
///
/// Units: sr-1.
struct Scattered {
  double i = 0.0;
  double q = 0.0;
  double u = 0.0;
  double v = 0.0;
  double error = 0.0;  ///< bound of the absolute error of each one
};

}  // namespace dolp
