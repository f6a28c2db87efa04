#pragma once

#include <vector>

#include "model/evaluator.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"

namespace dolp {

struct ReferenceOptions {
  /// Tolerance of the integrals. r_i and r_q have it relative to r_i; albedo and absorbed part, relative to themselves.
  double relative_tolerance = 1e-9;
  /// Panels between two break points of a quadrature at first. With 2, a computation is repeated with other nodes.
  int subdivisions = 1;
};

/// An evaluator that is slow and independent of the shaders. It computes moments by nested adaptive Gauss-Kronrod
/// quadrature in double, over zenith and azimuth of reflection. At every point it integrates the masking `integral`
/// over the facet tilt. V-grooves with all bounces and the direct emission it integrates over the slopes of the facets.
/// Equation: (4), (7), (9)-(13), (15), (16) of Wang, Li, Wang 2025.
/// Accuracy: the tolerance of the integrals is ReferenceOptions::relative_tolerance, or a hundredth of the request's
/// tolerance if that is larger. It is at most half of the request's tolerance, unless that is 0. With all bounces in
/// steep metal grooves the quadratures may end earlier, with larger errors. The returned errors are the errors of the
/// quadratures plus rounding (test ReferenceMoments_CoarseQuadrature_StaysWithinItsErrors).
/// Domain: theta in [0, 90] degrees; sigma >= 0; cauchy q > 1, with smith masking q > 3/2; n > 0, k >= 0. Multiple
/// scattering needs v-cavity masking, direct emission v-cavity or smith. At 90 degrees the moments are limits: 0 for
/// v-cavity and smith, else finite. For cauchy with q <= 3/2 they are infinite with infinite errors, and r_q and the
/// absorbed part are negative.
/// Errors: InputError outside the domain; Cancelled when `progress` returns false.
class ReferenceEvaluator final : public ModelEvaluator {
 public:
  explicit ReferenceEvaluator(ReferenceOptions options = {}) : options_(options) {}
  std::vector<Moments> evaluate(const MomentsRequest& request, const Progress& progress) override;
  /// Computes pBRDFs with explicit vectors (reference/mueller.hpp). Accuracy: kScatteringErrorDouble.
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
