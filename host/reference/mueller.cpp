#include "reference/mueller.hpp"

#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_complex.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>

#include "reference/fresnel.hpp"
#include "reference/groove_beam.hpp"
#include "reference/moments.hpp"
#include "reference/vectors.hpp"

namespace dolp::reference {

namespace {

// In the textbook formulas digits cancel near grazing, the retro direction and the critical angle; 34 digits suffice.
using Quad = boost::multiprecision::cpp_bin_float_quad;
using ComplexQuad = boost::multiprecision::cpp_complex_quad;
using QuadVector = Vector<Quad>;
template <class Number>
using Jones = Eigen::Matrix<Number, 2, 2>;

constexpr double kMaskingTolerance = 1e-13;
constexpr double kRetro = 1e-50;  // if sin^2(2 beta) is smaller, the plane of incidence is undefined
// h: horizontal part of omega_i + omega_r. If |h|^2 is smaller, omega_r is the mirror direction: the result is NaN.
constexpr double kMirrored = 1e-50;
constexpr int kMostMuellerBounces = 2000;
constexpr int kMostInQuad = 24;  // light with more bounces is weak, so it is computed in double
// The sum over bounces ends when its latest kIdleBounces terms together are at most the share kIdleShare of the sum.
constexpr int kIdleBounces = 8;
constexpr double kIdleShare = 1e-14;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// A beam: k is its direction of propagation, s = k x z / |k x z| and p = k x s.
struct BeamFrame {
  QuadVector k;
  QuadVector s;
  QuadVector p;
};

Quad radians(double angle_deg) { return Quad(angle_deg) * boost::math::constants::pi<Quad>() / 180; }

QuadVector toward(double zenith_deg, double azimuth_deg) {
  const Quad zenith = radians(zenith_deg);
  const Quad azimuth = radians(azimuth_deg);
  return {sin(zenith) * cos(azimuth), sin(zenith) * sin(azimuth), cos(zenith)};
}

/// The beam from the source, at azimuth 0. At zenith 0, s is the limit of k x z.
BeamFrame incident_beam(double zenith_deg) {
  const QuadVector k = -toward(zenith_deg, 0.0);
  const QuadVector s{0, 1, 0};
  return {k, s, k.cross(s)};
}

BeamFrame reflected_beam(double zenith_deg, double azimuth_deg) {
  const QuadVector k = toward(zenith_deg, azimuth_deg);
  const Quad azimuth = radians(azimuth_deg);
  const QuadVector s{sin(azimuth), -cos(azimuth), 0};
  return {k, s, k.cross(s)};
}

template <class Number>
Amplitudes<Number> fresnel_amplitudes(const FacetOptics& constants, const typename Number::value_type& cos_beta,
                                      const typename Number::value_type& sin2_beta) {
  if (!constants.measured) return stack_amplitudes<Number>(constants, cos_beta, sin2_beta);
  const FresnelCoefficients r = fresnel(constants, static_cast<double>(cos_beta));
  return {Number(r.r_s.real()), Number(r.r_p.real())};
}

// Column 0: s and p amplitudes after reflection of an s wave of amplitude 1. Column 1: the same for a p wave. If light
// goes straight back, the plane of incidence is undefined. Any direction in the facet can be facet_s, as r_p = -r_s.
Jones<ComplexQuad> jones_matrix(const BeamFrame& in, const BeamFrame& out, const Amplitudes<ComplexQuad>& r) {
  const QuadVector normal = in.k.cross(out.k);
  const QuadVector facet_s = normal.squaredNorm() > kRetro ? normal.normalized() : in.s;
  const QuadVector facet_in_p = in.k.cross(facet_s);
  const QuadVector facet_out_p = out.k.cross(facet_s);
  const auto element = [&](const QuadVector& to, const QuadVector& from) {
    return ComplexQuad(to.dot(facet_s) * r.s * facet_s.dot(from) + to.dot(facet_out_p) * r.p * facet_in_p.dot(from));
  };
  return Jones<ComplexQuad>{{element(out.s, in.s), element(out.s, in.p)}, {element(out.p, in.s), element(out.p, in.p)}};
}

// Element (a, b) is half the trace of sigma_a J sigma_b J^+. `basis` holds the matrices sigma of I, Q, U and V.
template <class Number>
Mueller mueller_from_jones(const Jones<Number>& jones) {
  using Matrix = Jones<Number>;
  const Number zero(0), one(1), i(0, 1);
  const std::array<Matrix, 4> basis{Matrix{{one, zero}, {zero, one}}, Matrix{{one, zero}, {zero, -one}},
                                    Matrix{{zero, one}, {one, zero}}, Matrix{{zero, -i}, {i, zero}}};
  Mueller mueller;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      const Matrix product = basis[a] * jones * basis[b] * jones.adjoint();
      mueller.data()[4 * a + b] = 0.5 * static_cast<double>(product.trace().real());
    }
  }
  return mueller;
}

