#pragma once

#include <array>
#include <dolp/effect.hpp>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/scene_entry.hpp"
#include "plan/constants.hpp"
#include "scene/scene.hpp"
#include "spectrum/sky_factors.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

bool is_kept(const KeptEffects& kept, Part part);
KeptEffects without(KeptEffects kept, Part part);

struct EntriesExtent {
  std::vector<BeamAngles> beams;  ///< in hemispherical mode, theta_i_deg is theta and the other angles mean nothing
  SlopeShape roughest = {0.0, std::numeric_limits<double>::infinity()};   ///< the largest sigma and the smallest q
  SlopeShape smoothest = {std::numeric_limits<double>::infinity(), 0.0};  ///< the smallest sigma and the largest q
  double width_ratio = 1.0;  ///< largest quotient of the widths along and across
  std::vector<FacetOptics> optics = {};
  void add(const SlopeShape& shape);
};

/// For a grid one extent, because all its SceneVariants have equal directions. For points, one for each SceneVariant.
std::vector<EntriesExtent> entry_extents(const SceneModel& scene, const SceneEntries& entries);

/// Bounds of the change of p = (Q, U) / I that each part of a scene causes at any of the entries.
/// Derivation: let a part add (dI, dQ, dU) to the Stokes parameters, and let a prime mark values without the part. Then
/// p - p' = ((dQ, dU) - p dI) / I'. By Kirchhoff's law, I = E + (S - E + X) rho_I and Q = (S - E + X) rho_Q, with the
/// exitances E of the emission, S of the surroundings, X of the source. Bounds of the reflectance rho bound I and Q.
class EffectBounds {
 public:
  EffectBounds(const SceneModel& scene, const SpectralRule& rule, const EntriesExtent& extent);

  /// Bound of the change of (Q/I, U/I), at any entry, if `part` is dropped from `kept`. The bound is 0 if the part
  /// contributes nothing, and infinite if no bound is known.
  double bound(Part part, const KeptEffects& kept) const;

  bool adds_nothing(Part part, const KeptEffects& kept) const;

 private:
  struct Sums;
  void add_beams(const EntriesExtent& extent, const std::vector<FacetOptics>& indices);
  bool emits(const KeptEffects& kept, EmissionModel model) const;
  double weight(const KeptEffects& kept) const;
  double most_rho(const KeptEffects& kept) const;
  Sums sums(const KeptEffects& kept) const;
  std::array<double, 2> added_by(Part part, const KeptEffects& kept) const;

  SceneModel scene_;
  bool is_bistatic_;
  SpectralSample total_;       ///< sums over the spectral samples; all members but `emitted` sum absolute values
  double sky_apart_ = 0.0;     ///< largest difference between a sky profile and its mean
  bool has_negative_ = false;  ///< true if a spectral weight is negative, which SpectralSample allows
  double path_;
  double most_specular_ = 0.0;  ///< upper bound of the specular rho_I
  double most_diffuse_ = 0.0;   ///< upper bound of the diffuse rho
  double most_beam_ = 0.0;      ///< upper bound of pi * I, the source light toward the viewer at irradiance 1
  double most_beam_qu_ = 0.0;   ///< upper bound of pi * sqrt(Q^2 + U^2) of the same light
  double least_beam_ = 0.0;
};

struct EffectPlan {
  bool keep_all = false;
  KeptEffects kept;
  std::map<Part, double> dropped;       ///< dropped parts, with bounds of the changes of (Q/I, U/I)
  double bound = 0.0;                   ///< bound of the change by all dropped parts together
  bool needs_direct = false;            ///< the run needs the moments of the direct emission
  bool needs_beams = false;             ///< the run needs the pBRDF from the source to the viewer
  std::shared_ptr<const SkyBasis> sky;  ///< functions of the sky, set by with_spectra; null without a profile
  bool gives_rho = true;                ///< the run gives rho_i, rho_q and rho_error_estimate
  bool gives_albedo = true;
  std::shared_ptr<const SpectralRules> rules = {};  ///< for the entries of the run, set by with_spectra
};

/// Drops parts as long as their bounds (EffectBounds) sum to at most kDroppedShare of the tolerance. The order is:
/// source, surroundings, their profile, emission, path, moments, further bounces. The bound of a part holds in a
/// scene without the parts already dropped. The diffuse part and choices of the model, like the masking, always stay.
EffectPlan plan_effects(const SceneValues& scene, const SceneEntries& entries, bool keep_all);

EffectPlan plan_to_keep(const SceneValues& scene, const KeptEffects& kept);

EffectPlan keep_everything(const SceneValues& scene);

/// Sets EffectPlan::rules for these entries, and EffectPlan::sky if the moments need it, unless the plan has them.
EffectPlan with_spectra(EffectPlan plan, const SceneValues& scene, const SceneEntries& entries);

/// True if the run gives an emissivity: the scene emits, and the plan keeps all moments that the emissivity needs.
bool gives_emissivity(const SceneValues& scene, const EffectPlan& plan);

std::vector<Effect> list_effects(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan);

std::string effects_text(const std::vector<Effect>& rows, const EffectPlan& plan);

}  // namespace dolp
