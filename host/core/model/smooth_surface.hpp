#pragma once

#include <optional>

#include <vector>

#include "model/facet_optics.hpp"
#include "model/moments.hpp"

namespace dolp {

/// Equation: a bare medium has 1 - R_s = 4 c Re(w) / |c + w|^2 and 1 - R_p = 4 c Re(conj(N^2) w) / |N^2 c + w|^2, where
/// c is the cosine and w = sqrt(N^2 - 1 + c^2). Under films they are film_absorptance().
/// Domain: cosine c in (0, 1], n > 0, k >= 0. Total reflection (n < 1, k = 0) gives exactly 0.
/// Accuracy: nothing cancels for a bare medium, even if it reflects nearly everything. With films, see
/// film_absorptance(), and the relative error of `split` is 1e-10.
SmoothAbsorptance smooth_absorptance(const FacetOptics& optics, double cosine);

/// The absorptances that two neighbouring rows of measured reflectances give, continued beyond the rows. `row`: the row
/// at the larger angle.
SmoothAbsorptance measured_absorptance(const MeasuredReflectance& measured, std::size_t row, double cosine);

/// The first angle between the first two rows at which |R_s - R_p| is limited, so that both stay in [0, 1], in degrees.
/// nullopt if there is none.
std::optional<double> difference_limit_deg(const MeasuredReflectance& measured);

/// The unit for errors of reflectances: the reflectance or the absorptance at normal incidence, whichever is smaller.
/// Films may reflect nothing at one angle, so for all but bare media both are means over four angles.
double reflectance_level(const FacetOptics& optics);

/// Cosine sqrt(1 - Re N^2) of the angle where total reflection begins; 0 if there is none or if it begins gradually.
double critical_cosine(const FacetOptics& optics);

/// Angles between ray and smooth surface at which reflectances have kinks or bend sharply: where total reflection
/// begins at the medium or in a film, and rows of measured reflectances. Ends of integration panels belong there.
std::vector<double> kink_elevations_rad(const FacetOptics& optics);

/// Moments of a mirror, the limit of every surface for sigma -> 0. Domain: cosine of incidence in (0, 1].
Moments mirror_moments(const FacetOptics& optics, double cosine);

}  // namespace dolp
