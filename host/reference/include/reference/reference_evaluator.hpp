// Moments and pBRDFs by adaptive quadrature over the other direction: slow, independent of the shaders, with error
// bounds.
#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

struct ReferenceOptions {
  /// Tolerance of the integrals. Errors of r_i and r_q are relative to r_i. Errors of the albedo and of the absorbed
  /// part are relative to their values.
  double relative_tolerance = 1e-9;
  /// Equal parts of each first panel of the quadratures. A value of 2 repeats the computation with other nodes.
  int subdivisions = 1;
};

/// The independent reference: moments by nested adaptive Gauss-Kronrod quadrature in double, over zenith and azimuth of
/// the other direction. The masking `integral` is integrated over the facet tilt at every point. Scattering::kMultiple
/// gives the moments of V-grooves, wants_direct adds the direct emission (reference/moments.hpp); both are integrated
/// over the slopes of the facets.
/// Equation: (4), (7), (9)-(13), (15), (16).
/// Accuracy: the integrals have the tolerance ReferenceOptions::relative_tolerance, or a hundredth of the request's
/// tolerance if that is larger, but at most half of the request's tolerance. If the request's tolerance is 0, they have
/// ReferenceOptions::relative_tolerance. With all bounces in steep metal grooves the quadratures may end earlier, with
/// larger errors. The returned errors are the errors of the quadratures plus rounding (test
/// ReferenceMoments_CoarseQuadrature_StaysWithinItsErrors).
/// Domain: theta in [0, 90] degrees; sigma >= 0; cauchy q > 1, with smith masking q > 3/2; n > 0, k >= 0. Multiple
/// scattering needs v-cavity masking, direct emission v-cavity or smith. At 90 degrees all four moments are limits: 0
/// for v-cavity and smith. For the other maskings they are finite, except for cauchy with q <= 3/2: there they are
/// infinite with infinite errors, and r_q and the absorbed part are negative.
/// Errors: InputError outside the domain; Cancelled when `progress` returns false.
class ReferenceEvaluator final : public ModelEvaluator {
 public:
  explicit ReferenceEvaluator(ReferenceOptions options = {}) : options_(options) {}
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;
  /// pBRDFs from explicit vectors (reference/mueller.hpp), with the accuracy kScatteringErrorDouble.
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;
  bool computes_each_entry() const override { return true; }
  EvaluationReport report() const override { return report_; }
  void clear_report() override { report_ = {}; }

 private:
  void note(double seconds);

  ReferenceOptions options_;
  EvaluationReport report_;
};

}  // namespace dolp
