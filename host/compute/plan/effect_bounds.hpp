// Closed-form bounds of the change of the polarisation by an effect.
#pragma once

#include <dolp/effect.hpp>
#include <vector>

#include "model/kept_effects.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// Each part is a flag of KeptEffects.
bool is_kept(const KeptEffects& kept, Part part);
KeptEffects without(KeptEffects kept, Part part);

/// Ranges of the parameters of some entries.
struct EntriesExtent {
  std::vector<double> theta_deg;
  SlopeShape roughest;               ///< the largest sigma and the smallest q
  SlopeShape smoothest;              ///< the smallest sigma and the largest q
  std::vector<FacetOptics> indices;  ///< of the entries' own
};

/// The extent of a grid, which has each direction at each wavelength; else those of the points at each wavelength.
std::vector<EntriesExtent> extents_of(const SceneEntries& entries);

/// Bounds of the change that each part of a scene causes at any of the entries.
///
/// Derivation: a part adds (dI, dQ, dU) to the Stokes sums, so that with q = (Q, U) / I and ' for the sums without it
///   q - q' = (dQ - q dI) / I'.
/// |dI| and |dQ, dU| are factors of the scene times the bounds 0 <= rho_I <= A, |rho_Q| <= A / 2 and those of the beam.
/// With E, S, X the exitances of emission, surroundings and source (X only in hemispherical mode), Kirchhoff's emission
/// gives I = E + (S - E + X) rho >= E - max(0, E - S) A and Q = (S - E + X) rho_Q, because S - E has one sign at all
/// wavelengths: the weight of the moments is |S - E| + X, which is 0 where emission and surroundings have one
/// temperature and no source illuminates the hemisphere. A profile of the sky adds at most its largest distance from
/// its mean to S, in any direction. The fresnel emission is at least E (1 - R_s) / 2; the direct one has no known lower
/// bound. A path multiplies all by its transmittance and adds to I. |q| <= 1 where A <= 1, which bounds rho_s and
/// rho_p: then every part has a degree of polarisation of at most 1. All Stokes parameters are in the units of the
/// exitances, bistatic ones times pi; sums over a band are those of the spectral rule's samples.
class EffectBounds {
 public:
  EffectBounds(const SceneModel& scene, const EntriesExtent& extent);

  /// Bound of the change of (Q/I, U/I), at any entry, if `part` is dropped from `kept`; infinite where no bound is
  /// known, and always for the further bounces and the diffuse part. Exactly 0 where the part contributes nothing.
  double bound(Part part, const KeptEffects& kept) const;

  /// True if a part contributes exactly nothing at every entry.
  bool adds_nothing(Part part, const KeptEffects& kept) const;

 private:
  struct Sums;
  void add_beams(const EntriesExtent& extent, const std::vector<FacetOptics>& indices);
  double weight(const KeptEffects& kept) const;
  double incident(const KeptEffects& kept) const;
  double most_rho(const KeptEffects& kept) const;
  Sums sums(const KeptEffects& kept) const;
  Sums added_by(Part part, const KeptEffects& kept) const;

  SceneModel scene_;
  bool is_bistatic_;
  SpectralSample total_;       ///< sums of the absolute values of the samples' factors; the emitted ones are signed
  double sky_above_ = 0.0;     ///< what a profile adds to its mean at most,
  double sky_below_ = 0.0;     ///< and takes from it
  bool has_negative_ = false;  ///< weights of both signs, as the interpolation of a steep factor may have
  double path_;
  double most_specular_ = 0.0;  ///< of rho_I
  double most_diffuse_ = 0.0;   ///< of rho
  double least_smooth_ = 0.0;   ///< emissivity of the smooth surface
  double most_beam_ = 0.0;      ///< exitance for E0 = 1 that is reflected into the view
  double most_beam_qu_ = 0.0;   ///< of its length of (Q, U)
  double least_beam_ = 0.0;
};

}  // namespace dolp
