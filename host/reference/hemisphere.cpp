// Integrals over the zenith theta_r and the azimuth Delta_phi of the reflected ray, for a fixed zenith theta. Symbols:
// mean = (theta + theta_r)/2, t = tan((theta_r - theta)/2), delta = pi - Delta_phi, s2 = sin^2(delta/2). The angle of
// incidence beta and the tilt alpha of the facet follow from equations (2) and (3) of Wang, Li, Wang 2025, here as sums
// of non-negative terms, in which no digits cancel:
//   cos^2 beta  = cos^2 mean + sin(theta) sin(theta_r) s2
//   sin^2 beta  = t^2/(1 + t^2) + sin(theta) sin(theta_r) cos^2(delta/2)
//   tan^2 alpha = t^2 + (1 + t^2) sin(theta) sin(theta_r) s2 / cos^2 mean
// The facet density D has its peak in the specular direction, t = 0 and delta = 0.
#include "reference/moments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "reference/adaptive.hpp"
#include "reference/fresnel.hpp"

namespace dolp::reference {

using std::numbers::pi;

namespace {

constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The tolerance of the absorbed part is relative to this part or, if it is larger, to this share of the albedo.
constexpr double kSmallAbsorbed = 1e-2;
// Relative rounding error of an elevation, however small (test ReferenceMoments_NextToGrazing_KeepTheirDigits).
constexpr double kElevationRounding = 32.0 * std::numeric_limits<double>::epsilon();
// At theta = 90 degrees the integral over u (zenith_breaks()) ends at -kHorizonGap. A power law gives its rest up to 0.
constexpr double kHorizonGap = 1e-30;
// If theta is this close to the horizon, the integral over theta_r gets additional break points near the horizon.
constexpr double kNearHorizon_rad = 1e-3;
constexpr double kLayerGrowth = 10.0;
constexpr double kInnerShare = 0.02;   // error of an inner integral, relative to the error of the outer integral
constexpr double kInnerFloor = 4e-15;  // least tolerance of an inner integral: rounding errors are about 1e-15
constexpr double kNegligible = 1e-12;  // an integral below this share of the albedo counts as a rounding error

// Tolerance of the masking G: above rounding, but too small to disturb the integral over the azimuth.
double masking_tolerance_for(const Refinement& refinement) {
  return std::max(1e-14, 1e-3 * kInnerShare * refinement.relative_tolerance);
}

// kDiagonal is r_u.
enum Component : std::size_t { kAlbedo, kReflected, kPolarised, kDiagonal, kAbsorbed, kMomentCount };
template <std::size_t N>
Values<N> moment_scales(const Values<N>& value) {
  const double floor = kNegligible * value[kAlbedo] + std::numeric_limits<double>::min();
  const double reflected = std::max(floor, value[kReflected]);
  const double absorbed = std::max(kSmallAbsorbed * value[kAlbedo] + floor, value[kAbsorbed]);
  Values<N> scales{std::max(floor, value[kAlbedo]), reflected, reflected, reflected, absorbed};
  std::fill(scales.begin() + kMomentCount, scales.end(), scales[kAlbedo]);
  return scales;
}

template <std::size_t K>
class Hemisphere {
 public:
  // The inner integral, over the azimuth, gives the moments, r_i for each of K curves and r_q for each curve. The outer
  // integral, over the zenith, adds r_i, r_q and r_u with the factor sky_->value(), and the errors of the inner
  // integrals.
  static constexpr std::size_t kAzimuthCount = kMomentCount + 2 * K;
  static constexpr std::size_t kSkyReflected = kAzimuthCount;
  static constexpr std::size_t kSkyPolarised = kAzimuthCount + 1;
  static constexpr std::size_t kSkyDiagonal = kAzimuthCount + 2;
  static constexpr std::size_t kZenithCount = kAzimuthCount + 3;
  using AzimuthValues = Values<kAzimuthCount>;
  using BothValues = Values<2 * kZenithCount>;

  Hemisphere(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
             const Refinement& refinement, const SkyFunction* sky, const Curves* curves = nullptr)
      : slopes_(slopes),
        masking_(masking),
        theta_rad_(theta_deg * pi / 180.0),
        fixed_(zenith_from_deg(theta_deg)),
        constants_(constants),
        refinement_(refinement),
        sky_(sky),
        curves_(curves) {}

