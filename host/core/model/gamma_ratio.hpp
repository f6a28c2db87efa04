// The ratio of gamma functions in the marginal density of the Student-t slopes.
#pragma once

namespace dolp {

/// Gamma(x + 1/2) / Gamma(x), to a few roundings. Domain: x > 0 of any size.
double gamma_ratio(double x);

}  // namespace dolp
