#include "model/angles.hpp"

#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cmath>

namespace dolp {

CosSin cos_sin_deg(double angle_deg) {
  // Near 90 degrees the cosine is the sine of the complementary angle. This keeps its relative accuracy.
  const bool is_near_90 = std::abs(angle_deg - 90.0) < 45.0;
  const double cosine =
      is_near_90 ? boost::math::sin_pi((90.0 - angle_deg) / 180.0) : boost::math::cos_pi(angle_deg / 180.0);
  return {cosine, boost::math::sin_pi(angle_deg / 180.0)};
}

}  // namespace dolp
