// Elementary functions and Fresnel reflection of the kernel source in float and double, compared with more precise
// values. Each test prints its worst error even if it passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_complex.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#define DOLP_KERNEL_NAMESPACE tested_float
#include "evaluate/kernel/kernel_source.hpp"
#undef DOLP_KERNEL_NAMESPACE

#define DOLP_KERNEL_NAMESPACE tested_double
#define DOLP_DOUBLE
#include "evaluate/kernel/kernel_source.hpp"
#undef DOLP_DOUBLE
#undef DOLP_KERNEL_NAMESPACE

namespace dolp::kernel_source_test {
namespace {

/// The number type of a kernel source: float or double.
template <class Source>
using RealOf = std::remove_const_t<decltype(Source::kPi)>;

template <class Source>
constexpr double kEpsilon = static_cast<double>(std::numeric_limits<RealOf<Source>>::epsilon());

using Sources = ::testing::Types<tested_float::KernelSource, tested_double::KernelSource>;

struct SourceNames {
  template <class Source>
  static std::string GetName(int) {
    return std::is_same_v<RealOf<Source>, float> ? "Float" : "Double";
  }
};

/// A refractive index converted to the number type of the source.
template <class Source>
typename Source::IndexNode index_in(const kernel::IndexNode& node) {
  return convert_reals<RealOf<Source>, typename Source::IndexNode, double>(node);
}

/// The largest error so far, and its argument.
struct Worst {
  double value = 0.0;
  std::string where;
  void update(double candidate, const std::string& here) {
    if (candidate <= value) return;
    value = candidate;
    where = here;
  }
};

using std::numbers::pi;

constexpr unsigned kSeed = 20250801;
constexpr int kSamples = 20000;

// ---- Elementary functions ------------------------------------------------------------------------------------------

// Difference of `value` and `exact` in ulps. An ulp is a unit of the last place of `exact` in the type Real.
template <class Real>
double ulps(Real value, long double exact) {
  using Limits = std::numeric_limits<Real>;
  const int exponent = exact == 0.0L ? Limits::min_exponent : std::max(std::ilogb(exact) + 1, Limits::min_exponent);
  const long double ulp = std::ldexp(1.0L, exponent - Limits::digits);
  return static_cast<double>(std::fabs(static_cast<long double>(value) - exact) / ulp);
}

enum class Spacing { kUniform, kLogarithmic };

struct Range {
  double low;
  double high;
  Spacing spacing;
};

// A function of the kernel source, its reference, ranges of its argument, and its largest allowed error.
template <class Source>
struct Row {
  using Real = RealOf<Source>;
  const char* name;
  std::function<Real(Source&, Real)> source;
  std::function<long double(long double)> reference;
  std::vector<Range> ranges;
  double allowed_ulps;
};

template <class Source>
void expect_few_ulps(const Row<Source>& row, const Range& range) {
  using Real = RealOf<Source>;
  std::mt19937 random(kSeed);
  const bool is_log = range.spacing == Spacing::kLogarithmic;
  std::uniform_real_distribution<double> position(is_log ? std::log(range.low) : range.low,
                                                  is_log ? std::log(range.high) : range.high);
  Source source;
  Worst worst;
  for (int i = 0; i < kSamples + 2; ++i) {
    const double drawn = position(random);
    double x = is_log ? std::exp(drawn) : drawn;
    if (i >= kSamples) x = i == kSamples ? range.low : range.high;
    const Real argument = static_cast<Real>(x);
    const double error = ulps(row.source(source, argument), row.reference(static_cast<long double>(argument)));
    EXPECT_TRUE(std::isfinite(error)) << row.name << " at " << x;
    worst.update(error, std::to_string(x));
  }
  std::printf("seed %u: %-16s %9.3g .. %-9.3g worst %.2f ulp at %s (allowed %.1f)\n", kSeed, row.name, range.low,
              range.high, worst.value, worst.where.c_str(), row.allowed_ulps);
  EXPECT_LE(worst.value, row.allowed_ulps) << row.name;
}

template <class Source>
class Elementary : public ::testing::Test {};
TYPED_TEST_SUITE(Elementary, Sources, SourceNames);

// Allowed error in ulps. The last two or three roundings cause half an ulp each. The rest is for the rounding error in
// the argument of the series. The comments of the kernel source promise "a few units in the last place".
constexpr double kFewUlps = 3.0;
// The functions acosh, atan and acos first compute roots and quotients, and then a series of the result. Each root and
// each quotient adds a rounding error.
constexpr double kRootUlps = 6.0;

TYPED_TEST(Elementary, Functions_OverTheirDomain_AreAFewUlpsFromExact) {
  using enum Spacing;
  const double lowest = static_cast<double>(TypeParam::kLowestExponent);
  const std::vector<Row<TypeParam>> rows = {
      {"expm1_real",
       [](auto& source, auto x) { return source.expm1_real(x); },
       [](auto x) { return std::expm1(x); },
       {{-80.0, 80.0, kUniform}, {1e-30, 80.0, kLogarithmic}},
       kFewUlps},
      {"expm1_real(-x)",
       [](auto& source, auto x) { return -source.expm1_real(-x); },
       [](auto x) { return -std::expm1(-x); },
       {{1e-30, 80.0, kLogarithmic}},
       kFewUlps},
      {"exp_real",
       [](auto& source, auto x) { return source.exp_real(x); },
       [](auto x) { return std::exp(x); },
       {{lowest, 80.0, kUniform}, {-1.0, 1.0, kUniform}},
       kFewUlps},
      {"sinh_cosh.x",
       [](auto& source, auto x) { return source.sinh_cosh(x).x; },
       [](auto x) { return std::sinh(x); },
       {{1e-30, 80.0, kLogarithmic}},
       kFewUlps},
      {"sinh_cosh.y",
       [](auto& source, auto x) { return source.sinh_cosh(x).y; },
       [](auto x) { return std::cosh(x); },
       {{1e-30, 80.0, kLogarithmic}},
       kFewUlps},
      {"log1p_real",
       [](auto& source, auto x) { return source.log1p_real(x); },
       [](auto x) { return std::log1p(x); },
       {{1e-30, 1e30, kLogarithmic}, {0.0, 4.0, kUniform}},
       kFewUlps},
      {"log1p_square",
       [](auto& source, auto x) { return source.log1p_square(x); },
       [](auto x) { return std::log1p(x * x); },
       {{1e-15, 1e30, kLogarithmic}},
       kFewUlps},
      {"asinh_real",
       [](auto& source, auto x) { return source.asinh_real(x); },
       [](auto x) { return std::asinh(x); },
       {{1e-30, 1e30, kLogarithmic}, {0.0, 4.0, kUniform}},
       kFewUlps},
      {"acosh_above_1",
       [](auto& source, auto x) { return source.acosh_above_1(x); },
       [](auto x) { return std::log1p(x + std::sqrt(x * (x + 2.0L))); },
       {{1e-30, 1e15, kLogarithmic}},
       kRootUlps},
      {"arc_tangent",
       [](auto& source, auto x) { return source.arc_tangent(x); },
       [](auto x) { return std::atan(x); },
       {{1e-30, 1e30, kLogarithmic}, {0.0, 2.0, kUniform}},
       kRootUlps},
      {"arc_cosine",
       [](auto& source, auto x) { return source.arc_cosine(x); },
       [](auto x) { return std::acos(x); },
       {{-1.0, 1.0, kUniform}},
       kRootUlps},
  };
  for (const Row<TypeParam>& row : rows) {
    for (const Range& range : row.ranges) expect_few_ulps(row, range);
  }
}

// ---- Fresnel reflection --------------------------------------------------------------------------------------------

using Wide = boost::multiprecision::cpp_bin_float_50;
using WideComplex = boost::multiprecision::cpp_complex_50;

// Fresnel's equations in textbook form, with 50 digits. Cancellation costs at most 27 digits.
struct ExactFresnel {
  Wide r_s;
  Wide r_p;
  Wide sin2_beta;
};

ExactFresnel exact_fresnel(const kernel::IndexNode& index, double cos_beta) {
  const Wide c = cos_beta;
  const Wide sin2 = 1 - c * c;
  const WideComplex n2(Wide(index.n2m1_re) + 1, Wide(index.n2m1_im));
  const WideComplex w = sqrt(WideComplex(n2 - sin2));
  const WideComplex r_s = (c - w) / (c + w);
  const WideComplex r_p = (n2 * c - w) / (n2 * c + w);
  return {norm(r_s).real(), norm(r_p).real(), sin2};
}

double relative_error(double value, const Wide& exact) {
  return static_cast<double>(abs(Wide(value) - exact) / abs(exact));
}

// The index, rounded to the number type of the source. Source and reference both use it, so this rounding is no error.
template <class Source>
kernel::IndexNode rounded_index(const OpticalConstants& index) {
  MomentsRequest request;
  request.optics = {index};
  return convert_reals<double, kernel::IndexNode, RealOf<Source>>(index_in<Source>(kernel_data(request).indices[0]));
}

std::vector<double> cosines_of_incidence() {
  std::vector<double> cosines;
  for (double beta_deg = 0.5; beta_deg < 90.0; beta_deg += 0.5) cosines.push_back(std::cos(beta_deg * pi / 180.0));
  for (const double beta_deg : {1e-3, 0.02, 0.1, 89.9, 89.99, 89.999}) {
    cosines.push_back(std::cos(beta_deg * pi / 180.0));
  }
  return cosines;
}

template <class Source>
class FresnelSource : public ::testing::Test {};
TYPED_TEST_SUITE(FresnelSource, Sources, SourceNames);

// Allowed relative error in ulps, for about twenty roundings that no subtraction amplifies.
constexpr double kFresnelUlps = 12.0;

TYPED_TEST(FresnelSource, AllIndices_AgreeWithTheTextbookFormIn50Digits) {
  using Real = RealOf<TypeParam>;
  TypeParam source;
  const std::vector<OpticalConstants> indices = {{1.01, 0.0}, {1.508, 0.0}, {4.0, 0.0},       {0.9, 0.3}, {0.2, 3.0},
                                                 {1.5, 1e-3}, {27.0, 90.0}, {1000.0, 1000.0}, {1e6, 1e6}};
  for (const OpticalConstants& optical : indices) {
    const kernel::IndexNode index = rounded_index<TypeParam>(optical);
    Worst r_s;
    Worst absorbed;
    Worst split;
    Worst r_p;
    for (const double exact_cos : cosines_of_incidence()) {
      const Real cos_beta = static_cast<Real>(exact_cos);
      if (cos_beta == Real(1)) continue;  // in the reference (R_s - R_p)/sin^2(beta) is 0/0
      const auto f = source.fresnel(index_in<TypeParam>(index), cos_beta);
      const ExactFresnel exact = exact_fresnel(index, static_cast<double>(cos_beta));
      const std::string where = "cos(beta) = " + std::to_string(exact_cos);
      r_s.update(relative_error(f.r_s, exact.r_s), where);
      absorbed.update(relative_error(f.absorbed_s, 1 - exact.r_s), where);
      split.update(relative_error(f.split_over_sin2, (exact.r_s - exact.r_p) / exact.sin2_beta), where);
      const Wide recovered = Wide(f.r_s) - Wide(f.split_over_sin2) * exact.sin2_beta;
      r_p.update(static_cast<double>(abs(recovered - exact.r_p) / exact.r_s), where);
    }
    const double unit = kEpsilon<TypeParam>;
    std::printf("%g + %gi: worst relative errors in ulp: R_s %.1f, 1 - R_s %.1f, R_s - R_p %.1f, R_p/R_s %.1f\n",
                optical.n, optical.k, r_s.value / unit, absorbed.value / unit, split.value / unit, r_p.value / unit);
    EXPECT_LE(r_s.value, kFresnelUlps * unit) << r_s.where;
    EXPECT_LE(absorbed.value, kFresnelUlps * unit) << absorbed.where;
    EXPECT_LE(split.value, kFresnelUlps * unit) << split.where;
    EXPECT_LE(r_p.value, kFresnelUlps * unit) << r_p.where;
  }
}

TYPED_TEST(FresnelSource, TotalReflection_AbsorbsExactlyNothing) {
  using Real = RealOf<TypeParam>;
  TypeParam source;
  for (const double n : {0.1, 0.5, 0.9, 0.999}) {
    const kernel::IndexNode index = rounded_index<TypeParam>({n, 0.0});
    ASSERT_GT(index.critical_cos, 0.0);
    // Keeps n^2 - 1 + cos^2(beta) below 0 in spite of rounding.
    const double roundoff = 8.0 * kEpsilon<TypeParam>;
    for (int i = 0; i < 100; ++i) {
      const Real cos_beta = static_cast<Real>(index.critical_cos * (1.0 - roundoff) * (i + 0.5) / 100.0);
      const auto f = source.fresnel(index_in<TypeParam>(index), cos_beta);
      EXPECT_EQ(f.absorbed_s, Real(0));
      EXPECT_EQ(f.split_over_sin2, Real(0));
      EXPECT_NEAR(static_cast<double>(f.r_s), 1.0, kFresnelUlps * kEpsilon<TypeParam>);
    }
    const Real above = static_cast<Real>(index.critical_cos + 0.5 * (1.0 - index.critical_cos));
    const auto f = source.fresnel(index_in<TypeParam>(index), above);
    const ExactFresnel exact = exact_fresnel(index, static_cast<double>(above));
    // Beside the critical angle, the subtraction in n^2 - 1 + cos^2(beta) amplifies the rounding error of cos^2(beta).
    EXPECT_LE(relative_error(f.absorbed_s, 1 - exact.r_s), 3.0 * kFresnelUlps * kEpsilon<TypeParam>) << n;
    EXPECT_GT(f.absorbed_s, Real(0));
  }
}

}  // namespace
}  // namespace dolp::kernel_source_test
