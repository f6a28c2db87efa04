#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "reference/moments.hpp"

namespace dolp {

/// An evaluator that is slow and independent of the shaders. It computes moments by nested adaptive Gauss-Kronrod
/// quadrature in double, over zenith and azimuth of reflection. For V-grooves with all bounces and for direct emission,
/// it integrates over the slopes of the facets.
/// Equation: (4), (7), (9)-(13), (15), (16) of Wang, Li, Wang 2025.
/// Accuracy: the returned errors. They are the estimated errors of the quadratures plus rounding errors (test
/// ReferenceMoments_CoarseQuadrature_StaysWithinItsErrors). The tolerance of the integrals is a hundredth of the
/// request's tolerance, but at least Refinement::relative_tolerance, and at most half of the request's tolerance.
/// Domain: theta in [0, 90] degrees; sigma >= 0; cauchy q > 1, with smith masking q > 3/2; n > 0, k >= 0. Multiple
/// scattering needs v-cavity masking, direct emission v-cavity or smith. At 90 degrees the moments are limits. Slopes
/// that differ along and across need masking none or v-cavity; their density is integrated over slopes and azimuths as
/// it is.
class ReferenceEvaluator final : public ModelEvaluator {
 public:
  explicit ReferenceEvaluator(reference::Refinement refinement = {}) : refinement_(refinement) {}
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;
  /// Computes pBRDFs with explicit vectors (reference/mueller.hpp). Accuracy: kScatteringError.
  std::vector<ScatteringMatrix> scatter(const ScatteringRequest& request, const Progress& progress) override;
  TransmissionIntegral transmission() const override;
  bool computes_each_entry() const override { return true; }
  EvaluationReport report() const override { return report_; }
  void clear_report() override { report_ = {}; }

 private:
  void note(double seconds);

  reference::Refinement refinement_;
  EvaluationReport report_;
};

}  // namespace dolp
