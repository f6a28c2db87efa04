#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <dolp/errors.hpp>

namespace dolp {

/// Values of one variable at a list of points. `name` is the name of the column in CSV files of points: theta_deg,
/// sigma, q, n, k, wavelength_um, ... For Mueller matrices: theta_i_deg, theta_r_deg, delta_phi_deg, sigma, q, n, k.
struct Column {
  std::string name;
  std::span<const double> values;  ///< one value per point, or one value for all points
};

/// The 4 x 4 Mueller matrix of the pBRDF for a pair of directions, row by row. Units: 1/sr.
using MuellerMatrix = std::array<double, 16>;

struct EvaluatorOptions {
  std::string evaluator = "vulkan";  ///< vulkan, cpu (kernel source compiled as C++) or reference (adaptive quadrature)
  /// For the evaluator "vulkan": position in devices(), or a part of the name of a device. Empty means the best device.
  std::string device = {};
  /// Splits work on the GPU into short dispatches. Then a cancelled call ends soon, and other programs can draw, too.
  bool is_interactive = false;
};

struct RunOptions {
  bool keep_all = false;     ///< compute all effects, even negligible ones
  Progress progress = {};    ///< may be empty
  std::string history = {};  ///< text that follows the time in the attribute "history" of a table
  bool resume = false;       ///< for write_table: continue a cancelled or killed call for the same scene
  /// The variables of a table, such as "dolp" and "status". Empty means all. Axes and attributes are always there.
  std::vector<std::string> quantities = {};
  /// Keys of numbers, such as "surface.n", and "grid.theta_deg". Results then have derivatives by these numbers.
  std::vector<std::string> derivatives = {};
};

/// A part of a table, for one of several processes. The `count` parts have about the same size. Default: whole table.
struct Shard {
  std::size_t number = 0;  ///< number of this part, from 1 to count
  std::size_t count = 0;
  bool is_none() const { return number == 0 && count == 0; }
};

struct TableCheckOptions {
  std::size_t samples = 64;  ///< number of entries to compute again; all entries if the table has fewer
  std::uint64_t seed = 1;    ///< seed for the choice of entries
  bool named_files = false;  ///< read n, k and irradiance from the files that the scene names, not from the table
  Progress progress = {};    ///< may be empty
};

/// Options of verify_between().
struct BetweenOptions {
  std::size_t points = 1000;                 ///< number of random points
  std::uint64_t seed = 1;                    ///< seed of the points
  std::vector<std::string> quantities = {};  ///< names of quantities of the table; empty: dolp
  Progress progress = {};                    ///< may be empty
};

struct DeviceCheckOptions {
  std::string evaluator = "vulkan";  ///< vulkan, or cpu (kernel source compiled as C++)
  std::string device = {};           ///< same meaning as in EvaluatorOptions
  std::string precision = "auto";    ///< float, double, or auto, which checks both
  double tolerance = 1e-4;           ///< tolerance for DOLP and rho of the computed cases
  bool all = false;                  ///< report every case, not only the cases that fail
  Progress progress = {};            ///< may be empty
};

}  // namespace dolp
