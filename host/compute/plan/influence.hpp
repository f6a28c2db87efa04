// How much of the polarisation an effect can be, before anything is integrated.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "model/angles.hpp"
#include "model/kept_effects.hpp"
#include "model/scene_entry.hpp"
#include "plan/facet_bounds.hpp"
#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// The parts of the sum that a plan may drop, each a flag of KeptEffects.
enum class Part { kFurtherBounces, kMoments, kSource, kSurroundings, kEmission, kPathRadiance, kDiffuse };

bool is_kept(const KeptEffects& kept, Part part);
KeptEffects without(KeptEffects kept, Part part);

/// The last direction and the last bounds of the reflectance, which several parts, and in bistatic mode all entries of a shape, ask for.
class ReflectanceMemory {
 public:
  const ReflectanceBounds& bounds(const Surface& surface, double theta_deg, const SceneEntry& entry,
                                  std::span<const OpticalConstants> indices, Detail detail);
  const CosSin& direction(double theta_deg);

 private:
  struct Slot {
    bool is_filled = false;
    double theta_deg = 0.0;
    SlopeShape shape;
    std::optional<OpticalConstants> index;
    ReflectanceBounds bounds;
  };
  std::array<Slot, 3> slots_;  // by Detail
  double theta_deg_ = 0.0;
  CosSin direction_{1.0, 0.0};
};

/// Bounds of what the parts of a scene change at its entries.
///
/// Derivation: a part adds (dI, dQ, dU) to the Stokes sums, so that with q = (Q, U) / I and ' for the sums without it
///   q - q' = (dQ - q' dI) / I = (dQ - q dI) / I',   |q - q'| <= min of both, and <= |q| + |q'|.
/// Bounds of |dI|, |dQ, dU| and of I from below follow from 0 <= least_i <= rho_I <= most_i and |rho_Q| <= most_q of
/// facet_bounds.hpp and those of the beam. With E, S, X the exitances of emission, surroundings and source (X only in
/// hemispherical mode), d the diffuse part of rho, Kirchhoff's emission gives
///   I = E + (S - E + X) rho >= E - max(0, E - S) most + max(0, S - E) least + X least,   Q = (S - E + X) rho_Q,
/// because S - E has one sign at all wavelengths. So the moments weigh |S - E| + X: nothing at all where emission and
/// surroundings have one temperature and no source shines into the hemisphere. With the fresnel emission they weigh
/// S + X, and E times the smooth surface's emissivity stands in place of E - E rho. In bistatic mode the beam and its
/// diffuse part add to I, and the beam's length to (Q, U). A path multiplies all by its transmittance and adds to I.
/// The direct emission has 0 <= eps_I <= 1 and |eps_Q| <= 1/2, and the moments weigh S + X beside it; without them it
/// is not known. Bounces after the first add at most the light that meets facets steep enough for a second one, 30
/// degrees - theta/3. |q| <= 1 where most <= 1, which bounds rho_s and rho_p: then every part has a degree of
/// polarisation of at most 1. All Stokes parameters are in the units of the exitances, bistatic ones times pi. Sums
/// over a band are those of the spectral rule's samples.
class InfluenceBounds {
 public:
  InfluenceBounds(const Scene& scene, const SpectralRule& rule);

  /// Bound of what dropping `part` changes where `kept` is kept, at one entry; infinite where none is known. Exactly 0
  /// where the part adds nothing.
  DropBound bound(Part part, const KeptEffects& kept, const SceneEntry& entry, Detail detail = Detail::kFine) const;
  /// The same with a memory that is used for one scene alone, and by one thread.
  DropBound bound(Part part, const KeptEffects& kept, const SceneEntry& entry, Detail detail,
                  ReflectanceMemory& memory) const;

  /// Whether a part adds exactly nothing, at any entry.
  bool adds_nothing(Part part, const KeptEffects& kept) const;

 private:
  struct Sums;
  struct AtEntry;
  AtEntry at_entry(const KeptEffects& kept, const SceneEntry& entry, Detail detail, ReflectanceMemory& memory) const;
  bool is_kirchhoff() const;
  double weight(const KeptEffects& kept) const;
  Sums sums(const KeptEffects& kept, const AtEntry& at) const;
  Sums added_by(Part part, const KeptEffects& kept, const AtEntry& at) const;
  const Scene& scene_;
  std::vector<OpticalConstants> indices_;
  SpectralSample total_;  ///< sums of the samples' factors, of their sizes but for what is emitted
  std::vector<double> emitted_;
  bool has_negative_ = false;  ///< weights of both signs, as the interpolation of a steep factor may have
  double path_ = 0.0;
  bool bistatic_ = false;
};

}  // namespace dolp
