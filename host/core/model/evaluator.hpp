#pragma once

#include <algorithm>
#include <cstdint>
#include <dolp/errors.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "model/transmission.hpp"

namespace dolp {

struct Work {
  double evaluations = 0.0;  ///< number of evaluations of the integrand
  double kernel_s = 0.0;     ///< time of the kernels, from timestamps of the device or from a clock on the CPU
  double sums_s = 0.0;       ///< host time to sum over slopes, and to add up responses (response_basis.hpp)
  double curves_s = 0.0;     ///< host time to compute tables of reflectances (plan/reflectance_curve.hpp)
  double beams_s = 0.0;      ///< host time to compute beams
  double transfer_s = 0.0;   ///< host time to make the other inputs of the kernels and to read their results
  std::uint64_t dispatches = 0;
  std::uint64_t interpolated = 0;         ///< entries with moments from interpolation or from responses
  std::uint64_t interpolation_nodes = 0;  ///< entries that a kernel integrates so that others can be interpolated

  Work& operator+=(const Work& other) {
    evaluations += other.evaluations;
    kernel_s += other.kernel_s;
    sums_s += other.sums_s;
    curves_s += other.curves_s;
    beams_s += other.beams_s;
    transfer_s += other.transfer_s;
    dispatches += other.dispatches;
    interpolated += other.interpolated;
    interpolation_nodes += other.interpolation_nodes;
    return *this;
  }
};

/// Relative errors of float operations, in units of 2^-23. This unit is the largest distance of two neighbouring
/// floats, relative to their size (1 ulp). The largest error of correct rounding is 0.5.
struct OperationErrors {
  double largest = 0.5;
  double mean = 0.0;  ///< far from 0 if most results err in one direction
};

struct Arithmetic {
  OperationErrors division;
  OperationErrors root;  ///< the square root
};

struct EvaluationReport : Work {
  std::string evaluator;                 ///< vulkan, cpu or reference
  std::string device;                    ///< name of the device, or of the processor
  std::string driver;                    ///< name and version of the driver; empty for cpu and reference
  std::string precision;                 ///< precision of the computations: float, double, or float and double
  std::optional<Arithmetic> arithmetic;  ///< of the device in float; empty if the errors were not measured
  std::uint32_t devices_lost = 0;        ///< devices lost and replaced by a new one
  double setup_s = 0.0;                  ///< time to create pipelines, plus the time to create a device if needed
  double pipelines_s = 0.0;              ///< the part of setup_s that creates pipelines
};

/// The part of a call's time that no other time in the reports of the evaluator, before and after the call, covers.
inline double transfer_time(const EvaluationReport& before, const EvaluationReport& after, double call_s) {
  const auto covered = [](const EvaluationReport& r) {
    return r.kernel_s + r.sums_s + r.curves_s + r.beams_s + r.setup_s;
  };
  return std::max(call_s - (covered(after) - covered(before)), 0.0);
}

/// Adds the precision `name` to those that were used: "float", "double", or "float and double".
inline void note_precision(std::string& used, const std::string& name) {
  if (used.empty()) used = name;
  if (used != name) used = "float and double";
}

/// Computes moments, with the request's precision, or Mueller matrices, in the order of the request's entries.
class ModelEvaluator {
 public:
  virtual ~ModelEvaluator() = default;
  virtual std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) = 0;
  virtual std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) = 0;
  /// Integrates for a polarised diffuse part.
  virtual TransmissionIntegral transmission() const { return transmission_integral; }
  virtual bool has_double() const { return true; }
  /// True if the evaluator must integrate each entry. Then a run neither interpolates nor uses responses.
  virtual bool computes_each_entry() const { return false; }
  virtual EvaluationReport report() const = 0;  ///< totals over all calls since the last clear_report
  virtual void clear_report() {}
};

}  // namespace dolp
