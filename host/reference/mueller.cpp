#include "reference/mueller.hpp"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_complex.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>

#include "reference/film_spread.hpp"
#include "reference/fresnel.hpp"
#include "reference/groove_beam.hpp"
#include "reference/moments.hpp"
#include "reference/slopes.hpp"
#include "reference/vectors.hpp"

namespace dolp {

namespace {

// In the textbook formulas digits cancel near grazing, the retro direction and the critical angle; 34 digits suffice.
using Real = boost::multiprecision::cpp_bin_float_quad;
using Complex = boost::multiprecision::cpp_complex_quad;
using Vector = reference::Vector<Real>;
template <class Number>
using Jones = std::array<std::array<Number, 2>, 2>;

constexpr double kMaskingTolerance = 1e-13;
constexpr double kRetro = 1e-50;  // if sin^2(2 beta) is smaller, the plane of incidence is undefined
// h: horizontal part of omega_i + omega_r. If |h|^2 is smaller, omega_r is the mirror direction: the result is NaN.
constexpr double kMirrored = 1e-50;
constexpr int kMostMuellerBounces = 2000;
constexpr int kMostInQuad = 24;  // light with more bounces is weak, so it is computed in double
// The sum over bounces ends when its latest kIdleBounces terms together are at most the share kIdleShare of the sum.
constexpr int kIdleBounces = 8;
constexpr double kIdleShare = 1e-14;

using reference::cross;
using reference::dot;
using reference::scaled;
using reference::sum;
using reference::unit;

/// A beam: k is its direction of propagation, s = k x z / |k x z| and p = k x s.
struct BeamFrame {
  Vector k;
  Vector s;
  Vector p;
};

Real radians(double angle_deg) { return Real(angle_deg) * boost::math::constants::pi<Real>() / 180; }

Vector toward(double zenith_deg, double azimuth_deg) {
  const Real zenith = radians(zenith_deg);
  const Real azimuth = radians(azimuth_deg);
  return {sin(zenith) * cos(azimuth), sin(zenith) * sin(azimuth), cos(zenith)};
}

/// The beam from the source, at azimuth 0. At zenith 0, s is the limit of k x z.
BeamFrame incident_beam(double zenith_deg) {
  const Vector k = scaled<Real>(-1, toward(zenith_deg, 0.0));
  const Vector s{0, 1, 0};
  return {k, s, cross(k, s)};
}

BeamFrame reflected_beam(double zenith_deg, double azimuth_deg) {
  const Vector k = toward(zenith_deg, azimuth_deg);
  const Real azimuth = radians(azimuth_deg);
  const Vector s{sin(azimuth), -cos(azimuth), 0};
  return {k, s, cross(k, s)};
}

template <class Number>
reference::Amplitudes<Number> fresnel_amplitudes(const FacetOptics& constants,
                                                 const typename Number::value_type& cos_beta,
                                                 const typename Number::value_type& sin2_beta) {
  if (!constants.films.empty()) return reference::stack_amplitudes<Number>(constants, cos_beta, sin2_beta);
  if (constants.measured) {
    const reference::FresnelCoefficients r = reference::fresnel(constants, static_cast<double>(cos_beta));
    return {Number(r.r_s.real()), Number(r.r_p.real())};
  }
  const Number n(constants.index.n, constants.index.k);
  const Number n2 = n * n;
  const Number w = sqrt(Number(n2 - sin2_beta));
  return {(cos_beta - w) / (cos_beta + w), (n2 * cos_beta - w) / (n2 * cos_beta + w)};
}

// Column 0: s and p amplitudes after reflection of an s wave of amplitude 1. Column 1: the same for a p wave. If light
// goes straight back, the plane of incidence is undefined. Any direction in the facet can be facet_s, as r_p = -r_s.
Jones<Complex> jones_matrix(const BeamFrame& in, const BeamFrame& out, const reference::Amplitudes<Complex>& r) {
  const Vector normal = cross(in.k, out.k);
  const Vector facet_s = dot(normal, normal) > kRetro ? unit(normal) : in.s;
  const Vector facet_in_p = cross(in.k, facet_s);
  const Vector facet_out_p = cross(out.k, facet_s);
  const std::array<Vector, 2> incident{in.s, in.p};
  const std::array<Vector, 2> reflected{out.s, out.p};
  Jones<Complex> jones;
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < 2; ++column) {
      jones[row][column] = dot(reflected[row], facet_s) * r.s * dot(facet_s, incident[column]) +
                           dot(reflected[row], facet_out_p) * r.p * dot(facet_in_p, incident[column]);
    }
  }
  return jones;
}

