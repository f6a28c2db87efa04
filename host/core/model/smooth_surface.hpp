#pragma once

#include <complex>

#include "model/facet_optics.hpp"
#include "model/moments.hpp"

namespace dolp {

/// Amplitudes that a facet reflects.
struct ReflectedAmplitudes {
  std::complex<double> s;
  std::complex<double> p;
};

/// Amplitudes of a medium under films.
///
/// Equation: the recursion r = (r_j + r e^(2 i delta)) / (1 + r_j r e^(2 i delta)) from the medium outward,
/// delta = 2 pi d q / lambda, q = sqrt(N^2 - sin^2 beta).
/// Source: Born and Wolf, Principles of Optics, section 1.6. Conventions: r_p = -r_s at normal incidence.
/// Domain: cosine in (0, 1].
ReflectedAmplitudes film_amplitudes(const FacetOptics& optics, double cosine);

/// Fringes that the films add between grazing and normal incidence: periods of e^(2 i delta).
double fringe_count(const FacetOptics& optics);

/// Parts absorbed by a smooth surface, 1 - R_s and 1 - R_p.
struct SmoothAbsorptance {
  double s = 1.0;
  double p = 1.0;
  double split = 0.0;  ///< (R_s - R_p) / sin^2(angle of incidence)
};

/// Absorptance of a smooth surface at an angle of incidence.
///
/// Equation: 1 - R_s = 4 c Re(w) / |c + w|^2, 1 - R_p = 4 c Re(N^2* w) / |N^2 c + w|^2, w = sqrt(N^2 - 1 + c^2); with
/// films 1 - |r|^2 of film_amplitudes.
/// Domain: cosine c in (0, 1], n > 0, k >= 0; total reflection (n < 1, k = 0) gives exactly 0.
/// Accuracy: a bare medium: no cancellation, however good the reflector. Films: 1e-14; their split 1e-10 of it.
SmoothAbsorptance smooth_absorptance(const FacetOptics& optics, double cosine);

/// The smaller of reflectance and absorptance, to which errors are relative: at normal incidence, and under films their
/// means over a few angles, because films may reflect nothing at one of them.
double reflectance_level(const FacetOptics& optics);

/// Cosine of the angle at which total reflection begins, sqrt(1 - Re N^2), where that is a kink (k = 0) or nearly one;
/// 0 elsewhere.
double critical_cosine(const FacetOptics& optics);

/// Moments of the mirror, the limit sigma -> 0 of every surface: R_s and R_p at the direction itself, no masking.
///
/// Domain: cosine in (0, 1].
/// Accuracy: as smooth_absorptance.
Moments mirror_moments(const FacetOptics& optics, double cosine);

}  // namespace dolp