/// The plane across the grooves that reflect the beam `in` into the beam `out`. The horizontal direction u of the plane
/// is along the horizontal part of omega_i + omega_r if `sign` is 1, against this part if `sign` is -1.
struct GroovePlane {
  QuadVector u, v;
  Quad across;        ///< length of the horizontal part of omega_i + omega_r
  Quad psi_i, psi_r;  ///< angles of omega_i and omega_r from z toward u

  GroovePlane(const BeamFrame& in, const BeamFrame& out, int sign) {
    const QuadVector horizontal{out.k[0] - in.k[0], out.k[1] - in.k[1], 0};
    across = horizontal.norm();
    u = horizontal * Quad(sign / across);
    v = {-u[1], u[0], 0};
    psi_i = atan2(-in.k.dot(u), -in.k[2]);
    psi_r = atan2(out.k.dot(u), out.k[2]);
  }
  QuadVector in_groove(const QuadVector& a) const { return {a.dot(u), a.dot(v), a[2]}; }
  /// Half-angle of the groove that reflects `in` into `out` in `bounces` bounces, if the first bounce is at facet A.
  Quad gamma(int bounces) const {
    const Quad turn = bounces % 2 == 1 ? Quad(psi_i + psi_r) : Quad(psi_i - psi_r);
    return (boost::math::constants::pi<Quad>() - turn) / (2 * bounces);
  }
};

// Weight of the facets whose normal is tilted toward `horizontal`, for slopes that differ along and across. Their
// azimuths count from the horizontal direction of the viewer, who receives the beam `out`.
double facet_weight(const Slopes& slopes, double tan2_alpha, const QuadVector& horizontal, const BeamFrame& out) {
  const QuadVector viewer{-out.s[1], out.s[0], 0};
  const Quad length = sqrt(Quad(horizontal[0] * horizontal[0] + horizontal[1] * horizontal[1]));
  if (length == 0) return slopes.weight(tan2_alpha, 1.0, 0.0);
  const Quad cos_phi = (viewer[0] * horizontal[0] + viewer[1] * horizontal[1]) / length;
  const Quad sin_phi = (viewer[0] * horizontal[1] - viewer[1] * horizontal[0]) / length;
  return slopes.weight(tan2_alpha, static_cast<double>(cos_phi), static_cast<double>(sin_phi));
}