// Element (a, b) is half the trace of sigma_a J sigma_b J^+. `basis` holds the matrices sigma of I, Q, U and V.
template <class Number>
ReferenceMueller mueller_from_jones(const Jones<Number>& jones) {
  using Matrix = Jones<Number>;
  const Number zero(0), one(1), i(0, 1);
  const std::array<Matrix, 4> basis{Matrix{{{one, zero}, {zero, one}}}, Matrix{{{one, zero}, {zero, -one}}},
                                    Matrix{{{zero, one}, {one, zero}}}, Matrix{{{zero, -i}, {i, zero}}}};
  ReferenceMueller mueller{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      Number trace = zero;
      for (std::size_t e = 0; e < 16; ++e) {
        const std::size_t w = e / 8, x = e / 4 % 2, y = e / 2 % 2, z = e % 2;
        trace += basis[a][w][x] * jones[x][y] * basis[b][y][z] * conj(jones[w][z]);
      }
      mueller[a][b] = 0.5 * static_cast<double>(trace.real());
    }
  }
  return mueller;
}

ReferenceMueller scaled_matrix(ReferenceMueller mueller, double factor) {
  for (auto& row : mueller) {
    for (double& element : row) element *= factor;
  }
  return mueller;
}

void add(ReferenceMueller& total, const ReferenceMueller& term) {
  for (std::size_t i = 0; i < 16; ++i) total[i / 4][i % 4] += term[i / 4][i % 4];
}

/// The plane across the grooves that reflect the beam `in` into the beam `out`. The horizontal direction u of the plane
/// is along the horizontal part of omega_i + omega_r if `sign` is 1, against this part if `sign` is -1.
struct GroovePlane {
  Vector u, v;
  Real across;        ///< length of the horizontal part of omega_i + omega_r
  Real psi_i, psi_r;  ///< angles of omega_i and omega_r from z toward u

  GroovePlane(const BeamFrame& in, const BeamFrame& out, int sign) {
    const Vector horizontal{out.k[0] - in.k[0], out.k[1] - in.k[1], 0};
    across = sqrt(dot(horizontal, horizontal));
    u = scaled<Real>(sign / across, horizontal);
    v = {-u[1], u[0], 0};
    psi_i = atan2(-dot(in.k, u), -in.k[2]);
    psi_r = atan2(dot(out.k, u), out.k[2]);
  }
  Vector in_groove(const Vector& a) const { return {dot(a, u), dot(a, v), a[2]}; }
  /// Half-angle of the groove that reflects `in` into `out` in `bounces` bounces, if the first bounce is at facet A.
  Real gamma(int bounces) const {
    const Real turn = bounces % 2 == 1 ? Real(psi_i + psi_r) : Real(psi_i - psi_r);
    return (boost::math::constants::pi<Real>() - turn) / (2 * bounces);
  }
};

// Weight of the facets whose normal is tilted toward `horizontal`, for slopes that differ along and across. Their
// azimuths count from the horizontal direction of the viewer, who receives the beam `out`.
double facet_weight(const reference::Slopes& slopes, double tan2_alpha, const Vector& horizontal,
                    const BeamFrame& out) {
  const Vector viewer{-out.s[1], out.s[0], 0};
  const Real length = sqrt(Real(horizontal[0] * horizontal[0] + horizontal[1] * horizontal[1]));
  if (length == 0) return slopes.weight(tan2_alpha, 1.0, 0.0);
  const Real cos_phi = (viewer[0] * horizontal[0] + viewer[1] * horizontal[1]) / length;
  const Real sin_phi = (viewer[0] * horizontal[1] - viewer[1] * horizontal[0]) / length;
  return slopes.weight(tan2_alpha, static_cast<double>(cos_phi), static_cast<double>(sin_phi));
}

template <class Number>
using RealVector = reference::Vector<typename Number::value_type>;

