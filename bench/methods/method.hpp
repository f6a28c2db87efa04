// A method of the benchmark: one way to compute the moments r_i and r_q of entries, at a setting of its own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/moments.hpp"

namespace dolp::bench {

/// The two moments of one entry (Moments::r_i and r_q), and the error the method itself states for them.
struct Answer {
  double r_i = 0.0;
  double r_q = 0.0;
  std::optional<double> stated_error;  ///< bound or estimate of max(|d r_i|, |d r_q|)/r_i, where the method gives one
};

/// The result of one call of a solver.
struct Solution {
  std::vector<Answer> answers = {};        ///< one for each entry of the request, in its order
  std::optional<double> evaluations = {};  ///< integrand evaluations of the whole call
  std::optional<double> kernel_s =
      {};  ///< time of the whole call in kernels and sums of their results, where the method has kernels
  std::vector<double> own_times_s = {};  ///< repeated times of the call, where only the method can take them
};

/// A method ready to run. Resources that it needs once (a device, an interpreter) are made with it and are not timed;
/// data that each entry needs (nodes, tables of its masking) belong to `solve`.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Computes every entry of the request, whose tolerance is ignored: `setting` controls the accuracy.
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
  double time_limit_s = 20.0;  ///< for one call of a method that may not end
  std::vector<std::string> pythons = {"/usr/bin/python3", "python3"};  ///< tried in turn for one that has SciPy
};

/// One row of the registry.
struct Method {
  std::string name;                    ///< as on the command line and in results
  std::string label;                   ///< for figures and tables
  std::string what;                    ///< one sentence: rule, coordinates, language
  std::string cores;                   ///< "1", or "all" for the evaluators of dolp
  std::string setting_name;            ///< what `settings` count: nodes, samples, tolerance
  std::vector<double> settings;        ///< from coarse to fine
  std::vector<double> quick_settings;  ///< the few of them that --quick runs
  bool is_batched = false;             ///< meant for many entries a call: its time is that of a call over its entries
  bool needs_grid = false;             ///< gains nothing from entries that are no grid
  bool is_random = false;              ///< every call gives other answers; its error is the rms of them
  /// Errors: Unavailable.
  std::function<std::unique_ptr<Solver>(const SolverOptions&)> make;
};

/// All methods, in the order of tables and legends.
const std::vector<Method>& methods();

// The solvers, one family a file.
std::unique_ptr<Solver> make_midpoint_rule();
std::unique_ptr<Solver> make_gauss_rule();
/// Errors: Unavailable when there is no usable device, of both.
std::unique_ptr<Solver> make_vulkan_midpoint(const SolverOptions& options);
std::unique_ptr<Solver> make_vulkan_gauss(const SolverOptions& options);
std::unique_ptr<Solver> make_monte_carlo();
std::unique_ptr<Solver> make_hcubature();
std::unique_ptr<Solver> make_pcubature();
/// Errors: Unavailable when no interpreter with SciPy is found.
std::unique_ptr<Solver> make_dblquad(const SolverOptions& options);
/// Errors: Unavailable when there is no usable device of this precision.
std::unique_ptr<Solver> make_vulkan(const SolverOptions& options, Precision precision);
/// The same in float, interpolated between slope distributions where the entries are dense.
std::unique_ptr<Solver> make_vulkan_table(const SolverOptions& options);
std::unique_ptr<Solver> make_cpu(Precision precision);
std::unique_ptr<Solver> make_native();

}  // namespace dolp::bench
