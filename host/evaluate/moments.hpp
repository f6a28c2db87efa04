// What the evaluators compute: the hemispherical moments of the specular microfacet term (k_s = 1, no diffuse part).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace dolp {

/// The two parameters of the slope distribution. The gaussian ignores q.
struct SlopeShape {
  double sigma = 0.0;
  double q = 2.0;
  friend bool operator==(const SlopeShape&, const SlopeShape&) = default;
};

/// The tightest tolerance of a rule in float; beyond, rounding drowns it.
inline constexpr double kLeastFloatTolerance = 2e-6;

/// One entry: positions in the three lists of its request.
struct MomentsEntry {
  std::uint32_t theta = 0;
  std::uint32_t shape = 0;
  std::uint32_t index = 0;
};

/// Lists of distinct directions, slope shapes and refractive indices, and the combinations that are wanted.
struct MomentsRequest {
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  double tolerance = 1e-4;                 ///< of the rule, relative to r_i
  Precision precision = Precision::kAuto;  ///< kAuto: the evaluator's own
  bool may_interpolate = true;             ///< between slope distributions, to the same tolerance
  std::vector<double> theta_deg;
  std::vector<SlopeShape> shapes;
  std::vector<OpticalConstants> indices;
  std::vector<MomentsEntry> entries;
};

/// The moments of one entry, all multiplied by cos(theta), which keeps them finite at theta = 90 degrees.
/// Equation: r = rho cos(theta); rho_s = rho_I + rho_Q, rho_p = rho_I - rho_Q.
struct Moments {
  double r_i = 0.0;      ///< rho_I cos(theta)
  double r_q = 0.0;      ///< rho_Q cos(theta), signed
  double albedo = 0.0;   ///< A cos(theta): the same integral with R = 1
  double deficit = 0.0;  ///< cos(theta) - r_i, summed directly: no cancellation where rho_I is near 1
  // Bounds of the absolute errors of the four, in the same units (quadrature, masking tables and rounding).
  double r_i_error = 0.0;
  double r_q_error = 0.0;
  double albedo_error = 0.0;
  double deficit_error = 0.0;
  double evaluations = 0.0;  ///< integrand evaluations spent on this entry
};

/// cos and sin of an angle in degrees, exact at multiples of 90 degrees.
struct CosSin {
  double cos = 1.0;
  double sin = 0.0;
};
CosSin cos_sin_deg(double angle_deg);

/// What ran, for the report.
struct EvaluationReport {
  std::string evaluator;  ///< vulkan | cpu | reference
  std::string device;     ///< device name, or the processor
  std::string driver;     ///< driver name and version; empty for cpu and reference
  std::string precision;  ///< float | double | float and double, as used
  std::uint64_t dispatches = 0;
  double evaluations = 0.0;
  double kernel_s = 0.0;           ///< time on the device (timestamps), or of the loop on the CPU, and of interpolation
  double setup_s = 0.0;            ///< device and pipeline creation
  std::uint64_t interpolated = 0;  ///< moments that were interpolated between slope distributions,
  std::uint64_t interpolation_nodes = 0;  ///< and moments computed for that
};

/// Adds a precision to EvaluationReport::precision.
inline void note_precision(std::string& used, bool in_double) {
  const char* name = in_double ? "double" : "float";
  if (used.empty()) used = name;
  if (used != name) used = "float and double";
}

/// Called with the number of finished entries; returning false cancels (the evaluator then throws Cancelled).
using Progress = std::function<bool(std::size_t done, std::size_t total)>;
struct Cancelled {};

class ScatteringEvaluator;

/// Computes moments. Results are in the order of `request.entries`.
class MomentsEvaluator {
 public:
  virtual ~MomentsEvaluator() = default;
  virtual std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) = 0;
  /// The precision it was made for: that of scenes which leave theirs open. kAuto leaves it open too.
  virtual Precision precision() const { return Precision::kAuto; }
  /// Whether requests in double are possible.
  virtual bool has_double() const { return true; }
  /// The same evaluator's pBRDFs (evaluate/scattering.hpp), which the bistatic mode needs; null when it has none.
  virtual ScatteringEvaluator* scattering() { return nullptr; }
  /// Totals over all calls, pBRDFs included.
  virtual EvaluationReport report() const = 0;
};

}  // namespace dolp
