#include "reference/moments.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>

#include "base/hash.hpp"
#include "reference/adaptive.hpp"
#include "reference/fresnel.hpp"
#include "reference/groove_beam.hpp"
#include "reference/slope_plane.hpp"

namespace dolp::reference {

using std::numbers::pi;

namespace {

using Vector3 = Vector<double>;

constexpr double kRounding = 256.0 * std::numeric_limits<double>::epsilon();
constexpr double kDark = 1e-24;  // light of lower intensity is not followed
// A beam is followed for at most this many bounces. It is unknown whether the remaining light leaves the groove.
constexpr int kMostFollowed = 2000;
constexpr double kSteepest = 1e15;
constexpr double kSteeper = 1.5;
// The integral over slopes ends at a largest slope. Steeper grooves may reflect more, because their light bounces
// another number of times. The program assumes: they reflect at most kTailRoom times as much as a groove of this slope.
constexpr double kTailRoom = 2.0;
constexpr double kTailShare = 0.01;     // share of the tolerance for the light of grooves beyond the largest slope
constexpr double kStepsPerGamma = 3.0;  // ScanSteps::per_gamma
// The integral over slopes is split at bends up to a slope: kSteepestBends or, if smaller, the slope beyond which less
// than the share kBendShare of the light is reflected. The bends at steeper slopes are many and small.
constexpr double kBendShare = 1e-2;
constexpr double kSteepestBends = 10.0;
// An integration is abandoned after kMostBounces bounces (two seconds) and repeated with kLessAmbitious times the
// tolerance. It is not abandoned if its tolerance is kLeastAmbition or more.
constexpr double kMostBounces = 2e7;
constexpr double kLessAmbitious = 100.0;
constexpr double kLeastAmbition = 1e-5;
constexpr double kThinWeight = 0.02;   // SlopeTask::thin_weight
constexpr double kNegligible = 1e-12;  // an integral below this share of the albedo counts as a rounding error
// The quadrature's error estimates are multiplied by this, because they are too small for panels with a bend inside.
constexpr double kBentErrors = 6.0;
// A first rough estimate of the moments uses kLookShares slopes, none above kLookSteepest, and kLookAzimuths azimuths.
constexpr int kLookShares = 16;
constexpr int kLookAzimuths = 16;
constexpr double kLookSteepest = 50.0;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// The fate of the light that enters a groove.
enum Component : std::size_t {
  kAlbedo,        // flux that leaves if the facets absorb nothing
  kReflected,     // I that leaves if unpolarised light enters; at() adds kLost
  kPolarised,     // Q: (I that leaves if s light enters - I that leaves if p light enters) / 2
  kDiagonal,      // U toward the viewer, if unpolarised light of all directions enters
  kAbsorbed,      // absorbed by all bounces
  kLost,          // I that is left after kMostFollowed bounces; it may leave the groove
  kSkyReflected,  // like kReflected, but each ray is multiplied by the function of the sky
  kSkyPolarised,
  kSkyDiagonal,
  kCount
};
using GrooveValues = Values<kCount>;

Groove<double> make_groove(double t) {
  const double cos_alpha = 1.0 / std::sqrt(1.0 + t * t);
  return {cos_alpha, t * cos_alpha};
}

// U of reflected light toward the viewer, from the waves that leave when s or p light of amplitude 1 comes from there.
// The sign changes, because s = k x z of the two directions of propagation points to opposite sides.
double diagonal_light(const UnitLight& light) { return -light.from_p.dot(light.from_s).real(); }

// Adds the fate of the light of `beam`. Returns the number of bounces.
int follow(GrooveBeam<double> beam, const SlopePoint& point, const FacetOptics& constants, const SkyFunction* sky,
           GrooveValues& total) {
  UnitLight light = unit_light(point, beam.direction());
  int count = 0;
  while (beam.flux() > 0.0) {
    ++count;
    const Bounce<double> b = bounce(beam.direction(), beam.normal(), {0.0, 1.0, 0.0});
    const FresnelCoefficients r = fresnel(constants, b.cos_beta);
    const double absorbed = 0.5 * (reflect(b, r, light.from_s) + reflect(b, r, light.from_p));
    total[kAbsorbed] += beam.flux() * absorbed;
    const double left = beam.reflect(b.k_out);
    const double s = light.from_s.squaredNorm();
    const double p = light.from_p.squaredNorm();
    total[kAlbedo] += left;
    total[kReflected] += left * 0.5 * (s + p);
    total[kPolarised] += left * 0.5 * (s - p);
    const double diagonal = diagonal_light(light);
    total[kDiagonal] += left * diagonal;
    if (sky && left > 0.0) {
      const double g = sky->value(std::acos(std::clamp(b.k_out[2], 0.0, 1.0)) * 180.0 / pi);
      total[kSkyReflected] += g * left * 0.5 * (s + p);
      total[kSkyPolarised] += g * left * 0.5 * (s - p);
      total[kSkyDiagonal] += g * left * diagonal;
    }
    const bool is_lost = count == kMostFollowed;
    if (s + p < kDark || is_lost) {
      total[kAlbedo] += beam.flux();
      if (is_lost) total[kLost] += beam.flux() * 0.5 * (s + p);
      break;
    }
  }
  return count;
}

// A Regime: a number that changes at a bend of the integrand. It is a hash over the bounces of a beam. Each bounce
// adds three facts: whether no light, some light or all light leaves the groove; on which side of each special angle
// the angle of incidence lies; how many kinks of the sky have a smaller zenith than the light that leaves.
std::uint64_t history(const SlopePoint& point, const Vector3& omega, Facet first, const SpecialAngles& special,
                      const SkyFunction* sky) {
  std::uint64_t hash = kHashStart;
  GrooveBeam<double> beam(make_groove(point.t), omega, first);
  for (int count = 0; beam.flux() > 0.0 && count < kMostFollowed; ++count) {
    const Vector3 n = beam.normal();
    const double cos_beta = -beam.direction().dot(n);
    const Vector3 out = beam.direction() + 2.0 * cos_beta * n;
    const double left = beam.reflect(out);
    if (sky && left > 0.0) {
      const double zenith_deg = std::acos(std::clamp(out[2], 0.0, 1.0)) * 180.0 / pi;
      const auto above = [&](double corner_deg) { return corner_deg < zenith_deg; };
      hash = hashed(hash, static_cast<std::uint64_t>(std::ranges::count_if(sky->corners_deg, above)));
    }
    const std::uint64_t leaves = (left > 0.0 ? 1U : 0U) + (beam.flux() > 0.0 ? 2U : 0U);
    hash = hashed(hash, 4U * special.side(cos_beta) + leaves);
  }
  return hash;
}

GrooveValues value_scales(const GrooveValues& value) {
  const double floor = kNegligible * value[kAlbedo] + std::numeric_limits<double>::min();
  const double reflected = std::max(floor, value[kReflected]);
  return {std::max(floor, value[kAlbedo]),
          reflected,
          reflected,
          reflected,
          std::max(floor, value[kAbsorbed]),
          kUnlimited,
          reflected,
          reflected,
          reflected};
}

class Surveyor {
 public:
  Surveyor(const Slopes& slopes, double theta_deg, const FacetOptics& constants, const Refinement& refinement,
           const SkyFunction* sky, bool may_abandon)
      : slopes_(slopes),
        theta_rad_(theta_deg * pi / 180.0),
        view_(zenith_from_deg(theta_deg)),
        constants_(constants),
        refinement_(refinement),
        sky_(sky),
        may_abandon_(may_abandon) {}

