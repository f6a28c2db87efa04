#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "beams/beam_geometry.hpp"
#include "beams/scattering.hpp"
#include "model/angles.hpp"
#include "model/slopes.hpp"

namespace dolp {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

// The work grows as the square of this number.
constexpr int kMostBouncesOfBeam = 1000;
constexpr double kNegligibleBounces = 0.01;  // share of the wanted accuracy that the omitted bounces may take
constexpr double kSlowestFall = 0.1;         // smallest divisor 2q - 3 in beyond_last()

struct Across {
  double a = 0.0;                                  ///< length of the incidence omega_i, projected across the groove
  double psi_i = 0.0;                              ///< zenith of omega_i in the plane across the groove, signed
  double psi_r = 0.0;                              ///< zenith of the reflection omega_r in this plane
  double along = 0.0;                              ///< component of omega_i along the groove
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< azimuth of omega_i as a unit vector (across, along)
  Eigen::Vector2d to = Eigen::Vector2d::Zero();    ///< azimuth of omega_r as a unit vector (across, along)
  double cos_i = 1.0;
  double cos_r = 1.0;
};

/// A Jones matrix, which maps the fields (E_s, E_p) before some bounces to the fields after them.
using Jones = Eigen::Matrix2cd;

/// Matrix that converts fields (E_s, E_p) to a frame rotated by the angle atan2(y, x), from s toward p.
Eigen::Matrix2d turned(double x, double y) {
  const double length = std::hypot(x, y);
  const double cosine = length > 0.0 ? x / length : 1.0;
  const double sine = length > 0.0 ? y / length : 0.0;
  return Eigen::Matrix2d{{cosine, sine}, {-sine, cosine}};
}

/// The Jones matrix of one bounce on a facet. c is cos(beta). The vector (x, y) points along s of the facet, in the
/// frame (s, p) of the fields. The sign of r_p is such that r_p = r_s at normal incidence.
class Facet {
 public:
  explicit Facet(const OpticalConstants& index)
      : re_((index.n - 1.0) * (index.n + 1.0) - index.k * index.k), im_(2.0 * index.n * index.k) {}

  Jones operator()(double c, double x, double y) const {
    const Complex w = root(re_ + c * c);
    const Complex sum = c + w;
    const Complex n2c((re_ + 1.0) * c, im_ * c);
    const Complex square = sum * sum;
    const Complex under = w + n2c;
    const Complex r_s = -Complex(re_, im_) * std::conj(square) / std::norm(square);
    const Complex r_p = (w - n2c) * std::conj(under) / std::norm(under);
    const double norm = x * x + y * y;
    const Complex split = norm > 0.0 ? (r_s - r_p) / norm : Complex{};
    const Complex p = norm > 0.0 ? r_p : r_s;
    return Jones{{p + split * (x * x), split * (x * y)}, {split * (x * y), p + split * (y * y)}};
  }

 private:
  /// sqrt(re + i im_). Domain: im_ >= 0.
  Complex root(double re) const {
    const double larger = std::sqrt(0.5 * (std::abs(re) + std::sqrt(re * re + im_ * im_)));
    const double smaller = larger > 0.0 ? 0.5 * im_ / larger : 0.0;
    return re >= 0.0 ? Complex(larger, smaller) : Complex(smaller, larger);
  }

