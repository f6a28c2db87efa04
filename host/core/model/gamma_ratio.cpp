#include "model/gamma_ratio.hpp"

#include <boost/math/policies/policy.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace dolp {

double gamma_ratio(double x) {
  // In long double, Boost's default, it would dominate the host's cost of a slope distribution.
  const boost::math::policies::policy<boost::math::policies::promote_double<false>> in_double;
  if (x < 1.0) return boost::math::tgamma_ratio(x + 0.5, x, in_double);
  return boost::math::tgamma_delta_ratio(x + 0.5, -0.5, in_double);
}

}  // namespace dolp
