// Reflection of light by a medium under films, whose thickness may vary over the surface.
#pragma once

#include <complex>

#include "model/facet_optics.hpp"

namespace dolp {

/// Means over the thickness of the films: R_s, R_p, and conj(r_s) r_p of the reflection amplitudes.
struct FilmReflection {
  double r_s = 0.0;
  double r_p = 0.0;
  std::complex<double> cross;
};

/// Reflection by a medium under films. The thickness d of a film with a spread is normal about its mean, with d >= 0;
/// the films vary independently. Light interferes within a facet but not between facets, so the means are means of the
/// facet's Mueller matrix.
/// Equation: r of one thickness begins as the coefficient of the interface between the medium and the innermost film.
/// From there outward, each film replaces r by (r_j + r z) / (1 + r_j r z) with z = e^(2 i delta). r_j is the
/// coefficient of the film's outer interface, delta = 2 pi d sqrt(N^2 - sin^2 beta) / lambda for its thickness d and
/// index N. Source: Born and Wolf, Principles of Optics, section 1.6. Conventions: r_p = -r_s at normal incidence.
/// Domain: cosine in (0, 1]; at most kMostVariedFilms films with a spread; not is_too_wide().
/// Accuracy: 1e-14 without a spread, 1e-9 with one, 4e-6 if the mean thickness is below 5 spreads (tests FilmSpread).
FilmReflection film_reflection(const FacetOptics& optics, double cosine);

/// Absorptances of a medium under films, from the net flux of energy, without SmoothAbsorptance::split. They and their
/// error are proportional to the cosine at grazing incidence, where 1 - R would lose its digits. Domain: as
/// film_reflection(). Accuracy: with a spread, 1e-9 on top of `error`.
SmoothAbsorptance film_absorptance(const FacetOptics& optics, double cosine);

inline constexpr std::size_t kMostVariedFilms = 2;

/// True if the mean over the thickness would need too many points: a spread above a fifth of the thickness, with
/// fringes that the end of the distribution at thickness 0 does not average out.
bool is_too_wide(const Film& film);

/// True if the thickness of the film varies so much that no interference is left, at any angle. `thickness` and
/// `spread` in wavelengths.
bool is_blurred(const Film& film);

/// Number of interference fringes between grazing and normal incidence, summed over the films that are not blurred.
double fringe_count(const FacetOptics& optics);

}  // namespace dolp