  double re_;  ///< N^2 - 1 = re_ + i im_
  double im_;
};

Eigen::Matrix4d mueller(const Jones& j) {
  const Complex ss = j(0, 0), sp = j(0, 1), ps = j(1, 0), pp = j(1, 1);  // sp: incident field p, reflected field s
  const double a = std::norm(ss), b = std::norm(sp), c = std::norm(ps), d = std::norm(pp);
  const Complex first = std::conj(ss) * sp, second = std::conj(ps) * pp;
  const Complex s_in = std::conj(ss) * ps, p_in = std::conj(sp) * pp;
  const Complex straight = std::conj(ss) * pp, crossed = std::conj(sp) * ps;
  return Eigen::Matrix4d{
      {0.5 * (a + b + c + d), 0.5 * (a - b + c - d), (first + second).real(), -(first + second).imag()},
      {0.5 * (a + b - c - d), 0.5 * (a - b - c + d), (first - second).real(), -(first - second).imag()},
      {(s_in + p_in).real(), (s_in - p_in).real(), (straight + crossed).real(), (crossed - straight).imag()},
      {(s_in + p_in).imag(), (s_in - p_in).imag(), (straight + crossed).imag(), (straight - crossed).real()}};
}

/// Mueller matrix of a beam after `bounces` bounces in an unfolded groove (shaders/physics/groove.glsl). After an odd
/// number of bounces, the ray and its frame (s, p) in the unfolded groove are mirror images of the real ray and frame.
Eigen::Matrix4d chain(const Across& at, const Facet& facet, double gamma, int bounces) {
  Jones fields = turned(-at.from.x(), at.from.y() * at.cos_i).transpose().cast<Complex>();
  const Complex turn = std::polar(1.0, 2.0 * gamma);
  Complex chi = std::polar(1.0, at.psi_i + gamma);  // e^(i chi)
  for (int k = 1; k <= bounces; ++k) {
    fields = facet(at.a * chi.imag(), chi.real(), at.along * chi.imag()) * fields;
    chi *= turn;
  }
  const bool is_odd = bounces % 2 == 1;
  fields = turned(is_odd ? -at.to.x() : at.to.x(), at.to.y() * at.cos_r).cast<Complex>() * fields;
  if (is_odd) fields.row(1) *= -1.0;
  return mueller(fields);
}

double beam_width(const Across& at, double gamma, int bounces) {
  if (at.psi_i <= -gamma) return 0.0;
  const auto edge = [&](int k) { return at.a * std::sin(at.psi_i + (2 * k + 1) * gamma); };
  const double least = std::max(at.a * std::sin(at.psi_i - gamma), 0.0);
  const bool is_behind = at.psi_i + (2 * bounces + 1) * gamma >= pi;
  const double low = is_behind ? least : std::max(least, edge(bounces));
  return std::max(std::min(edge(0), edge(bounces - 1)) - low, 0.0);
}

struct FurtherBeams {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  double unfollowed = 0.0;  ///< bound of m00 of beams with more than kMostBouncesOfBeam bounces; 0 if negligible
  int bounces = 0;          ///< bounces computed so far, over all beams
};

/// Bound of all light after more than `bounces` bounces, divided by the light after `bounces` bounces. For Cauchy
/// slopes, the light after k bounces falls like k^(2 - 2q).
double beyond_last(const ScatteringRequest& request, const SlopeShape& shape, int bounces) {
  const bool is_cauchy = request.distribution == Distribution::kCauchy;
  return is_cauchy ? bounces / std::clamp(2.0 * shape.q - 3.0, kSlowestFall, 1.0) : bounces;
}

/// Sums the light after 2, 3, ... bounces. `first` is m00 of the first bounce.
FurtherBeams further_beams(const Across& at, const ScatteringRequest& request, const ScatteringEntry& entry, double h,
                           double first) {
  const SlopeShape& shape = request.shapes[entry.shape];
  const double azimuth = facet_azimuth(request.angles[entry.angles]);
  const Facet facet(request.optics[entry.index].index);
  const double least_gamma = 0.49 * std::abs(std::abs(at.psi_i) - std::abs(at.psi_r));
  FurtherBeams beams;
  // Bounds of the light after more than k bounces: [0] from the last even k, [1] from the last odd k.
  std::array<double, 2> beyond = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int k = 2; k <= kMostBouncesOfBeam; ++k) {
    const double gamma = (pi - at.psi_i + (k % 2 == 1 ? -at.psi_r : at.psi_r)) / (2.0 * k);
    if (gamma < least_gamma) return beams;
    const std::size_t parity = k % 2 == 0 ? 0 : 1;
    const bool is_groove = gamma > 0.0 && gamma < 0.5 * pi;
    const double width = is_groove ? beam_width(at, gamma, k) : 0.0;
    beyond[parity] = 0.0;
    if (width == 0.0) continue;
    const double density = 4.0 * std::exp(log_density(request.distribution, shape, 1.0 / std::tan(gamma), azimuth));
    const Eigen::Matrix4d more = density * std::cos(gamma) * width / (2.0 * k * h) * chain(at, facet, gamma, k);
    beams.sum += more;
    beams.bounces += k;
    beyond[parity] = more(0, 0) * beyond_last(request, shape, k);
    if (std::max(beyond[0], beyond[1]) < kNegligibleBounces * request.accuracy * (first + beams.sum(0, 0)))
      return beams;
  }
  beams.unfollowed = std::max(beyond[0], beyond[1]);
  return beams;
}

}  // namespace

int add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry) {
  const BeamAngles& angles = request.angles[entry.angles];
  const CosSin i = cos_sin_deg(angles.theta_i_deg);
  const CosSin r = cos_sin_deg(angles.theta_r_deg);
  const double azimuth_deg = std::remainder(angles.delta_phi_deg, 360.0);
  const CosSin half = cos_sin_deg(0.5 * std::abs(azimuth_deg));  // keeps all digits of the sine near 180 degrees
  const CosSin azimuth{cos_sin_deg(azimuth_deg).cos, std::copysign(2.0, azimuth_deg) * half.sin * half.cos};
  // The horizontal part h of omega_i + omega_r, without cancellation near the mirror direction.
  const double h_x = 2.0 * cos_sin_deg(0.5 * (angles.theta_i_deg + angles.theta_r_deg)).cos *
                         cos_sin_deg(0.5 * (angles.theta_i_deg - angles.theta_r_deg)).sin +
                     2.0 * r.sin * half.cos * half.cos;
  const double h_y = r.sin * azimuth.sin;
  const double h = std::hypot(h_x, h_y);
  if (h == 0.0 || is_specular(angles)) {
    f.m.fill(std::numeric_limits<double>::quiet_NaN());
    return 0;
  }
  int bounces = 0;
  for (const double side : {1.0, -1.0}) {
    const double u_x = side * h_x / h;
    const double u_y = side * h_y / h;
    Across at;
    at.from = {u_x, -u_y};
    at.to = {azimuth.cos * u_x + azimuth.sin * u_y, azimuth.sin * u_x - azimuth.cos * u_y};
    at.cos_i = i.cos;
    at.cos_r = r.cos;
    at.a = std::hypot(i.sin * at.from.x(), i.cos);
    at.psi_i = std::atan2(i.sin * at.from.x(), i.cos);
    at.psi_r = std::atan2(r.sin * at.to.x(), r.cos);
    at.along = i.sin * at.from.y();
    const FurtherBeams beams = further_beams(at, request, entry, h, f.m[0]);
    for (Eigen::Index j = 0; j < 16; ++j) f.m[static_cast<std::size_t>(j)] += beams.sum(j / 4, j % 4);
    f.error += request.accuracy * beams.sum(0, 0) + beams.unfollowed;
    bounces += beams.bounces;
  }
  return bounces;
}

}  // namespace dolp
