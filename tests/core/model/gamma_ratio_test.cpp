// The ratio of gamma functions, compared with values in fifty digits.
#include "model/slopes.hpp"

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

namespace dolp {
namespace {

using Fifty = boost::multiprecision::cpp_bin_float_50;

constexpr double kFewRoundings = 2e-15;

TEST(GammaRatio, WholeRange_HasAllDigits) {
  for (const double x : {1e-9, 1e-3, 0.25, 0.5, 0.999, 1.0, 1.25, 4.0, 20.5, 99.75, 170.0, 171.25, 1e3, 1e4, 1e8}) {
    const Fifty exact = boost::math::tgamma_ratio(Fifty(x) + Fifty(0.5), Fifty(x));
    EXPECT_NEAR(gamma_ratio(x) / static_cast<double>(exact), 1.0, kFewRoundings) << x;
  }
}

TEST(GammaRatio, Half_IsOneOverTheRootOfPi) {
  EXPECT_NEAR(gamma_ratio(0.5), boost::math::constants::one_div_root_pi<double>(), kFewRoundings);
}

}  // namespace
}  // namespace dolp
