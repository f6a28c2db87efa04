#pragma once

#include <vector>

#include "beams/beam_geometry.hpp"
#include "model/choices.hpp"
#include "model/slopes.hpp"

namespace dolp {

/// The attenuation G of the maskings `integral` and smith at single beams, for one slope distribution.
/// Equation: shaders/physics/README.md, sections 2 and 8 ("Masking tables").
/// Accuracy: relative error 1e-12 (tests ScatteringOf.*).
class InPlaneMasking {
 public:
  InPlaneMasking(Distribution distribution, Masking masking, const SlopeShape& shape);

  double attenuation(const BeamGeometry& beam);
  /// G1 of smith: the share of each facet that one direction sees.
  double smith_toward(const CosSin& zenith);

 private:
  /// Integrals over slopes tau. p: density of the slopes in the plane of incidence; g: 1 for smith, 1 / sqrt(1 + tau^2)
  /// for `integral`. x is the lower limit.
  struct Integrals {
    double share = 0.0;     ///< of p
    double weighted = 0.0;  ///< of g p
    double height = 0.0;    ///< of g p (tau - x)
  };

  double density(double slope) const;
  double weight(double slope) const;
  double panel_position(double slope) const;
  Integrals within_panel(double from, double first_panel, double last_panel) const;
  Integrals power_law_above(double slope) const;
  Integrals between(double from, double to) const;
  /// Smith's Lambda at one zenith. Beams with the same zenith share it.
  struct Lambda {
    double cotangent = 0.0;
    double value = 0.0;
  };
  double lambda(const CosSin& zenith, Lambda& last) const;
  double shadowed(const BeamGeometry& beam) const;

  Distribution distribution_;
  Masking masking_;
  double q_minus_1_;
  double m_;             ///< width of the distribution
  double norm_;          ///< p(0)
  double scale_;         ///< unit of tau in the variable of the panels, asinh(tau / scale_)
  double end_;           ///< from this slope the cauchy distribution counts as a power law, and the gaussian as 0
  double length_ = 1.0;  ///< length of a panel
  std::vector<double> starts_;     ///< slope at the start of each panel
  std::vector<Integrals> panels_;  ///< integrals over each panel
  Lambda lambda_i_, lambda_r_;     ///< Lambda at both zeniths of the last beam
};

}  // namespace dolp