  Integral<2 * kZenithCount> integrate_zenith() {
    constexpr std::size_t kCount = 2 * kZenithCount;
    const Goal goal{.relative = refinement_.relative_tolerance, .subdivisions = refinement_.subdivisions};
    const Breaks breaks = zenith_breaks();
    if (fixed_.cos > 0.0) {
      return integrate<kCount>([this](double u) { return row_values(u); }, breaks, goal, both_scales);
    }
    // At theta = 90 degrees u is negative, and for q < 2 the integrand grows like |u|^(2q - 4) toward u = 0. So the
    // variable is log |u|, and a power law gives the part with |u| < kHorizonGap.
    const auto in_log = [this](double x) {
      BothValues values = row_values(-std::exp(x));
      for (double& value : values) value *= std::exp(x);
      return values;
    };
    const std::vector<double> points = breaks.sorted();
    Breaks log_breaks(std::log(kHorizonGap), std::log(-points.front()));
    for (const double u : points) {
      if (u < 0.0) log_breaks.add(std::log(-u));
    }
    for (const double x : {-40.0, -20.0, -10.0, -5.0, -2.0}) log_breaks.add(x);
    Integral<kCount> result = integrate<kCount>(in_log, log_breaks, goal, both_scales);
    const double power = slopes_.is_gaussian() ? 1.0 : std::min(1.0, 2.0 * slopes_.q() - 3.0);
    const BothValues at_gap = row_values(-kHorizonGap);
    for (std::size_t k = 0; k < result.value.size(); ++k) result.value[k] += kHorizonGap * at_gap[k] / power;
    return result;
  }

  double evaluations() const { return evaluations_; }

 private:
  // Values at one node theta_r of the outer integral. They do not depend on the azimuth.
  struct Row {
    double t;
    double cos2_mean;
    double sin_sin;
    Zenith running;
    Attenuation attenuation;
  };
  // Break points of the outer integral. Its variable is u, with tan((theta_r - theta)/2) = width sinh(u). Among the
  // break points are the specular direction u = 0, kinks of the sky, and those theta_r at which a break point of the
  // inner integral appears or vanishes at an end of its range, Delta_phi = 180 or 0 degrees.
  Breaks zenith_breaks() const {
    const double width = slopes_.width();
    Breaks breaks(std::asinh(-std::tan(0.5 * theta_rad_) / width),
                  std::asinh(std::tan(0.5 * fixed_.elevation_rad) / width));
    for (const double u : {-4.0, -1.5, 0.0, 1.5, 4.0}) breaks.add(u);
    if (fixed_.cos > 0.0 && fixed_.elevation_rad < kNearHorizon_rad) {
      for (double t = std::tan(0.5 * fixed_.elevation_rad); t < width; t *= kLayerGrowth) {
        breaks.add(std::asinh(-t / width));
      }
    }
    std::vector<double> angles;
    for (const double beta : special_beta_rad()) {
      for (const double angle : {2.0 * beta - theta_rad_, theta_rad_ - 2.0 * beta, theta_rad_ + 2.0 * beta}) {
        angles.push_back(angle);
      }
    }
    if (masking_ == Masking::kVCavity || masking_ == Masking::kIntegral) {
      for (const double angle :
           {(pi - theta_rad_) / 3.0, (pi + theta_rad_) / 3.0, pi - 3.0 * theta_rad_, 3.0 * theta_rad_ - pi}) {
        angles.push_back(angle);
      }
    }
    if (sky_) {
      for (const double corner_deg : sky_->corners_deg) angles.push_back(corner_deg * pi / 180.0);
    }
    for (const double angle : angles) {
      if (angle > 0.0 && angle < 0.5 * pi) breaks.add(std::asinh(std::tan(0.5 * (angle - theta_rad_)) / width));
    }
    return breaks;
  }

