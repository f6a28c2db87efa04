#include "plan/beam.hpp"

#include <algorithm>
#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "base/numbers.hpp"
#include "model/angles.hpp"
#include "model/slopes.hpp"
#include "model/smooth_surface.hpp"
#include "plan/rule.hpp"

namespace dolp {
namespace {

using std::numbers::ln2;
using std::numbers::pi;

constexpr int kLargestOrder = 16;  // must equal kInPlaneOrder of physics/in_plane.glsl

// The masking G is an integral over slopes. It ends where the density of slopes is exp(-kCutExponent) of its maximum.
constexpr double kCutExponent = 45.0;

// The masking G is computed with at least this sigma. Otherwise (slope / m)^2 would overflow, with m = sqrt(2) sigma.
constexpr double kSmallestMaskingSigma = 1e-15;

// If |N^2 - sin^2(beta)| is below this share of |Re(N^2)| or sin^2(beta), exact_w_squared() avoids a loss of digits.
constexpr double kCritical = 1e-6;
constexpr double kSmallestSquare = 1e-300;
constexpr double kSmallestFacetCosine = 1e-12;

double log1p_square(double x) { return x > 1e8 ? 2.0 * std::log(x) : std::log1p(x * x); }

kernel::ShapeNode masking_shape(Distribution distribution, const SlopeShape& shape) {
  kernel::ShapeNode node{};
  const bool is_cauchy = distribution == Distribution::kCauchy;
  node.m = std::sqrt(2.0) * std::max(shape.sigma, kSmallestMaskingSigma);
  node.q_minus_1 = shape.q - 1.0;
  node.two_q_minus_3 = 2.0 * shape.q - 3.0;
  node.marginal_norm = (is_cauchy ? gamma_ratio(node.q_minus_1) : 1.0) / (kRootPi * node.m);
  node.scale = std::min(is_cauchy ? node.m / std::sqrt(shape.q) : node.m, 1.0);
  node.cut = node.m * std::sqrt(is_cauchy ? std::expm1(kCutExponent / (shape.q - 0.5)) : kCutExponent);
  return node;
}

// Re(N^2 - sin^2(beta)) to all digits of a double, from the angles in degrees.
double exact_w_squared(const BeamAngles& angles, const OpticalConstants& index) {
  using Real = boost::multiprecision::cpp_bin_float_quad;
  const auto cosine = [](double angle_deg) { return boost::math::cos_pi(Real(angle_deg) / 180); };
  const auto sine = [](double angle_deg) { return boost::math::sin_pi(Real(angle_deg) / 180); };
  const Real cos_2beta = sine(angles.theta_i_deg) * sine(angles.theta_r_deg) * cosine(angles.delta_phi_deg) +
                         cosine(angles.theta_i_deg) * cosine(angles.theta_r_deg);
  const Real n = index.n;
  const Real k = index.k;
  return static_cast<double>((n - k) * (n + k) - (1 - cos_2beta) / 2);
}

// Mueller matrix of a facet in its own frame: m00 = (R_s + R_p) / 2, m01 = (R_s - R_p) / 2, cross = conj(r_s) r_p.
struct FacetReflection {
  double m00 = 0.0;
  double m01 = 0.0;
  std::complex<double> cross;
};

// Computes R_s and R_p as shaders/physics/fresnel.glsl does. With c = cos(beta), the complex index N,
// w^2 = N^2 - sin^2(beta) and a of the code, conj(r_s) r_p = a (sin^2(beta) - c w) / (conj(c + w) (N^2 c + w)).
FacetReflection bare_reflection(const BeamAngles& angles, const BeamGeometry& geometry, const OpticalConstants& index) {
  using Complex = std::complex<double>;
  const double n2_re = (index.n - index.k) * (index.n + index.k);
  const Complex n2m1((index.n - 1.0) * (index.n + 1.0) - index.k * index.k, 2.0 * index.n * index.k);
  const double c = geometry.node.cos_beta;
  const double sin2 = geometry.sin2_beta;
  // Re(w^2) can be computed in two forms. The form with the smaller terms loses fewer digits.
  double w2 = sin2 < 0.5 ? n2_re - sin2 : n2m1.real() + c * c;
  if (std::hypot(w2, n2m1.imag()) <= kCritical * std::max(std::abs(n2_re), sin2)) w2 = exact_w_squared(angles, index);
  const Complex w = std::sqrt(Complex(w2, n2m1.imag()));
  const Complex s_sum = c + w;
  const Complex p_sum = Complex(n2_re, n2m1.imag()) * c + w;
  const double a = std::norm(n2m1) / std::max(std::norm(s_sum), kSmallestSquare);  // avoids 0/0 for N = 1 at 90 degrees
  const double r_s = a / std::max(std::norm(s_sum), kSmallestSquare);
  const double p_norm = std::max(std::norm(p_sum), kSmallestSquare);
  const double m01 = 0.5 * (4.0 * c * w.real() * a / p_norm) * sin2;
  return {r_s - m01, m01, r_s * (sin2 - c * w) * s_sum * std::conj(p_sum) / p_norm};
}

// Measured reflectances have no phase, so conj(r_s) r_p is set to 0.
FacetReflection covered_reflection(const BeamGeometry& geometry, const FacetOptics& optics) {
  const double c = std::max(geometry.node.cos_beta, kSmallestFacetCosine);
  const SmoothAbsorptance absorbed = smooth_absorptance(optics, c);
  const double m01 = 0.5 * absorbed.split * geometry.sin2_beta;
  if (optics.measured) return {1.0 - absorbed.s - m01, m01, 0.0};
  const ReflectedAmplitudes r = film_amplitudes(optics, c);
  return {std::norm(r.s) - m01, m01, std::conj(r.s) * r.p};
}

// (cos(2 eta), sin(2 eta)) for the angle eta of the vector (x, y). For a zero vector eta is 0.
CosSin double_angle(double x, double y) {
  const double length = std::max(std::abs(x), std::abs(y));
  if (length == 0.0) return {};
  const double u = x / length;  // divided first, because squares of tiny numbers would be 0
  const double v = y / length;
  return {(u - v) * (u + v) / (u * u + v * v), 2.0 * u * v / (u * u + v * v)};
}

// (cos, sin) of the mean of the two zeniths. Near the horizon it is computed from elevations, which keep more digits.
CosSin mean_zenith(double theta_i_deg, double theta_r_deg) {
  if (theta_i_deg + theta_r_deg <= 90.0) return cos_sin_deg(0.5 * (theta_i_deg + theta_r_deg));
  const CosSin elevation = cos_sin_deg(0.5 * ((90.0 - theta_i_deg) + (90.0 - theta_r_deg)));
  return {elevation.sin, elevation.cos};
}

}  // namespace

BeamGeometry beam_geometry(double theta_i_deg, double theta_r_deg, double delta_phi_deg) {
  const CosSin i = cos_sin_deg(theta_i_deg);
  const CosSin r = cos_sin_deg(theta_r_deg);
  // std::remainder does not round, so the half angle keeps all digits near 0 and 180 degrees.
  const double azimuth_deg = std::remainder(delta_phi_deg, 360.0);
  const CosSin half = cos_sin_deg(0.5 * std::abs(azimuth_deg));
  const CosSin mean = mean_zenith(theta_i_deg, theta_r_deg);
  const CosSin difference = cos_sin_deg(0.5 * (theta_i_deg - theta_r_deg));
  const double sin_difference = 2.0 * mean.cos * difference.sin;   // sin i - sin r
  const double cos_difference = -2.0 * mean.sin * difference.sin;  // cos i - cos r
  const double product = 4.0 * i.sin * r.sin;
  const double flat_sum = sin_difference * sin_difference + product * half.cos * half.cos;
  const double flat_difference = sin_difference * sin_difference + product * half.sin * half.sin;
  const double height_sum = i.cos + r.cos;

  BeamGeometry geometry;
  kernel::GeometryNode& node = geometry.node;
  node.c_i = i.cos;
  node.s_i = i.sin;
  node.c_r = r.cos;
  node.s_r = r.sin;
  node.slope = std::sqrt(flat_sum) / height_sum;
  node.cos_beta = 0.5 * std::sqrt(height_sum * height_sum + flat_sum);
  geometry.sin2_beta = 0.25 * (cos_difference * cos_difference + flat_difference);

  // Replaces cos(dphi) by 1 - 2 sin^2(dphi/2) or 2 cos^2(dphi/2) - 1. The smaller square causes the smaller error.
  const bool forward = std::abs(half.cos) < std::abs(half.sin);
  const double sin_sum = 2.0 * mean.sin * mean.cos;
  const double sin_of_difference = 2.0 * difference.sin * difference.cos;
  const double toward_i = forward ? sin_sum - 2.0 * i.cos * r.sin * half.cos * half.cos
                                  : sin_of_difference + 2.0 * i.cos * r.sin * half.sin * half.sin;
  const double toward_r = forward ? sin_sum - 2.0 * r.cos * i.sin * half.cos * half.cos
                                  : -sin_of_difference + 2.0 * r.cos * i.sin * half.sin * half.sin;
  const double sin_azimuth = std::copysign(2.0, azimuth_deg) * half.sin * half.cos;
  const bool along_normal = i.sin == 0.0 && r.sin == 0.0;
  const double cos_azimuth = (half.cos - half.sin) * (half.cos + half.sin);
  // For beams along the normal, eta_r is 0, and eta_i is the angle between the planes of azimuth 0 and delta_phi.
  const CosSin eta_i =
      along_normal ? double_angle(-cos_azimuth, sin_azimuth) : double_angle(toward_i, r.sin * sin_azimuth);
  const CosSin eta_r = double_angle(toward_r, i.sin * sin_azimuth);
  node.cos_2eta_i = eta_i.cos;
  node.sin_2eta_i = eta_i.sin;
  node.cos_2eta_r = eta_r.cos;
  node.sin_2eta_r = eta_r.sin;
  return geometry;
}

double log_density(Distribution distribution, const SlopeShape& shape, double slope) {
  const double m = std::sqrt(2.0) * shape.sigma;
  const double front = 2.0 * log1p_square(slope) - std::log(4.0 * pi) - 2.0 * std::log(m);
  const double u = slope / m;
  if (distribution == Distribution::kGaussian) return front - u * u;
  return front + std::log(shape.q - 1.0) - shape.q * log1p_square(u);
}

BeamPlan::BeamPlan(const ScatteringRequest& request) : request_(request) {
  data_.distribution = request.distribution;
  data_.masking = request.masking;
  data_.rule_order = kLargestOrder;
  data_.rule_nodes = rule_nodes(kLargestOrder);
  geometries_.reserve(request.angles.size());
  for (const BeamAngles& angles : request.angles) {
    geometries_.push_back(beam_geometry(angles.theta_i_deg, angles.theta_r_deg, angles.delta_phi_deg));
  }
  for (const SlopeShape& shape : request.shapes) data_.shapes.push_back(masking_shape(request.distribution, shape));
}

Beam BeamPlan::operator()(const ScatteringEntry& entry) const {
  Beam beam;
  kernel::BeamNode& node = beam.node;
  const BeamGeometry& geometry = geometries_[entry.angles];
  node.g = geometry.node;
  node.shape = data_.shapes[entry.shape];
  const FacetOptics& optics = request_.optics[entry.index];
  const FacetReflection facet = optics.is_bare()
                                    ? bare_reflection(request_.angles[entry.angles], geometry, optics.index)
                                    : covered_reflection(geometry, optics);
  node.m00 = facet.m00;
  node.m01 = facet.m01;
  node.cross_re = facet.cross.real();
  node.cross_im = facet.cross.imag();
  const double exponent = log_density(request_.distribution, request_.shapes[entry.shape], node.g.slope);
  if (!(exponent > std::log(std::numeric_limits<double>::denorm_min()))) return beam;
  const double power = std::floor(exponent / ln2) + 1.0;
  node.density = std::exp(exponent - power * ln2);
  beam.power = static_cast<int>(power);
  return beam;
}

ScatteringMatrix BeamPlan::matrix(const kernel::MuellerNode& node, const Beam& beam, const ScatteringEntry& entry,
                                  double unit_roundoff) const {
  ScatteringMatrix matrix;
  for (std::size_t i = 0; i < matrix.m.size(); ++i) matrix.m[i] = std::ldexp(node.m[i], beam.power);
  const double relative = unit_roundoff > kDoubleRoundoff ? kScatteringErrorFloat : kScatteringErrorDouble;
  matrix.error = relative * std::abs(matrix.m[0]);
  if (request_.scattering == Scattering::kMultiple) add_further_bounces(matrix, request_, entry, relative);
  return matrix;
}

}  // namespace dolp
