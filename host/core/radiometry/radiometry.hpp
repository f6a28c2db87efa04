#pragma once

#include <memory>
#include <span>

#include <dolp/results.hpp>
#include "model/direction.hpp"
#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "radiometry/diffuse.hpp"
#include "radiometry/reflectance.hpp"
#include "radiometry/stokes.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// atan2(U, Q) / 2 in [0, 180) degrees; NaN if Q = U = 0.
double polarisation_angle_deg(double q, double u);

/// Neighbouring spectral samples form up to eight groups. Each group has one FurtherLight, computed for the sample in
/// its middle. Returns the middle sample of each group, for a rule with `samples` samples.
std::vector<std::size_t> middle_samples(std::size_t samples);

struct RadiometrySettings {
  /// Effects that contribute. If kept.moments is false, the specular part of rho counts as 0, and quantities that need
  /// it are NaN.
  KeptEffects kept = {};
  double dropped = 0.0;  ///< how much the other effects can change DOLP; the error estimate of DOLP includes it
  /// The functions of Moments::columns. If null, they are computed from the scene.
  std::shared_ptr<const SkyBasis> sky = nullptr;
  TransmissionIntegral transmission = transmission_integral;  ///< integrates for a polarised diffuse part
};

/// Converts moments to the quantities that a sensor measures.
/// Equation: the light that leaves the surface has I = pi B (1 - rho_I) + X rho_I and Q = (X - pi B) rho_Q. B is the
/// Planck radiance at the temperature of the surface. X = E0 cos(theta) + pi B(T_surr) is the incident light: a
/// source of the irradiance E0, and surroundings. In these formulas the emissivities are 1 - rho_s and 1 - rho_p. With
/// emission.model = "fresnel" they are 1 - R_s and 1 - R_p of the smooth surface instead. In bistatic mode I and Q are
/// divided by pi. Then the source is not part of X: it adds E0 cos(theta_i) f, with the pBRDF f from source to view.
class Radiometry {
 public:
  /// `rule`: samples for the spectrum of the scene.
  Radiometry(const SceneModel& scene, SpectralRule rule, const RadiometrySettings& settings);
  explicit Radiometry(const SceneModel& scene) : Radiometry(scene, spectral_rule(scene), {}) {}

  /// The spectral samples of the scene. `point` needs Moments for each sample's refractive index, in this order.
  const SpectralRule& rule() const { return rule_; }

  /// If rho diverges at 90 degrees, the status is 1 | 4 (1: rho outside [0, 1], 4: outside the model's domain). Then
  /// rho and the Stokes parameters are NaN, and dolp is its limit for theta -> 90 degrees. If the limit is unknown,
  /// because moments are NaN, the status is 4, and every quantity is NaN. If moments are NaN elsewhere, the evaluator
  /// failed: the status is 2 | 16 (a tolerance is not met), both error estimates are infinite, and the other quantities
  /// are NaN.
  PointResult point(const Direction& direction, std::span<const Moments> moments) const {
    return point(view(direction, optics_), moments);
  }

  /// For each spectral sample: the optics of the facets, and the diffuse reflection of a surface with these optics.
  struct Optics {
    std::vector<FacetOptics> facets;
    std::vector<DiffuseReflection> diffuse;
    std::vector<Estimate> diffuse_beyond_mean;  ///< DiffuseSample::beyond_mean
  };
  Optics optics_with(std::vector<FacetOptics> facets) const;

  const Optics& optics() const { return optics_; }

  /// Numbers that all results of one direction share.
  struct View {
    Direction direction;
    double cos_source = 0.0;  ///< cosine of the zenith of the source; in hemispherical mode, of the direction
    MeanWeights mean_weights;
    PerSample<DiffuseSample> diffuse;
    PerSample<DiffuseLight> diffuse_beam;  ///< empty in hemispherical mode
    PerSample<Emissivity> fresnel;         ///< empty without fresnel emission
  };
  /// `optics` affects fresnel emission and a polarised diffuse part. In bistatic mode the source is at theta_i.
  View view(const Direction& direction, const Optics& optics, double cos_theta_i = 0.0) const;

  /// The result at a view, also for entries with their own n or k. In bistatic mode `moments` and rho belong to the
  /// view, and `scattered` has one element per sample of rule(). If rho diverges, dolp is NaN, too.
  PointResult point(const View& view, std::span<const Moments> moments,
                    std::span<const Scattered> scattered = {}) const;

  /// True if light that single scattering loses, or that the masking creates, may change DOLP by more than 1e-4.
  bool may_change_dolp(const PointResult& result, double cos_theta) const;

  /// Sets model_change_dolp of a result of point(), and the status bit that follows from it. The
  /// light that a surface with the albedo A loses, 1 - A, is reflected as `further` tells.
  /// Shape: one FurtherLight per group of middle_samples(), or one for all groups.
  void judge_dolp(PointResult& result, double cos_theta, std::span<const FurtherLight> further) const;

 private:
  /// Exitance that the surroundings add to the reflected light minus what Kirchhoff's law takes from the emission.
  struct Net {
    double thermal = 0.0;
    double source = 0.0;  ///< irradiance of the source, in hemispherical mode
  };

  PointResult assemble(const View& view, std::span<const Moments> moments, std::span<const Scattered> scattered) const;

  PointResult finished(PointResult result) const;

  SceneModel scene_;  ///< the scene as it is kept: without dropped specular, diffuse or direct emission
  double beam_specular_;
  RadiometrySettings settings_;
  bool knows_rho_;
  bool knows_emissivity_;
  bool uses_direct_;  ///< results need the moments of the direct emission
  SpectralRule rule_;
  SpectralRule kept_rule_;                 ///< rule_, with 0 for the radiation of dropped effects
  std::shared_ptr<const SkyBasis> basis_;  ///< functions of the sky; null if the scene has no sky profile or drops it
  std::vector<Net> nets_;                  ///< for each group of middle_samples()
  double emitted_ = 0.0;                   ///< exitance of a black body, summed over the samples
  double scale_ = 1.0;                     ///< what turns an exitance at the surface into I at the sensor
  std::vector<SkyWeights> sky_;            ///< for each spectral sample, the weights of the functions in basis_
  Optics optics_;
};

}  // namespace dolp
