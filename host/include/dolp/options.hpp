// Options of evaluators, runs and checks, and columns of points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <dolp/errors.hpp>

namespace dolp {

/// A column of points. Its name is the one in CSV files: theta_deg, sigma, q, n, k, wavelength_um; for Mueller matrices
/// theta_i_deg, theta_r_deg, delta_phi_deg.
struct Column {
  std::string name;
  std::span<const double> values;  ///< one per point, or one for all
};

/// The 4 x 4 Mueller pBRDF of a pair of directions, row by row. Units: 1/sr.
using MuellerMatrix = std::array<double, 16>;

/// Evaluator, device and dispatch options.
struct EvaluatorOptions {
  std::string evaluator = "vulkan";  ///< vulkan; cpu: the kernel source compiled as C++; reference: adaptive quadrature
  /// for vulkan: position in devices(), or a part of the name; empty: the best device
  std::string device = {};
  /// dispatches are short: a call ends soon after Progress returns false, and a window on the device continues to draw
  bool is_interactive = false;
};

/// Options for one table or list of points.
struct RunOptions {
  bool keep_all = false;     ///< drop no effect, however small
  Progress progress = {};    ///< may be empty
  std::string history = {};  ///< text for the attribute "history" of a table, besides the time
  bool resume = false;       ///< for write_table: continues a cancelled or killed call of the same scene
};

/// One of `count` equal parts of a table that several processes compute. The default is the whole table.
struct Shard {
  std::size_t number = 0;  ///< from 1 to count
  std::size_t count = 0;
  bool is_none() const { return number == 0 && count == 0; }
};

/// Options for the check of a table.
struct TableCheckOptions {
  std::size_t samples = 64;  ///< number of different entries to compute again; all if the table has fewer
  std::uint64_t seed = 1;    ///< seed for the choice of entries
  bool named_files = false;  ///< reads n, k and E0 from the files that the scene names instead of from the table
  Progress progress = {};    ///< may be empty
};

/// Options for the check of a device.
struct DeviceCheckOptions {
  std::string evaluator = "vulkan";  ///< vulkan; cpu: the kernel source compiled as C++
  std::string device = {};           ///< same meaning as in EvaluatorOptions
  std::string precision = "auto";    ///< float, double; auto is both
  double tolerance = 1e-4;           ///< requested tolerance
  bool all = false;                  ///< report every case, not only those that fail
  Progress progress = {};            ///< may be empty
};

}  // namespace dolp