  // Break points of the integral over the azimuth are the azimuths at which:
  //   beta is one of special_beta_rad()
  //   v-cavity masking reaches 1: (cos theta + cos theta_r) min(cos theta, cos theta_r) = cos^2 beta
  //   the limit b of `integral` masking (see IntegralMasking) reaches pi/2: alpha = 2 max(theta, theta_r) - pi/2
  //   the facet is tilted along the ridge of an elliptic density: sin(theta_r) sin(delta + ridge) = sin(theta)
  //   sin(ridge)
  Breaks azimuth_breaks(const Row& row, double width) const {
    Breaks breaks(0.0, std::asinh(1.0 / width));
    const auto add_s2 = [&](double s2) {
      if (s2 > 0.0 && s2 < 1.0) breaks.add(std::asinh(std::tan(0.5 * std::asin(std::sqrt(s2))) / width));
    };
    if (row.sin_sin > 0.0) {
      for (const double beta : special_beta_rad()) {
        add_s2((std::cos(beta) * std::cos(beta) - row.cos2_mean) / row.sin_sin);
      }
      const double lower_cos = std::min(fixed_.cos, row.running.cos);
      if (masking_ == Masking::kVCavity) {
        add_s2(((fixed_.cos + row.running.cos) * lower_cos - row.cos2_mean) / row.sin_sin);
      }
      const double lower_elevation = std::min(fixed_.elevation_rad, row.running.elevation_rad);
      if (masking_ == Masking::kIntegral && lower_elevation < 0.25 * pi) {
        const double tan_alpha = 1.0 / std::tan(2.0 * lower_elevation);
        add_s2((tan_alpha * tan_alpha - row.t * row.t) * row.cos2_mean / (row.sin_sin * (1.0 + row.t * row.t)));
      }
    }
    const double ridge = slopes_.ridge_rad();
    const double sine = fixed_.sin * std::sin(ridge) / std::max(row.running.sin, 1e-300);
    if (ridge > 0.0 && sine <= 1.0) {
      const double sum = std::asin(sine);
      for (const double delta : {sum - ridge, ridge - sum, pi - sum - ridge})
        breaks.add(std::asinh(std::tan(0.25 * delta) / width));
    }
    breaks.add(1.5);
    breaks.add(4.0);
    return breaks;
  }

  // The variable is v, with tan(delta/4) = width sinh(v). The width is such that D is small beyond about v = 1.
  Integral<kAzimuthCount> integrate_azimuth(const Row& row) {
    const double t2 = row.t * row.t;
    const double scale2 =
        slopes_.width() * slopes_.width() + (slopes_.is_gaussian() ? 0.0 : t2 / std::max(1.0, slopes_.q()));
    const double width2 = 0.25 * scale2 * row.cos2_mean / ((1.0 + t2) * std::max(row.sin_sin, 1e-300));
    const double width = std::min(10.0, std::sqrt(width2));
    const auto in_v = [&](double v) {
      const double x = width * std::sinh(v);
      AzimuthValues values = integrand(row, 4.0 * std::atan(x));
      for (double& value : values) value *= 4.0 * width * std::cosh(v) / (1.0 + x * x);
      evaluations_ += 1.0;
      return values;
    };
    const Goal goal{.relative = std::max(kInnerFloor, kInnerShare * refinement_.relative_tolerance),
                    .max_panels = 200,
                    .subdivisions = refinement_.subdivisions};
    return integrate<kAzimuthCount>(in_v, azimuth_breaks(row, width), goal, moment_scales<kAzimuthCount>);
  }

  static BothValues both_scales(const BothValues& value) {
    BothValues scales;
    scales.fill(kInfinity);
    AzimuthValues moments;
    std::copy_n(value.begin(), moments.size(), moments.begin());
    moments = moment_scales(moments);
    std::copy(moments.begin(), moments.end(), scales.begin());
    scales[kSkyReflected] = scales[kSkyPolarised] = scales[kSkyDiagonal] = moments[kReflected];
    return scales;
  }