  /// The moments; meaningless if is_abandoned().
  Moments moments() {
    const GrooveValues expected = look_at_all();
    const auto [bends_end, end] = ends(expected);
    const SpecialAngles special(constants_);
    const ScanSteps steps{.per_gamma = kStepsPerGamma, .ridge_rad = slopes_.ridge_rad()};
    const RegimeScan scan(view_, theta_rad_, steps, [&](const SlopePoint& point) {
      if (is_abandoned()) return std::uint64_t{0};
      const Vector3 omega = toward_view(point, view_);
      return history(point, omega, Facet::kA, special, sky_) * 3 + history(point, omega, Facet::kB, special, sky_);
    });
    const SlopeTask<kCount> task{.integrand = [this](const SlopePoint& point) { return at(point); },
                                 .scales = value_scales,
                                 .steepest = end,
                                 .bends_end = std::min(bends_end, end),
                                 .thin_weight = kThinWeight,
                                 .work = [this] { return bounces_; },
                                 .most_work = kMostBounces};
    const Integral<2 * kCount> integral = integrate_all_slopes<kCount>(
        task, slopes_, scan, {refinement_.relative_tolerance / kBentErrors, refinement_.subdivisions}, expected);

    const double share = slopes_.share_above(end);
    const double tail_weight = share * slopes_.weight_above(end) * view_.cos;
    const GrooveValues at_end = look(end);
    const double tail_most = std::min(tail_weight, kTailRoom * share * at_end[kReflected]);
    const double half_lost = 0.5 * (integral.value[kLost] + integral.value[kCount + kLost]);
    const double unknown = 0.5 * tail_most + half_lost;
    const auto integral_error = [&](std::size_t k) {
      const bool is_own = k == kAlbedo || k == kAbsorbed;
      const double magnitude = is_own ? integral.value[k] : integral.value[kReflected];
      return kBentErrors * (integral.error[k] + integral.value[kCount + k]) + kRounding * magnitude;
    };
    Moments m;
    m.albedo = integral.value[kAlbedo] + tail_weight;
    m.r_i = integral.value[kReflected] + 0.5 * tail_most - half_lost;
    m.r_q = integral.value[kPolarised];
    m.r_u = integral.value[kDiagonal];
    m.deficit = integral.value[kAbsorbed] + (tail_weight - 0.5 * tail_most) + half_lost;
    m.albedo_error = integral_error(kAlbedo) + kRounding * tail_weight;
    // Amplitudes have an absolute rounding error, so their squares have a large relative error if the index is near 1.
    const double amplitude_error = kRounding * (std::sqrt(m.r_i * m.albedo) + kRounding * m.albedo);
    m.r_i_error = integral_error(kReflected) + unknown + amplitude_error;
    m.r_q_error = std::max({integral_error(kPolarised), integral_error(kDiagonal), integral_error(kReflected)}) +
                  2.0 * unknown + amplitude_error;
    m.deficit_error = integral_error(kAbsorbed) + unknown + kRounding * tail_weight;
    if (sky_) {
      const double sky_error = std::max(
          {integral_error(kSkyReflected), integral_error(kSkyPolarised), integral_error(kSkyDiagonal), m.r_i_error});
      m.columns = {{.i = integral.value[kSkyReflected],
                    .q = integral.value[kSkyPolarised],
                    .error = sky_error + 2.0 * unknown + tail_most + half_lost,
                    .u = integral.value[kSkyDiagonal]}};
    }
    return m;
  }