// The contribution of one GroovePlane to light_of_bounces(). Light meets facet A first. `Number`: a complex type.
template <class Number>
Mueller bounces_in_plane(const Slopes& slopes, const FacetOptics& constants, const BeamFrame& in, const BeamFrame& out,
                         const GroovePlane& plane, int bounces) {
  using Part = typename Number::value_type;
  const Quad gamma = plane.gamma(bounces);
  if (gamma <= 0 || 2 * gamma >= boost::math::constants::pi<Quad>()) return Mueller::Zero();
  const auto in_groove = [&](const QuadVector& a) -> Vector<Part> { return plane.in_groove(a).template cast<Part>(); };
  const Groove<Part> groove{static_cast<Part>(sin(gamma)), static_cast<Part>(cos(gamma))};
  GrooveBeam<Part> beam(groove, in_groove(-in.k), Facet::kA);
  std::array<Vector<Number>, 2> waves{in_groove(in.s).template cast<Number>(), in_groove(in.p).template cast<Number>()};
  Part left = 0;
  for (int i = 0; i < bounces; ++i) {
    if (beam.flux() <= 0) return Mueller::Zero();
    const auto b = bounce<Part>(beam.direction(), beam.normal(), {0, 1, 0});
    const auto r = fresnel_amplitudes<Number>(constants, b.cos_beta, 1 - b.cos_beta * b.cos_beta);
    for (auto& e : waves) e = reflected(b, components(b, e), r);
    left = beam.reflect(b.k_out);
  }
  if (left <= 0) return Mueller::Zero();
  const Vector<Part> s = in_groove(out.s), p = in_groove(out.p);
  const Jones<Number> jones{{along(s, waves[0]), along(s, waves[1])}, {along(p, waves[0]), along(p, waves[1])}};
  const auto cotangent = static_cast<double>(cos(gamma) / sin(gamma));
  const auto factor = static_cast<double>(cos(gamma) * left / (2 * bounces * plane.across));
  const double tan2_alpha = cotangent * cotangent;
  const double density = slopes.facet_density(tan2_alpha) * facet_weight(slopes, tan2_alpha, plane.u, out);
  return density * factor * mueller_from_jones(jones);
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
  Mueller term(const Slopes& slopes, const FacetOptics& constants, int bounces) const {
    const auto& in_plane =
        bounces > kMostInQuad ? bounces_in_plane<std::complex<double>> : bounces_in_plane<ComplexQuad>;
    return in_plane(slopes, constants, in, out, toward, bounces) +
           in_plane(slopes, constants, in, out, against, bounces);
  }
  /// True if rays with `bounces` or more bounces cannot leave at the angle psi_r.
  bool is_beyond(int bounces) const {
    const Quad widest = std::max(toward.gamma(bounces), against.gamma(bounces));
    return abs(Quad(abs(toward.psi_i) - abs(toward.psi_r))) > 4 * widest;
  }
};

}  // namespace

Mueller light_of_bounces(const Slopes& slopes, const FacetOptics& constants, const BeamAngles& angles, int bounces) {
  const GroovePair pair(angles);
  return pair.is_mirrored() ? Mueller::Constant(kNotANumber) : pair.term(slopes, constants, bounces);
}

BouncesSum all_bounces(const Slopes& slopes, const FacetOptics& constants, const BeamAngles& angles) {
  const GroovePair pair(angles);
  if (pair.is_mirrored()) return {Mueller::Constant(kNotANumber), kNotANumber};
  BouncesSum sum;
  std::array<double, kIdleBounces> latest{};
  double recent = 0.0;
  for (int k = 1; k <= kMostMuellerBounces; ++k) {
    if (pair.is_beyond(k)) return sum;
    const Mueller term = pair.term(slopes, constants, k);
    sum.matrix += term;
    latest[static_cast<std::size_t>(k % kIdleBounces)] = term(0, 0);
    recent = 0.0;
    for (const double value : latest) recent += value;
    if (k >= kIdleBounces && recent <= kIdleShare * sum.matrix(0, 0)) return sum;
  }
  // If the further terms fall at least like k^(-9/8) or by the factor 0.9999 per bounce, their sum is below this bound.
  sum.error = recent * kMostMuellerBounces;
  return sum;
}

Mueller single_bounce(const Slopes& slopes, Masking masking, const FacetOptics& constants, const BeamAngles& angles) {
  const BeamFrame in = incident_beam(angles.theta_i_deg);
  const BeamFrame out = reflected_beam(angles.theta_r_deg, angles.delta_phi_deg);
  const QuadVector facet = out.k - in.k;  // 2 cos(beta) times the facet's normal
  const Quad cos2_beta = facet.squaredNorm() / 4;
  const auto tan2_alpha = static_cast<double>((facet[0] * facet[0] + facet[1] * facet[1]) / (facet[2] * facet[2]));
  Mueller facet_matrix = Mueller::Zero();
  for (const auto& [stack, weight] : single_stacks(constants, static_cast<double>(sqrt(cos2_beta)))) {
    const auto r = fresnel_amplitudes<ComplexQuad>(stack, sqrt(cos2_beta), 1 - cos2_beta);
    facet_matrix += weight * mueller_from_jones(jones_matrix(in, out, r));
  }
  const Attenuation attenuation(slopes, masking, zenith_from_deg(angles.theta_i_deg),
                                zenith_from_deg(angles.theta_r_deg), kMaskingTolerance);
  const double factor =
      0.25 * slopes.facet_density(tan2_alpha) * attenuation(tan2_alpha, static_cast<double>(cos2_beta));
  return factor * facet_weight(slopes, tan2_alpha, facet, out) * facet_matrix;
}

}  // namespace dolp::reference