  BothValues row_values(double u) {
    const double t = slopes_.width() * std::sinh(u);
    const double half_rad = std::atan(t);
    const double elevation_rad = fixed_.elevation_rad - 2.0 * half_rad;
    const Zenith running{elevation_rad, std::sin(elevation_rad), std::sin(theta_rad_ + 2.0 * half_rad)};
    const double cos_mean = std::sin(fixed_.elevation_rad - half_rad);
    const Row row{t, cos_mean * cos_mean, fixed_.sin * running.sin, running,
                  Attenuation(slopes_, masking_, fixed_, running, masking_tolerance_for(refinement_))};
    const auto inner = integrate_azimuth(row);
    // The first factor 2 is needed because the inner integral covers only half of the azimuths.
    const double jacobian = 2.0 * running.sin * 2.0 * slopes_.width() * std::cosh(u) / (1.0 + t * t);
    BothValues both;
    for (std::size_t k = 0; k < inner.value.size(); ++k) {
      both[k] = jacobian * inner.value[k];
      both[kZenithCount + k] = jacobian * inner.error[k];
    }
    const double g = sky_ ? sky_->value(90.0 - elevation_rad * 180.0 / pi) : 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      both[kSkyReflected + k] = g * both[kReflected + k];
      both[kZenithCount + kSkyReflected + k] = std::abs(g) * both[kZenithCount + kReflected + k];
    }
    return both;
  }

  // Weights of the facets that reflect to azimuths Delta_phi and -Delta_phi. Their slopes are along omega_i + omega_r.
  MirrorWeights mirror_weights(const Row& row, double delta, double tan2_alpha) const {
    const double toward_view = fixed_.sin - row.running.sin * std::cos(delta);
    const double across = row.running.sin * std::sin(delta);
    const double length = std::hypot(toward_view, across);
    if (length == 0.0) return slopes_.mirror_weights(tan2_alpha, 1.0, 0.0);
    return slopes_.mirror_weights(tan2_alpha, toward_view / length, across / length);
  }

  // cos(theta) f cos(theta_r) = D G M / 4. The moments need only three elements of the Mueller matrix M: M00, M01 and,
  // for r_u, (R_s - R_p) / 2 sin(2 chi). chi turns the s axis of the viewer's light into the s axis of the facet, both
  // seen along omega_i: cos(chi) = cos(eta), sin(chi) = -sin(eta). Facets at Delta_phi and -Delta_phi differ in the
  // sign of chi.
  AzimuthValues integrand(const Row& row, double delta) const {
    const double sin_half = std::sin(0.5 * delta);
    const double cos_half = std::cos(0.5 * delta);
    const double s2 = sin_half * sin_half;
    const double cos2_beta = row.cos2_mean + row.sin_sin * s2;
    const double sin2_beta = row.t * row.t / (1.0 + row.t * row.t) + row.sin_sin * cos_half * cos_half;
    const double tan2_alpha = row.t * row.t + (1.0 + row.t * row.t) * row.sin_sin * s2 / row.cos2_mean;
    const double isotropic = 0.25 * slopes_.facet_density(tan2_alpha) * row.attenuation(tan2_alpha, cos2_beta);
    const MirrorWeights weights = mirror_weights(row, delta, tan2_alpha);
    const double bare = isotropic * weights.mean;

    const double cos_beta = std::sqrt(cos2_beta);
    const FresnelCoefficients r = fresnel(constants_, cos_beta);
    // eta is the angle between two planes: the plane of incidence on the facet, and the plane that contains omega_i and
    // z. In the retro direction (beta = 0) eta is undefined. Then nothing is polarised, because r_p = -r_s.
    const double sin_2beta = 2.0 * std::sqrt(cos2_beta * sin2_beta);
    double from_s = 0.5 * (std::norm(r.r_s) + std::norm(r.r_p));
    double from_p = from_s;
    double cos_2eta = 1.0;
    double sin_2eta = 0.0;
    if (sin_2beta > 0.0) {
      const double sin_eta = row.running.sin * std::sin(delta) / sin_2beta;
      const double cos_eta =
          (row.running.cos * fixed_.sin + row.running.sin * fixed_.cos * std::cos(delta)) / sin_2beta;
      from_s = std::norm(r.r_s * cos_eta) + std::norm(r.r_p * sin_eta);
      from_p = std::norm(r.r_s * -sin_eta) + std::norm(r.r_p * cos_eta);
      cos_2eta = cos_eta * cos_eta - sin_eta * sin_eta;
      sin_2eta = 2.0 * sin_eta * cos_eta;
    }
    AzimuthValues values{
        bare, bare * (0.5 * (from_s + from_p)), bare * (0.5 * (from_s - from_p)),
        -isotropic * weights.half_difference * sin_2eta * (0.5 * (std::norm(r.r_s) - std::norm(r.r_p))),
        bare * 0.5 * (r.absorbed_s + r.absorbed_p)};
    if constexpr (K > 0) {
      const std::array<double, kCurves> curves = (*curves_)(cos_beta);
      for (std::size_t k = 0; k < K; ++k) {
        values[kMomentCount + k] = bare * curves[k];
        values[kMomentCount + K + k] = bare * curves[k] * sin2_beta * cos_2eta;
      }
    }
    return values;
  }

