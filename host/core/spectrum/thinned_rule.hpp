#pragma once

#include "spectrum/spectral_rule.hpp"

namespace dolp {

/// Returns a rule with fewer samples outside panels, whose sums are equal except for an error that it adds to
/// SpectralRule::relative_error. Returns `rule` if fewer samples are not accurate enough for the scene's tolerance, or
/// if the surface has no films, because the responses of a bare medium are few (model/response_basis.hpp).
/// Derivation: the reflectance curves of many wavelengths are nearly linearly dependent. Gram-Schmidt orthogonalization
/// chooses samples k such that the curve of each sample j is a sum of c_jk R_k. Then the integral of F times R, which
/// is the sum of F_j R_j, is the sum of F'_k R_k with F'_k, the sum of F_j c_jk over j. So it is at each angle. The
/// specular part of rho is a linear functional of the curve, so F' also gives the integral of F times rho.
/// Domain: all entries have the medium and the films of `scene`, because c depends on them.
/// Accuracy: tests ThinnedRule_*.
SpectralRule thinned_rule(const SceneModel& scene, SpectralRule rule);

}  // namespace dolp
