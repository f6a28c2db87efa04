// Interface of the evaluators.
#pragma once

#include <cstdint>
#include <dolp/errors.hpp>
#include <string>
#include <vector>

#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

/// The cost of some evaluations.
struct Work {
  double evaluations = 0.0;  ///< number of evaluations of the integrand
  double kernel_s = 0.0;     ///< time on the device (timestamps), or of the loop on the CPU
  double sums_s = 0.0;       ///< time of the host for sums over slopes, and between slope distributions or indices
  std::uint64_t dispatches = 0;
  std::uint64_t interpolated = 0;         ///< moments that were interpolated or combined from others
  std::uint64_t interpolation_nodes = 0;  ///< moments from which these follow

  Work& operator+=(const Work& other) {
    evaluations += other.evaluations;
    kernel_s += other.kernel_s;
    sums_s += other.sums_s;
    dispatches += other.dispatches;
    interpolated += other.interpolated;
    interpolation_nodes += other.interpolation_nodes;
    return *this;
  }
};

/// Evaluator, device and cost of a run, for the report.
struct EvaluationReport : Work {
  std::string evaluator;           ///< vulkan | cpu | reference
  std::string device;              ///< device name, or the processor
  std::string driver;              ///< driver name and version; empty for cpu and reference
  std::string precision;           ///< float | double | float and double, as used
  std::uint32_t devices_lost = 0;  ///< devices lost and replaced by a new one
  double setup_s = 0.0;            ///< creation of pipelines, and of the device since clear_report
  double pipelines_s = 0.0;        ///< creation of pipelines only
};

/// Adds a precision to EvaluationReport::precision.
inline void note_precision(std::string& used, bool in_double) {
  const char* name = in_double ? "double" : "float";
  if (used.empty()) used = name;
  if (used != name) used = "float and double";
}

/// Computes the model's moments and matrices, in the order of the request's entries and in its precision.
class ModelEvaluator {
 public:
  virtual ~ModelEvaluator() = default;
  virtual std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) = 0;
  virtual std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) = 0;
  /// Announces a later call of `scatter` with this request; preparation may run in parallel with other calls until
  /// then.
  virtual void prepare(const ScatteringRequest& /*request*/) {}
  /// True if requests in double are possible.
  virtual bool has_double() const { return true; }
  /// True if each entry is to be computed by itself, without interpolation or responses.
  virtual bool computes_each_entry() const { return false; }
  /// Totals over all calls since clear_report.
  virtual EvaluationReport report() const = 0;
  /// Begins a new run: the report, and all that follows from it, no longer contains earlier runs.
  virtual void clear_report() {}
};

}  // namespace dolp