template <class Number>
RealVector<Number> rounded(const Vector& a) {
  using Part = typename Number::value_type;
  return {static_cast<Part>(a[0]), static_cast<Part>(a[1]), static_cast<Part>(a[2])};
}

template <class Number>
std::array<Number, 3> electric(const RealVector<Number>& a) {
  return {Number(a[0]), Number(a[1]), Number(a[2])};
}

template <class Number>
Number along(const RealVector<Number>& a, const std::array<Number, 3>& e) {
  return a[0] * e[0] + a[1] * e[1] + a[2] * e[2];
}

// The contribution of one GroovePlane to reference_bounces(). Light meets facet A first. `Number`: a complex type.
template <class Number>
ReferenceMueller bounces_in_plane(const reference::Slopes& slopes, const FacetOptics& constants, const BeamFrame& in,
                                  const BeamFrame& out, const GroovePlane& plane, int bounces) {
  using Part = typename Number::value_type;
  const Real gamma = plane.gamma(bounces);
  if (gamma <= 0 || 2 * gamma >= boost::math::constants::pi<Real>()) return {};
  const auto in_groove = [&](const Vector& a) { return rounded<Number>(plane.in_groove(a)); };
  const reference::Groove<Part> groove{static_cast<Part>(sin(gamma)), static_cast<Part>(cos(gamma))};
  reference::GrooveBeam<Part> beam(groove, in_groove(scaled<Real>(-1, in.k)), reference::Facet::kA);
  std::array waves{electric<Number>(in_groove(in.s)), electric<Number>(in_groove(in.p))};
  Part left = 0;
  for (int i = 0; i < bounces; ++i) {
    if (beam.flux() <= 0) return {};
    const auto b = reference::bounce<Part>(beam.direction(), beam.normal(), {0, 1, 0});
    const auto r = fresnel_amplitudes<Number>(constants, b.cos_beta, 1 - b.cos_beta * b.cos_beta);
    for (auto& e : waves) e = reference::reflected(b, reference::components(b, e), r);
    left = beam.reflect(b.k_out);
  }
  if (left <= 0) return {};
  const auto s = in_groove(out.s);
  const auto p = in_groove(out.p);
  const Jones<Number> jones{{{along<Number>(s, waves[0]), along<Number>(s, waves[1])},
                             {along<Number>(p, waves[0]), along<Number>(p, waves[1])}}};
  const auto cotangent = static_cast<double>(cos(gamma) / sin(gamma));
  const auto factor = static_cast<double>(cos(gamma) * left / (2 * bounces * plane.across));
  const double tan2_alpha = cotangent * cotangent;
  const double density = slopes.facet_density(tan2_alpha) * facet_weight(slopes, tan2_alpha, plane.u, out);
  return scaled_matrix(mueller_from_jones(jones), density * factor);
}

/// Two beams, and the planes across the two kinds of grooves that reflect one beam into the other (`sign` 1 and -1).
struct GroovePair {
  BeamFrame in, out;
  GroovePlane toward, against;

  explicit GroovePair(const BeamAngles& angles)
      : in(incident_beam(angles.theta_i_deg)),
        out(reflected_beam(angles.theta_r_deg, angles.delta_phi_deg)),
        toward(in, out, 1),
        against(in, out, -1) {}
  bool is_mirrored() const { return toward.across * toward.across < kMirrored; }
  ReferenceMueller term(const reference::Slopes& slopes, const FacetOptics& constants, int bounces) const {
    const auto& in_plane = bounces > kMostInQuad ? bounces_in_plane<std::complex<double>> : bounces_in_plane<Complex>;
    ReferenceMueller total = in_plane(slopes, constants, in, out, toward, bounces);
    add(total, in_plane(slopes, constants, in, out, against, bounces));
    return total;
  }
  /// True if rays with `bounces` or more bounces cannot leave at the angle psi_r.
  bool is_beyond(int bounces) const {
    const Real widest = std::max(toward.gamma(bounces), against.gamma(bounces));
    return abs(Real(abs(toward.psi_i) - abs(toward.psi_r))) > 4 * widest;
  }
};

ReferenceMueller not_a_number() {
  ReferenceMueller mueller;
  for (auto& row : mueller) row.fill(std::numeric_limits<double>::quiet_NaN());
  return mueller;
}

}  // namespace

