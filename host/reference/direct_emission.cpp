#include "reference/moments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "reference/adaptive.hpp"
#include "reference/fresnel.hpp"
#include "reference/slope_plane.hpp"
#include "reference/slopes.hpp"
#include "reference/vectors.hpp"

namespace dolp::reference {

using std::numbers::pi;

namespace {

constexpr double kRounding = 256.0 * std::numeric_limits<double>::epsilon();
// Facets with slopes above kVertical max(1, width) / sin(theta) count as vertical. Relative error: 1 / kVertical.
constexpr double kVertical = 1e10;
constexpr double kSmallestSine = 1e-12;
constexpr double kNoShare = 1e-19;  // a smaller share of the facets emits less than the rounding error
constexpr int kHalvings = 60;

enum Component : std::size_t { kIntensity, kPolarised, kDiagonal, kCount };
using Emitted = Values<kCount>;

using Absorption = std::function<FresnelCoefficients(double cos_beta)>;

// The emission of all facets toward one direction. Tolerances are relative to it or, if `is_response`, to cos(theta).
class Facets {
 public:
  Facets(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants, Absorption absorption,
         bool is_response)
      : slopes_(slopes),
        masking_(masking),
        theta_rad_(theta_deg * pi / 180.0),
        view_(zenith_from_deg(theta_deg)),
        special_(constants),
        absorption_(std::move(absorption)),
        is_response_(is_response),
        smith_(masking == Masking::kSmith ? 1.0 / (1.0 + smith_lambda(slopes.in_view_plane(), view_)) : 1.0) {}

  Moments emission(const Refinement& refinement) {
    const double steepest = end();
    const SlopeTask<kCount> task{.integrand = [this](const SlopePoint& point) { return pair_emission(point); },
                                 .scales = [this](const Emitted& value) { return scales(value); },
                                 .steepest = steepest,
                                 .bends_end = steepest};
    const Integral<2 * kCount> integral = integrate_all_slopes<kCount>(task, slopes_, scan(), refinement, {});
    const Emitted beyond = tail(steepest, refinement);
    const double rounding = (kRounding + 0.5 * refinement.relative_tolerance) * std::abs(beyond[kIntensity]) +
                            kRounding * (is_response_ ? view_.cos : integral.value[kIntensity]) + kNoShare * view_.cos;
    Moments m;
    m.direct_i = integral.value[kIntensity] + beyond[kIntensity];
    m.direct_q = integral.value[kPolarised] + beyond[kPolarised];
    m.direct_u = integral.value[kDiagonal] + beyond[kDiagonal];
    m.direct_i_error = integral.error[kIntensity] + integral.value[kCount + kIntensity] + rounding;
    m.direct_q_error = std::max(integral.error[kPolarised] + integral.value[kCount + kPolarised],
                                integral.error[kDiagonal] + integral.value[kCount + kDiagonal]) +
                       rounding;
    m.evaluations = evaluations_;
    return m;
  }

 private:
  // Projected area of a facet toward the viewer, per horizontal area. `side`: 1 for the azimuth phi, -1 for phi + pi.
  double facing(const SlopePoint& point, double side) const {
    return view_.cos + side * point.t * view_.sin * point.sin_chi;
  }
  Emitted scales(const Emitted& value) const {
    const double scale = is_response_ ? view_.cos : value[kIntensity];
    return {scale, scale, scale};
  }
  RegimeScan scan() const {
    const ScanSteps steps{.halvings = kHalvings, .ridge_rad = slopes_.ridge_rad()};
    return {view_, theta_rad_, steps, [this](const SlopePoint& point) { return regime(point); }};
  }
  Emitted facet_emission(const SlopePoint& point, double side) const {
    const double e = facing(point, side);
    if (e <= 0.0) return {};
    const double cos_alpha = 1.0 / std::sqrt(1.0 + point.t * point.t);
    const Vector<double> normal{side * point.t * cos_alpha, 0.0, cos_alpha};
    const Vector<double> k = -toward_view(point, view_);
    const Bounce<double> b = bounce(k, normal, {0.0, 1.0, 0.0});
    const FresnelCoefficients r = absorption_(e * cos_alpha);
    UnitLight light = unit_light(point, k);
    const Amplitudes<std::complex<double>> s = components(b, light.from_s), p = components(b, light.from_p);
    const double from_s = reflect(b, r, light.from_s);
    const double from_p = reflect(b, r, light.from_p);
    const double visible = masking_ == Masking::kVCavity ? std::min(e, 2.0 * view_.cos) : e * smith_;
    // Half the absorbed U. The emitted U has the other sign, because s = k x z points to the other side.
    const double diagonal = (s.s * std::conj(p.s)).real() * r.absorbed_s + (s.p * std::conj(p.p)).real() * r.absorbed_p;
    return {visible * 0.5 * (from_s + from_p), visible * 0.5 * (from_s - from_p), -visible * diagonal};
  }

