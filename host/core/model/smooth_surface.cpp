#include "model/smooth_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/films.hpp"

namespace dolp {
namespace {

using Complex = std::complex<double>;

constexpr double kMirrorRounding = 16.0 * std::numeric_limits<double>::epsilon();

SmoothAbsorptance bare_absorptance(const OpticalConstants& index, double cosine) {
  // Powers of a tiny N underflow. If n and k are both below kLeast, kLeast replaces n. Results change by up to 4e-75.
  constexpr double kLeast = 1e-75;
  const double n = index.k < kLeast ? std::max(index.n, kLeast) : index.n;
  const double k = index.k;
  const Complex square((n - k) * (n + k), 2.0 * n * k);
  // Real part of N^2 - sin^2(beta). The first form keeps the digits of a small N^2, the second the digits of N^2 - 1.
  const bool is_small = n < 0.5 && k < 0.5;
  const double real =
      is_small ? square.real() - (1.0 - cosine) * (1.0 + cosine) : (n - 1.0) * (n + 1.0) - k * k + cosine * cosine;
  const Complex w = std::sqrt(Complex(real, square.imag()));
  const double s_denominator = std::norm(cosine + w);
  const double p_denominator = std::norm(square * cosine + w);
  const double transmitted = 4.0 * cosine * w.real();
  return {transmitted / s_denominator, 4.0 * cosine * (std::conj(square) * w).real() / p_denominator, 0.0,
          transmitted / s_denominator * (std::norm(square - 1.0) / p_denominator)};
}

/// (R_s - R_p) / 2 between the first two rows of measured reflectances, at sin^2(beta) = `sin2`, before it is limited.
double free_half_difference(const MeasuredReflectance& measured, double sin2) {
  const double end = std::sin(measured.beta_deg[1] * std::numbers::pi / 180.0);
  return 0.5 * (measured.r_s[1] - measured.r_p[1]) * sin2 / (end * end);
}

/// The largest |R_s - R_p| / 2 with which R_s and R_p are in [0, 1].
double half_difference_limit(double mean) { return std::max(std::min(mean, 1.0 - mean), 0.0); }

double beta_deg_at(double cosine) { return std::acos(std::min(cosine, 1.0)) * 180.0 / std::numbers::pi; }

/// measured_absorptance() without `split`. It interpolates 1 - R by the angle to the row above, because both may be
/// tiny next to 90 degrees.
SmoothAbsorptance between_rows(const MeasuredReflectance& measured, std::size_t row, double cosine) {
  const double elevation_deg = std::asin(std::min(cosine, 1.0)) * 180.0 / std::numbers::pi;
  const double after_deg = measured.beta_deg[row];
  const double share = (elevation_deg - (90.0 - after_deg)) / (after_deg - measured.beta_deg[row - 1]);
  const auto absorbed = [&](const std::vector<double>& r) { return std::lerp(1.0 - r[row], 1.0 - r[row - 1], share); };
  const double s = absorbed(measured.r_s), p = absorbed(measured.r_p);
  const bool reflects_all = measured.r_s[row] == 1.0 && measured.r_p[row] == 1.0;  // as at 90 degrees
  const double error = kMirrorRounding * (reflects_all ? std::abs(share) : 1.0);
  if (row > 1) return {s, p, error};
  const double mean = 0.5 * (s + p);
  const double most = half_difference_limit(mean);
  const double half = std::clamp(free_half_difference(measured, (1.0 - cosine) * (1.0 + cosine)), -most, most);
  return {mean - half, mean + half, error};
}

SmoothAbsorptance covered_absorptance(const FacetOptics& optics, double cosine) {
  if (optics.measured) return between_rows(*optics.measured, optics.measured->row_above(beta_deg_at(cosine)), cosine);
  return film_absorptance(optics, cosine);
}

/// Adds `split`, (R_s - R_p) / sin^2(beta), to absorptances. Near normal incidence, where it is 0 / 0, it is
/// extrapolated linearly in sin^2(beta).
template <typename Absorptance>
SmoothAbsorptance with_split(const Absorptance& absorptance_at, double cosine) {
  constexpr double kStep = 1e-5;
  SmoothAbsorptance absorbed = absorptance_at(cosine);
  const double sin2 = (1.0 - cosine) * (1.0 + cosine);
  if (sin2 >= kStep) {
    absorbed.split = (absorbed.p - absorbed.s) / sin2;
    return absorbed;
  }
  const auto at = [&](double square) {
    const SmoothAbsorptance near = absorptance_at(std::sqrt(1.0 - square));
    return (near.p - near.s) / square;
  };
  const double first = at(kStep);
  absorbed.split = first + (sin2 / kStep - 1.0) * (at(2.0 * kStep) - first);
  return absorbed;
}

}  // namespace

SmoothAbsorptance smooth_absorptance(const FacetOptics& optics, double cosine) {
  if (optics.is_bare()) return bare_absorptance(optics.index, cosine);
  return with_split([&](double at) { return covered_absorptance(optics, at); }, cosine);
}

std::size_t MeasuredReflectance::row_above(double angle_deg) const {
  const auto above = std::upper_bound(beta_deg.begin() + 1, beta_deg.end() - 1, angle_deg);
  return static_cast<std::size_t>(above - beta_deg.begin());
}

SmoothAbsorptance measured_absorptance(const MeasuredReflectance& measured, std::size_t row, double cosine) {
  return with_split([&](double at) { return between_rows(measured, row, at); }, cosine);
}

std::optional<double> difference_limit_deg(const MeasuredReflectance& measured) {
  constexpr int kSteps = 90;
  constexpr double kRounding = 1e-12;
  const double first = 0.5 * (measured.r_s[0] + measured.r_p[0]);
  const double second = 0.5 * (measured.r_s[1] + measured.r_p[1]);
  const auto is_limited = [&](double share) {
    const double sine = std::sin(share * measured.beta_deg[1] * std::numbers::pi / 180.0);
    const double most = half_difference_limit(std::lerp(first, second, share));
    return std::abs(free_half_difference(measured, sine * sine)) > most + kRounding;
  };
  for (int i = 1; i < kSteps; ++i) {
    double free = static_cast<double>(i - 1) / kSteps, limited = static_cast<double>(i) / kSteps;
    if (!is_limited(limited)) continue;
    while (limited - free > kRounding) {
      const double middle = 0.5 * (free + limited);
      (is_limited(middle) ? limited : free) = middle;
    }
    return limited * measured.beta_deg[1];
  }
  return std::nullopt;
}

double reflectance_level(const FacetOptics& optics) {
  if (optics.is_bare()) {
    const double absorbed = bare_absorptance(optics.index, 1.0).s;
    return std::min(absorbed, 1.0 - absorbed);
  }
  constexpr std::array<double, 4> kCosines = {1.0, 0.75, 0.5, 0.25};
  double absorbed = 0.0;
  for (const double cosine : kCosines) {
    const SmoothAbsorptance at = covered_absorptance(optics, cosine);
    absorbed += 0.5 * (at.s + at.p) / static_cast<double>(kCosines.size());
  }
  return std::min(absorbed, 1.0 - absorbed);
}

double critical_cosine(const FacetOptics& optics) {
  if (optics.measured) return 0.0;
  const OpticalConstants& index = optics.index;
  // Above this Im N^2, total reflection begins so gradually that integrals need no split at its angle.
  constexpr double kSoft = 0.3;
  const double squared = (1.0 - index.n) * (1.0 + index.n) + index.k * index.k;
  const bool is_sharp = 2.0 * index.n * index.k < kSoft;
  return is_sharp && squared > 0.0 && squared < 1.0 ? std::sqrt(squared) : 0.0;
}

std::vector<double> kink_elevations_rad(const FacetOptics& optics) {
  std::vector<double> elevations_rad;
  if (optics.measured) {
    for (const double beta_deg : optics.measured->beta_deg)
      elevations_rad.push_back((90.0 - beta_deg) * std::numbers::pi / 180.0);
    return elevations_rad;
  }
  const auto add_critical = [&](const OpticalConstants& index) {
    const double squared_sine = (1.0 - index.n) * (1.0 + index.n) + index.k * index.k;
    const double squared_cosine = (index.n - index.k) * (index.n + index.k);
    if (squared_sine <= 0.0 || squared_cosine <= 0.0) return;
    elevations_rad.push_back(std::atan2(std::sqrt(squared_sine), std::sqrt(squared_cosine)));
  };
  add_critical(optics.index);
  for (const Film& film : optics.films) add_critical(film.index);
  return elevations_rad;
}

Moments mirror_moments(const FacetOptics& optics, double cosine) {
  const SmoothAbsorptance absorbed = smooth_absorptance(optics, cosine);
  const double rounding = kMirrorRounding * cosine;
  Moments moments;
  moments.albedo = cosine;
  moments.deficit = 0.5 * (absorbed.s + absorbed.p) * cosine;
  moments.r_i = cosine - moments.deficit;
  moments.r_q = 0.5 * (absorbed.p - absorbed.s) * cosine;
  // If N is exactly 1, nothing is reflected: r_i and r_q are exactly 0 and have no error.
  moments.r_i_error = moments.r_i == 0.0 ? 0.0 : rounding;
  moments.albedo_error = rounding;
  moments.deficit_error = rounding * 0.5 * (absorbed.s + absorbed.p) + cosine * absorbed.error;
  moments.r_q_error = moments.r_i == 0.0 ? 0.0 : moments.deficit_error;  // r_q is a difference of absorptances
  moments.direct_i = moments.deficit;
  moments.direct_q = -moments.r_q;
  moments.direct_i_error = moments.direct_q_error = moments.deficit_error;
  return moments;
}

}  // namespace dolp