ReferenceMueller reference_bounces(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                   double theta_r_deg, double delta_phi_deg, int bounces) {
  const GroovePair pair({theta_i_deg, theta_r_deg, delta_phi_deg});
  if (pair.is_mirrored()) return not_a_number();
  return pair.term(reference::Slopes(surface.distribution, surface.sigma, surface.q), constants, bounces);
}

BouncesSum reference_all_bounces(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                 double theta_r_deg, double delta_phi_deg) {
  const reference::Slopes slopes(surface.distribution, surface.sigma, surface.q);
  return reference_all_bounces(slopes, constants, {theta_i_deg, theta_r_deg, delta_phi_deg});
}

BouncesSum reference_all_bounces(const reference::Slopes& slopes, const FacetOptics& constants,
                                 const BeamAngles& angles) {
  const GroovePair pair(angles);
  if (pair.is_mirrored()) return {not_a_number(), std::numeric_limits<double>::quiet_NaN()};
  BouncesSum sum;
  std::array<double, kIdleBounces> latest{};
  double recent = 0.0;
  for (int k = 1; k <= kMostMuellerBounces; ++k) {
    if (pair.is_beyond(k)) return sum;
    const ReferenceMueller term = pair.term(slopes, constants, k);
    add(sum.matrix, term);
    latest[static_cast<std::size_t>(k % kIdleBounces)] = term[0][0];
    recent = 0.0;
    for (const double value : latest) recent += value;
    if (k >= kIdleBounces && recent <= kIdleShare * sum.matrix[0][0]) return sum;
  }
  // If the further terms fall at least like k^(-9/8) or by the factor 0.9999 per bounce, their sum is below this bound.
  sum.error = recent * kMostMuellerBounces;
  return sum;
}

ReferenceMueller reference_scattering(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                      double theta_r_deg, double delta_phi_deg) {
  if (surface.scattering == Scattering::kMultiple) {
    return reference_all_bounces(surface, constants, theta_i_deg, theta_r_deg, delta_phi_deg).matrix;
  }
  const reference::Slopes slopes(surface.distribution, surface.sigma, surface.q);
  return reference_single_bounce(slopes, surface.masking, constants, {theta_i_deg, theta_r_deg, delta_phi_deg});
}

ReferenceMueller reference_single_bounce(const reference::Slopes& slopes, Masking masking, const FacetOptics& constants,
                                         const BeamAngles& angles) {
  const BeamFrame in = incident_beam(angles.theta_i_deg);
  const BeamFrame out = reflected_beam(angles.theta_r_deg, angles.delta_phi_deg);
  const Vector facet = sum(out.k, scaled<Real>(-1, in.k));  // 2 cos(beta) times the facet's normal
  const Real cos2_beta = dot(facet, facet) / 4;
  const auto tan2_alpha = static_cast<double>((facet[0] * facet[0] + facet[1] * facet[1]) / (facet[2] * facet[2]));
  ReferenceMueller facet_matrix{};
  for (const auto& [stack, weight] : reference::single_stacks(constants, static_cast<double>(sqrt(cos2_beta)))) {
    const auto r = fresnel_amplitudes<Complex>(stack, sqrt(cos2_beta), 1 - cos2_beta);
    add(facet_matrix, scaled_matrix(mueller_from_jones(jones_matrix(in, out, r)), weight));
  }
  const reference::Attenuation attenuation(slopes, masking, reference::zenith_from_deg(angles.theta_i_deg),
                                           reference::zenith_from_deg(angles.theta_r_deg), kMaskingTolerance);
  const double factor =
      0.25 * slopes.facet_density(tan2_alpha) * attenuation(tan2_alpha, static_cast<double>(cos2_beta));
  return scaled_matrix(facet_matrix, factor * facet_weight(slopes, tan2_alpha, facet, out));
}

ReferenceMueller reference_pbrdf(const Surface& surface, const FacetOptics& constants, double theta_i_deg,
                                 double theta_r_deg, double delta_phi_deg) {
  const double cosines = reference::zenith_from_deg(theta_i_deg).cos * reference::zenith_from_deg(theta_r_deg).cos;
  return scaled_matrix(reference_scattering(surface, constants, theta_i_deg, theta_r_deg, delta_phi_deg),
                       1.0 / cosines);
}

}  // namespace dolp
