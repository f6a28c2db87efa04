// Converts moments to the quantities that a sensor measures: rho, Stokes parameters, DOLP, error bounds and status, in
// double.
#pragma once

#include <memory>
#include <span>

#include <dolp/results.hpp>
#include "model/direction.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "radiometry/diffuse.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// Radiometry of a scene: prepares once everything that does not depend on the entry.
///
/// Equation: I = pi B (1 - rho_I) + X rho_I, Q = (X - pi B) rho_Q, X = E0 cos(theta) + pi B(T_surr), then the path.
/// With emission.model = "fresnel", the emission uses 1 - R_s(theta) and 1 - R_p(theta) of the smooth surface instead
/// of 1 - rho_s and 1 - rho_p, for any k_s and diffuse part. In bistatic mode X has no E0, the sums are divided by pi,
/// and E0 cos(theta_i) f at the view direction is added. With emission.bracket the error estimate also bounds the
/// errors of dolp_low and dolp_high.
/// Source: shaders/physics/README.md, section 4; Wang, Li, Wang 2025, eqs. (16), (18).
class Radiometry {
 public:
  /// Disabled terms contribute nothing. Without the moments the specular part of rho counts as 0, `point` ignores the
  /// numbers in its Moments, and quantities that need them are NaN. `dropped` widens the error estimates. `sky` is the
  /// basis of the moments with a sky; null means the basis of this scene.
  explicit Radiometry(const SceneModel& scene, const KeptEffects& kept = {}, double dropped = 0.0,
                      const std::shared_ptr<const SkyBasis>& sky = nullptr);

  /// The indices for which `point` needs moments, in its order, and their weights.
  const SpectralRule& rule() const { return rule_; }

  /// Result at one entry.
  /// Shape: one Moments per sample of rule(), in its order.
  /// Domain: moments with a NaN are outside the model's domain; the status is 4 and everything is NaN. At 90 degrees
  /// rho diverges with masking none or integral, or with k_d > 0 and c < 0. Then rho and Stokes are NaN with status 1 |
  /// 4, and dolp is the limit.
  PointResult point(const Direction& direction, std::span<const Moments> moments) const;

  /// Facet optics at each sample, and the diffuse reflection for them.
  struct Optics {
    std::vector<FacetOptics> facets;
    std::vector<DiffuseReflection> diffuse;
    std::vector<double> diffuse_beyond_mean;  ///< DiffuseSample::beyond_mean
  };
  Optics optics_with(std::vector<FacetOptics> facets) const;

  /// Result at one entry with other facets than the facets of rule(), for entries with a separate n or k. Only the
  /// fresnel emission and a polarised diffuse part use them.
  PointResult point(const Direction& direction, std::span<const Moments> moments, const Optics& optics) const;

  /// Bistatic result: `moments` and rho at the view direction, the source at theta_i.
  /// Shape: one Moments and one Scattered per sample of rule(), in its order.
  /// Domain: as for `point`, but where rho diverges at 90 degrees everything is NaN with status 1 | 4.
  PointResult bistatic_point(const Direction& view, double cos_theta_i, std::span<const Moments> moments,
                             const Optics& optics, std::span<const Scattered> scattered) const;
  const Optics& optics() const { return optics_; }

 private:
  PointResult assemble(std::span<const Moments> moments, double cos_theta, const Optics& optics, double cos_theta_i,
                       std::span<const Scattered> scattered) const;

  PointResult finished(PointResult result) const;

  SceneModel scene_;  ///< its surface is the one that the terms of the moments use
  double beam_specular_;
  KeptEffects kept_;
  double dropped_;  ///< bound of the change of DOLP by dropped effects
  bool knows_rho_;
  SpectralRule rule_;
  SpectralRule kept_rule_;                 ///< the rule without the factors that are not kept
  std::shared_ptr<const SkyBasis> basis_;  ///< basis of the sky, if the sky is kept
  std::vector<SkyWeights> sky_;            ///< one per sample; empty without a profile
  Optics optics_;                          ///< optics of the rule
};

}  // namespace dolp
