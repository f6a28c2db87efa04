#include "plan/further_bounces.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "model/angles.hpp"
#include "plan/beam.hpp"

namespace dolp {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr int kMostBounces = 2000;
constexpr double kNothing = 1e-14;        // relative to the contribution of the bounces before
constexpr double kAngleRoundings = 16.0;  // of the angles, relative to |h|

/// Two beams in the frame of a groove.
struct Across {
  double a = 0.0;      ///< length of the ray across the groove
  double psi_i = 0.0;  ///< zeniths there, toward u
  double psi_r = 0.0;
  double along = 0.0;                              ///< of omega_i, along the groove
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< azimuths of the beams, across and along the groove
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double cos_i = 1.0;
  double cos_r = 1.0;
};

/// Stokes vectors in a frame turned by the angle of (x, y), from s toward p.
Eigen::Matrix4d turned(double x, double y) {
  const double norm = x * x + y * y;
  const double cosine = norm > 0.0 ? (x - y) * (x + y) / norm : 1.0;
  const double sine = norm > 0.0 ? 2.0 * x * y / norm : 0.0;
  Eigen::Matrix4d r = Eigen::Matrix4d::Identity();
  r(1, 1) = r(2, 2) = cosine;
  r(1, 2) = sine;
  r(2, 1) = -sine;
  return r;
}

/// A bounce in its own frame; in the unfolded groove r_p is r_s at normal incidence.
Eigen::Matrix4d facet(const OpticalConstants& index, double cos_beta) {
  const Complex n2m1((index.n - 1.0) * (index.n + 1.0) - index.k * index.k, 2.0 * index.n * index.k);
  const Complex w = std::sqrt(n2m1 + cos_beta * cos_beta);
  const Complex n2c = (n2m1 + 1.0) * cos_beta;
  const Complex r_s = -n2m1 / ((cos_beta + w) * (cos_beta + w));
  const Complex r_p = (w - n2c) / (w + n2c);
  const Complex cross = std::conj(r_s) * r_p;
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = m(1, 1) = 0.5 * (std::norm(r_s) + std::norm(r_p));
  m(0, 1) = m(1, 0) = 0.5 * (std::norm(r_s) - std::norm(r_p));
  m(2, 2) = m(3, 3) = cross.real();
  m(2, 3) = -cross.imag();
  m(3, 2) = cross.imag();
  return m;
}

/// The Mueller matrix of `bounces` bounces in a groove of angle gamma: from frame to frame in the unfolded groove,
/// whose mirror images turn s around after an odd number.
Eigen::Matrix4d chain(const Across& at, const OpticalConstants& index, double gamma, int bounces) {
  Eigen::Matrix4d m = turned(-at.from.x(), at.from.y() * at.cos_i).transpose();
  for (int k = 1; k <= bounces; ++k) {
    const double chi = at.psi_i + (2 * k - 1) * gamma;
    const Eigen::Matrix4d turn = turned(std::cos(chi), at.along * std::sin(chi));
    m = turn.transpose() * (facet(index, at.a * std::sin(chi)) * (turn * m));
  }
  const bool is_odd = bounces % 2 == 1;
  m = turned(is_odd ? -at.to.x() : at.to.x(), at.to.y() * at.cos_r) * m;
  if (is_odd) m.bottomRows<2>() *= -1.0;
  return m;
}

/// a ds_k.
double beam_width(const Across& at, double gamma, int bounces) {
  if (at.psi_i <= -gamma) return 0.0;
  const auto edge = [&](int k) { return at.a * std::sin(at.psi_i + (2 * k + 1) * gamma); };
  const double least = std::max(at.a * std::sin(at.psi_i - gamma), 0.0);
  const bool is_behind = at.psi_i + (2 * bounces + 1) * gamma >= pi;
  const double low = is_behind ? least : std::max(least, edge(bounces));
  return std::max(std::min(edge(0), edge(bounces - 1)) - low, 0.0);
}

}  // namespace

void add_further_bounces(ScatteringMatrix& f, const ScatteringRequest& request, const ScatteringEntry& entry) {
  const BeamAngles& angles = request.angles[entry.angles];
  const SlopeShape& shape = request.shapes[entry.shape];
  const OpticalConstants& index = request.indices[entry.index];
  const CosSin i = cos_sin_deg(angles.theta_i_deg);
  const CosSin r = cos_sin_deg(angles.theta_r_deg);
  const CosSin azimuth = cos_sin_deg(angles.delta_phi_deg);
  const double h_x = i.sin + r.sin * azimuth.cos;
  const double h_y = r.sin * azimuth.sin;
  const double h = std::hypot(h_x, h_y);
  if (h == 0.0 || is_specular(angles)) {
    f.m.fill(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  double rest = 0.0;
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
    const double least_gamma = 0.49 * std::abs(std::abs(at.psi_i) - std::abs(at.psi_r));
    double last = 0.0;
    for (int k = 2; k <= kMostBounces; ++k) {
      const double gamma = (pi - at.psi_i + (k % 2 == 1 ? -at.psi_r : at.psi_r)) / (2.0 * k);
      if (gamma < least_gamma) break;
      if (gamma <= 0.0 || gamma >= 0.5 * pi) continue;
      const double width = beam_width(at, gamma, k);
      if (width == 0.0) continue;
      const double density = 4.0 * std::exp(log_density(request.distribution, shape, 1.0 / std::tan(gamma)));
      const Eigen::Matrix4d more = density * std::cos(gamma) * width / (2.0 * k * h) * chain(at, index, gamma, k);
      sum += more;
      last = more(0, 0) * k;
      if (last < kNothing * (sum(0, 0) + f.m[0])) break;
    }
    if (least_gamma < 1e-3) rest += last;
  }
  for (std::size_t j = 0; j < f.m.size(); ++j) {
    f.m[j] += sum(static_cast<Eigen::Index>(j / 4), static_cast<Eigen::Index>(j % 4));
  }
  f.error += (kScatteringErrorDouble + kAngleRoundings * std::numeric_limits<double>::epsilon() / h) * sum(0, 0) + rest;
}

}  // namespace dolp
