// A method of the benchmark: one way to compute the moments r_i and r_q. A number, the setting, controls its accuracy.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/moments.hpp"

namespace dolp::bench {

/// The two moments of one entry (Moments::r_i and r_q), and the error that the method states for them.
struct Answer {
  double r_i = 0.0;
  double r_q = 0.0;
  /// bound or estimate of max(|d r_i|, |d r_q|)/r_i, where d r_i and d r_q are the errors; empty if the method states
  /// none
  std::optional<double> stated_error;
};

/// The result of one call of a solver.
struct Solution {
  std::vector<Answer> answers = {};        ///< one per entry of the request, in its order
  std::optional<double> evaluations = {};  ///< integrand evaluations of the whole call
  std::optional<double> kernel_s = {};     ///< time in kernels and in sums of their results; empty without kernels
  std::vector<double> own_times_s = {};    ///< times of repeated calls, if the method measures them itself
};

/// A method that is ready to run. The constructor creates what is needed once (a device, an interpreter) and is not
/// timed. `solve` creates what each entry needs (nodes, masking tables) and is timed.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Computes every entry of the request. Ignores the tolerance of the request: `setting` controls the accuracy.
  virtual Solution solve(const MomentsRequest& request, double setting) = 0;
  /// The device, processor or interpreter that runs the method, with versions.
  virtual std::string where() const = 0;
};

/// The method cannot run here, or not at this setting; the message is the reason.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The method was stopped at its time limit. Finer settings are not worth trying.
struct TookTooLong : Unavailable {
  using Unavailable::Unavailable;
};

struct SolverOptions {
  std::string device = {};     ///< Vulkan device: position or part of the name, empty for the default
  double time_limit_s = 20.0;  ///< longest time of one call; for dblquad, of one entry
  std::vector<std::string> pythons = {"/usr/bin/python3", "python3"};  ///< tried in turn until one has SciPy
};

/// Description of a method.
struct Method {
  std::string name;                    ///< name on the command line and in results
  std::string label;                   ///< name in figures and tables
  std::string what;                    ///< one sentence: rule, coordinates, language
  std::string cores;                   ///< "1", or "all" for methods that use every core
  std::string setting_name;            ///< quantity in `settings`: nodes, samples, tolerance
  std::vector<double> settings;        ///< settings to measure, from coarse to fine
  std::vector<double> quick_settings;  ///< the subset that --quick runs
  /// True if one call computes many entries. The time per entry is then the mean over the entries of the call.
  bool is_batched = false;
  bool is_random = false;  ///< answers differ from call to call; the error is the rms over the calls
  /// Creates the solver. Errors: Unavailable.
  std::function<std::unique_ptr<Solver>(const SolverOptions&)> make;
};

/// All methods, in the order of tables and legends.
const std::vector<Method>& methods();

// The solvers, one family per file.
std::unique_ptr<Solver> make_midpoint_rule();
std::unique_ptr<Solver> make_gauss_rule();
/// Both product rules on a Vulkan device. Errors: Unavailable if there is no usable device.
std::unique_ptr<Solver> make_vulkan_midpoint(const SolverOptions& options);
std::unique_ptr<Solver> make_vulkan_gauss(const SolverOptions& options);
std::unique_ptr<Solver> make_monte_carlo();
std::unique_ptr<Solver> make_hcubature();
std::unique_ptr<Solver> make_pcubature();
/// Errors: Unavailable without an interpreter that has SciPy.
std::unique_ptr<Solver> make_dblquad(const SolverOptions& options);
/// Errors: Unavailable if no device supports `precision`.
std::unique_ptr<Solver> make_vulkan(const SolverOptions& options, Precision precision);
std::unique_ptr<Solver> make_cpu(Precision precision);

}  // namespace dolp::bench