  bool is_abandoned() const { return may_abandon_ && bounces_ > kMostBounces; }
  double evaluations() const { return evaluations_; }

 private:
  GrooveValues at(const SlopePoint& point) {
    if (is_abandoned()) return {};
    const Groove<double> groove = make_groove(point.t);
    const Vector3 omega = toward_view(point, view_);
    GrooveValues values{};
    for (const Facet first : {Facet::kA, Facet::kB})
      bounces_ += follow({groove, omega, first}, point, constants_, sky_, values);
    evaluations_ += 1.0;
    const MirrorWeights weights = slopes_.mirror_weights(point.t * point.t, point.sin_chi, point.cos_chi);
    for (double& value : values) value *= 0.5 / groove.cos_alpha;  // per width of the groove
    values[kReflected] += values[kLost];
    for (std::size_t k = 0; k < kCount; ++k) {
      const bool is_diagonal = k == kDiagonal || k == kSkyDiagonal;
      values[k] *= is_diagonal ? weights.half_difference : weights.mean;
    }
    return values;
  }
  GrooveValues look(double t) {
    GrooveValues mean{};
    for (int i = 0; i < kLookAzimuths; ++i) {
      const GrooveValues value = at(slope_point(t, 0.5 * pi * (i + 0.5) / kLookAzimuths));
      for (std::size_t k = 0; k < kCount; ++k) mean[k] += value[k] / kLookAzimuths;
    }
    return mean;
  }
  GrooveValues look_at_all() {
    GrooveValues mean{};
    for (int i = 0; i < kLookShares; ++i) {
      const double t = std::min(kLookSteepest, slopes_.quantile((i + 0.5) / kLookShares));
      const GrooveValues value = look(t);
      for (std::size_t k = 0; k < kCount; ++k) mean[k] += value[k] / kLookShares;
    }
    return mean;
  }

  struct Ends {
    double bends;  ///< the integral over slopes is split at bends up to this slope
    double all;    ///< the integral over slopes ends at this slope
  };
  // The integral ends where its rest is negligible or where most reflected light needs more than kMostFollowed bounces.
  Ends ends(const GrooveValues& expected) {
    const double scale = std::min(expected[kReflected], expected[kAbsorbed]);
    Ends ends{kSteepestBends, kSteepest};
    for (double t = 2.0 * slopes_.width(); t < kSteepest; t *= kSteeper) {
      const GrooveValues light = look(t);
      const double beyond = kTailRoom * slopes_.share_above(t) * light[kReflected];
      const bool is_followed = light[kLost] < 0.5 * light[kReflected];
      if (beyond < kBendShare * scale) ends.bends = std::min(ends.bends, t);
      ends.all = t;
      if (!is_followed || beyond < kTailShare * refinement_.relative_tolerance * scale) break;
    }
    return ends;
  }

  const Slopes& slopes_;
  double theta_rad_;
  Zenith view_;
  FacetOptics constants_;
  Refinement refinement_;
  const SkyFunction* sky_;
  bool may_abandon_;
  double bounces_ = 0.0;
  double evaluations_ = 0.0;
};

}  // namespace

Moments groove_moments(const Slopes& slopes, double theta_deg, const FacetOptics& constants,
                       const Refinement& refinement, const SkyFunction* sky) {
  if (zenith_from_deg(theta_deg).cos == 0.0)
    return {.direct_i = 0.0, .direct_q = 0.0, .columns = std::vector<ColumnMoments>(sky ? 1 : 0)};
  double evaluations = 0.0;
  for (Refinement attempted = refinement;; attempted.relative_tolerance *= kLessAmbitious) {
    const bool is_last = attempted.relative_tolerance >= kLeastAmbition;
    Surveyor surveyor(slopes, theta_deg, constants, attempted, sky, !is_last);
    Moments moments = surveyor.moments();
    evaluations += surveyor.evaluations();
    moments.evaluations = evaluations;
    if (!surveyor.is_abandoned()) return moments;
  }
}

}  // namespace dolp::reference
