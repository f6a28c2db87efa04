// From moments to the quantities that a sensor measures: rho, Stokes parameters, DOLP, error bounds and status, in
// double.
#pragma once

#include <memory>
#include <span>

#include <dolp/results.hpp>
#include "model/direction.hpp"
#include "model/moments.hpp"
#include "radiometry/diffuse.hpp"
#include "radiometry/scattered.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// Radiometry of a scene: everything that does not depend on the entry is prepared once.
///
/// Equation: I = pi B (1 - rho_I) + X rho_I, Q = (X - pi B) rho_Q, X = E0 cos(theta) + pi B(T_surr), then the path.
/// With emission.model = "fresnel", 1 - rho_s is replaced in the emission by 1 - R_s(theta) of the smooth surface,
/// likewise p, whatever k_s and the diffuse part are. In bistatic mode the same without E0 over pi, plus E0
/// cos(theta_i) f at the view direction. With emission.bracket the error estimate bounds the errors of dolp_low and
/// dolp_high too.
/// Source: shaders/physics/README.md, section 4; Wang, Li, Wang 2025, eqs. (16), (18).
class Radiometry {
 public:
  /// Disabled terms contribute nothing; without the moments the specular part of rho counts as 0, `point` ignores the
  /// numbers in its Moments, and quantities that need them are NaN. `dropped` widens the error estimates. `sky`: the
  /// basis of the moments with a sky; null: that of the scene alone.
  explicit Radiometry(const SceneModel& scene, const KeptEffects& kept = {}, double dropped = 0.0,
                      const std::shared_ptr<const SkyBasis>& sky = nullptr);

  /// The indices at which `point` wants moments, in its order, and their weights.
  const SpectralRule& rule() const { return rule_; }

  /// Result at one entry.
  /// Shape: one Moments per sample of rule(), in its order.
  /// Domain: moments with a NaN are outside the model's domain: status 4, everything NaN. At 90 degrees, where rho
  /// diverges (masking none or integral, or k_d > 0 with c < 0), rho and Stokes are NaN with status 1 | 4 and dolp is
  /// the limit.
  PointResult point(const Direction& direction, std::span<const Moments> moments) const;

  /// Facets at each sample, and the diffuse reflection with them.
  struct Optics {
    std::vector<FacetOptics> facets;
    std::vector<DiffuseReflection> diffuse;
    std::vector<double> diffuse_beyond_mean;  ///< DiffuseSample::beyond_mean
  };
  Optics optics_with(std::vector<FacetOptics> facets) const;

  /// The same with other facets than those of rule(), as entries with their own n or k have; only the fresnel emission
  /// and a polarised diffuse part use them.
  PointResult point(const Direction& direction, std::span<const Moments> moments, const Optics& optics) const;

  /// Bistatic result: `moments` and rho at the view direction, the source at theta_i.
  /// Shape: one Moments and one Scattered per sample of rule(), in its order.
  /// Domain: a view at 90 degrees as in `point`, but where rho diverges everything is NaN with status 1 | 4.
  PointResult bistatic_point(const Direction& view, double cos_theta_i, std::span<const Moments> moments,
                             const Optics& optics, std::span<const Scattered> scattered) const;
  const Optics& optics() const { return optics_; }

 private:
  PointResult assemble(std::span<const Moments> moments, double cos_theta, const Optics& optics, double cos_theta_i,
                       std::span<const Scattered> scattered) const;

  PointResult finished(PointResult result) const;

  SceneModel scene_;  ///< with the surface as the terms of the moments use it
  double beam_specular_;
  KeptEffects kept_;
  double dropped_;  ///< bound of the change of DOLP by dropped effects
  bool knows_rho_;
  SpectralRule rule_;
  SpectralRule kept_rule_;                 ///< without the factors that are not kept
  std::shared_ptr<const SkyBasis> basis_;  ///< of the sky, if it is kept
  std::vector<SkyWeights> sky_;            ///< of each sample; empty without a profile
  Optics optics_;                          ///< of the rule
};

}  // namespace dolp