  // Angles beta at which the Fresnel coefficients bend sharply: total reflection, and the (pseudo-)Brewster angle; or
  // the rows of measured reflectances.
  std::vector<double> special_beta_rad() const {
    std::vector<double> angles;
    if (constants_.measured) {
      for (const double beta_deg : constants_.measured->beta_deg) angles.push_back(beta_deg * pi / 180.0);
      return angles;
    }
    angles = {std::atan(std::hypot(constants_.index.n, constants_.index.k))};
    if (constants_.index.n < 1.0) angles.push_back(std::asin(constants_.index.n));
    return angles;
  }

  const Slopes& slopes_;
  Masking masking_;
  double theta_rad_;
  Zenith fixed_;
  FacetOptics constants_;
  Refinement refinement_;
  const SkyFunction* sky_;
  const Curves* curves_;
  double evaluations_ = 0.0;
};

// Rounding error of |r_s|^2 and |r_p|^2. The amplitudes have an absolute error, which matters if they are small.
double amplitude_rounding(double reflected, double albedo) {
  return kRounding * (2.0 * std::sqrt(reflected * albedo) + kRounding * albedo);
}

// Sum of the errors of the outer and inner integrals, of the masking G and of rounding. The last two are relative to
// `magnitude`. G_1 is at least 1/2, so its relative error is at most twice its absolute tolerance.
template <std::size_t N>
double integral_error(const Integral<N>& integral, std::size_t k, double magnitude, const Refinement& refinement) {
  const double masking_error = 2.0 * masking_tolerance_for(refinement);
  return integral.error[k] + integral.value[N / 2 + k] + (masking_error + kRounding + kElevationRounding) * magnitude;
}

// The moments for theta -> 90 degrees, if a Cauchy distribution has so many vertical facets that r_i becomes infinite.
// Vertical facets turn the plane of incidence by 90 degrees, so r_q is negative.
Moments divergent_moments(const FacetOptics& constants) {
  const bool is_vacuum = constants == FacetOptics(1.0, 0.0);
  const double grown = is_vacuum ? 0.0 : kInfinity;
  return {.r_i = grown,
          .r_q = -grown,
          .albedo = kInfinity,
          .deficit = -grown,
          .r_i_error = grown,
          .r_q_error = grown,
          .albedo_error = kInfinity,
          .deficit_error = grown,
          .evaluations = 0.0};
}

}  // namespace

Zenith zenith_from_deg(double theta_deg) {
  const double elevation_rad = (90.0 - theta_deg) * pi / 180.0;
  return {elevation_rad, std::sin(elevation_rad), std::sin(theta_deg * pi / 180.0)};
}