  Emitted pair_emission(const SlopePoint& point) {
    evaluations_ += 1.0;
    const Emitted a = facet_emission(point, 1.0);
    const Emitted b = facet_emission(point, -1.0);
    const MirrorWeights weights = slopes_.mirror_weights(point.t * point.t, point.sin_chi, point.cos_chi);
    return {weights.mean * (0.5 * (a[0] + b[0])), weights.mean * (0.5 * (a[1] + b[1])),
            weights.half_difference * (0.5 * (a[2] + b[2]))};
  }

  std::uint64_t regime(const SlopePoint& point) const {
    const double cos_alpha = 1.0 / std::sqrt(1.0 + point.t * point.t);
    std::uint64_t number = 0;
    for (const double side : {1.0, -1.0}) {
      const double e = facing(point, side);
      const bool is_masked = masking_ == Masking::kVCavity && e > 2.0 * view_.cos;
      number = 16 * number + (e > 0.0 ? 8U + (is_masked ? 4U : 0U) + special_.side(e * cos_alpha) : 0U);
    }
    return number;
  }

  // The slope at which the integral ends. Steeper facets count as vertical, or their share is below kNoShare.
  double end() const {
    const double vertical = kVertical * std::max(1.0, slopes_.width()) / std::max(view_.sin, kSmallestSine);
    return std::min(vertical, slopes_.quantile(kNoShare));
  }

  // Emission of facets steeper than t. With smith masking their visible area is proportional to their slope.
  Emitted tail(double t, const Refinement& refinement) {
    const double share = masking_ == Masking::kVCavity ? slopes_.share_above(t) : slopes_.length_above(t) / t;
    if (share < kNoShare) return {};
    Breaks breaks(0.0, 0.5 * pi);
    for (const double chi : scan().chi_breaks(t)) breaks.add(chi);
    const Integral<kCount> row = integrate<kCount>([&](double chi) { return pair_emission(slope_point(t, chi)); },
                                                   breaks, {.relative = refinement.relative_tolerance},
                                                   [this](const Emitted& value) { return scales(value); });
    const double factor = share * 2.0 * std::numbers::inv_pi;
    return {factor * row.value[kIntensity], factor * row.value[kPolarised], factor * row.value[kDiagonal]};
  }

  const Slopes& slopes_;
  Masking masking_;
  double theta_rad_;
  Zenith view_;
  SpecialAngles special_;
  Absorption absorption_;
  bool is_response_;
  double smith_;
  double evaluations_ = 0.0;
};

}  // namespace

Moments direct_emission(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                        const Refinement& refinement) {
  if (zenith_from_deg(theta_deg).cos == 0.0) return {.direct_i = 0.0, .direct_q = 0.0};
  const auto absorption = [&](double cos_beta) { return fresnel(constants, cos_beta); };
  return Facets(slopes, masking, theta_deg, constants, absorption, false).emission(refinement);
}

Moments direct_response(const Slopes& slopes, Masking masking, double theta_deg,
                        const std::function<double(double cos_beta)>& curve, double bend,
                        const Refinement& refinement) {
  const FacetOptics bent{1.0 / bend, 0.0};  // its Brewster angle splits the integral near the bend of `curve`
  const auto absorption = [&](double cos_beta) -> FresnelCoefficients {
    const double sin2_beta = (1.0 - cos_beta) * (1.0 + cos_beta);
    const double f = curve(cos_beta);
    return {0.0, 0.0, f * (1.0 + sin2_beta), f * (1.0 - sin2_beta)};
  };
  return Facets(slopes, masking, theta_deg, bent, absorption, true).emission(refinement);
}

}  // namespace dolp::reference
