#pragma once

namespace dolp {

/// The parts of a scene that the radiometry adds up; flags of parts that the scene lacks have no effect.
struct KeptEffects {
  bool emission = true;
  bool source = true;
  bool surroundings = true;
  bool profile = true;        ///< of the surroundings, over their mean
  bool path_radiance = true;  ///< the transmittance, which cancels in DOLP, always stays
  bool diffuse = true;
  bool further_bounces = true;  ///< in grooves, after the first
  bool moments = true;          ///< the specular part of rho, which the evaluators integrate: at theta, or at the view
  friend bool operator==(const KeptEffects&, const KeptEffects&) = default;
};

}  // namespace dolp
