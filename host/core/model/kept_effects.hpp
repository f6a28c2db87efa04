#pragma once

namespace dolp {

/// The parts of a scene that the radiometry adds up; flags of parts that the scene lacks have no effect.
struct KeptEffects {
  bool emission = true;
  bool source = true;
  bool surroundings = true;
  bool path_radiance = true;  ///< the transmittance, which cancels in DOLP, always stays
  bool diffuse = true;
  bool further_bounces = true;  ///< in grooves, after the first
  bool moments = true;          ///< the specular part of rho, which the evaluators integrate
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

/// Bound of the change by dropped effects, at any entry.
struct DropBound {
  double dolp = 0.0;  ///< |change of (Q/I, U/I)|, hence of DOLP
  double rho = 0.0;   ///< |change of rho_I| over rho_I, where rho is given
};

}  // namespace dolp