Moments hemisphere_moments(const Slopes& slopes, Masking masking, double theta_deg, const FacetOptics& constants,
                           const Refinement& refinement, const SkyFunction* sky) {
  const bool is_unshadowed = masking == Masking::kNone || masking == Masking::kIntegral;
  if (theta_deg == 90.0 && is_unshadowed && !slopes.is_gaussian() && slopes.q() <= 1.5) {
    return divergent_moments(constants);
  }
  using SkyMoments = Hemisphere<0>;
  SkyMoments hemisphere(slopes, masking, theta_deg, constants, refinement, sky);
  const auto integral = hemisphere.integrate_zenith();
  const double cos_theta = zenith_from_deg(theta_deg).cos;
  const auto error_at = [&](std::size_t k) {
    return integral_error(integral, k, integral.value[k == kAlbedo || k == kAbsorbed ? k : kReflected], refinement);
  };
  const double amplitude_error = amplitude_rounding(integral.value[kReflected], integral.value[kAlbedo]);
  Moments moments;
  moments.albedo = integral.value[kAlbedo];
  moments.r_i = integral.value[kReflected];
  moments.r_q = integral.value[kPolarised];
  moments.r_u = integral.value[kDiagonal];
  moments.albedo_error = error_at(kAlbedo);
  moments.r_i_error = error_at(kReflected) + amplitude_error;
  moments.r_q_error = std::max(error_at(kPolarised), error_at(kDiagonal)) + amplitude_error;
  // The deficit is the light that is not reflected. Of its two formulas, cos(theta) - r_i is better if r_i is small.
  const double direct_error = moments.r_i_error + kRounding * cos_theta;
  const double split_error = moments.albedo_error + error_at(kAbsorbed) + kRounding * cos_theta;
  const bool is_split = split_error < direct_error;
  moments.deficit = is_split ? (cos_theta - moments.albedo) + integral.value[kAbsorbed] : cos_theta - moments.r_i;
  moments.deficit_error = is_split ? split_error : direct_error;
  moments.evaluations = hemisphere.evaluations();
  if (sky) {
    const double sky_error = std::max({error_at(SkyMoments::kSkyReflected), error_at(SkyMoments::kSkyPolarised),
                                       error_at(SkyMoments::kSkyDiagonal)}) +
                             amplitude_error;
    moments.columns = {{.i = integral.value[SkyMoments::kSkyReflected],
                        .q = integral.value[SkyMoments::kSkyPolarised],
                        .error = sky_error,
                        .u = integral.value[SkyMoments::kSkyDiagonal]}};
  }
  return moments;
}

std::vector<ColumnMoments> hemisphere_responses(const Slopes& slopes, Masking masking, double theta_deg,
                                                const Curves& curves, double bend, const Refinement& refinement) {
  const FacetOptics bent{1.0 / bend, 0.0};  // its Brewster angle splits the integrals near the bend of `curves`
  const auto integral =
      Hemisphere<kCurves>(slopes, masking, theta_deg, bent, refinement, nullptr, &curves).integrate_zenith();
  std::vector<ColumnMoments> columns;
  for (std::size_t i = kMomentCount, q = i + kCurves; i < kMomentCount + kCurves; ++i, ++q) {
    const auto error = [&](std::size_t k) { return integral_error(integral, k, integral.value[kAlbedo], refinement); };
    columns.push_back({integral.value[i], integral.value[q], std::max(error(i), error(q))});
  }
  return columns;
}

Moments mirror_moments(double theta_deg, const FacetOptics& constants) {
  const Zenith zenith = zenith_from_deg(theta_deg);
  const FresnelCoefficients r = fresnel(constants, zenith.cos);
  const double reflected_s = std::norm(r.r_s);
  const double reflected_p = std::norm(r.r_p);
  Moments moments;
  moments.r_i = 0.5 * (reflected_s + reflected_p) * zenith.cos;
  moments.r_q = zenith.sin > 0.0 ? 0.5 * (reflected_s - reflected_p) * zenith.cos : 0.0;
  moments.albedo = zenith.cos;
  moments.deficit = 0.5 * (r.absorbed_s + r.absorbed_p) * zenith.cos;
  moments.r_i_error = kRounding * moments.r_i + amplitude_rounding(moments.r_i, moments.albedo);
  moments.r_q_error = moments.r_i_error;
  moments.albedo_error = kRounding * moments.albedo;
  moments.deficit_error = kRounding * moments.deficit;
  moments.direct_i = moments.deficit;
  moments.direct_q = zenith.sin > 0.0 ? 0.5 * (r.absorbed_s - r.absorbed_p) * zenith.cos : 0.0;
  moments.direct_i_error = moments.deficit_error;
  moments.direct_q_error = moments.deficit_error;
  moments.evaluations = 1.0;
  return moments;
}

}  // namespace dolp::reference
