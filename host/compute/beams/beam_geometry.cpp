#include "beams/beam_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace dolp {
namespace {

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

BeamZeniths::BeamZeniths(double theta_i_deg, double theta_r_deg)
    : i(cos_sin_deg(theta_i_deg)),
      r(cos_sin_deg(theta_r_deg)),
      mean(mean_zenith(theta_i_deg, theta_r_deg)),
      difference(cos_sin_deg(0.5 * (theta_i_deg - theta_r_deg))) {}

BeamGeometry beam_geometry(const BeamZeniths& zeniths, double delta_phi_deg) {
  const auto& [i, r, mean, difference] = zeniths;
  // std::remainder does not round, so the half angle keeps all digits near 0 and 180 degrees.
  const double azimuth_deg = std::remainder(delta_phi_deg, 360.0);
  const CosSin half = cos_sin_deg(0.5 * std::abs(azimuth_deg));
  const double sin_difference = 2.0 * mean.cos * difference.sin;   // sin i - sin r
  const double cos_difference = -2.0 * mean.sin * difference.sin;  // cos i - cos r
  const double product = 4.0 * i.sin * r.sin;
  const double flat_sum = sin_difference * sin_difference + product * half.cos * half.cos;
  const double flat_difference = sin_difference * sin_difference + product * half.sin * half.sin;
  const double height_sum = i.cos + r.cos;

  BeamGeometry geometry{.i = i, .r = r};
  geometry.slope = std::sqrt(flat_sum) / height_sum;
  geometry.cos_beta = 0.5 * std::sqrt(height_sum * height_sum + flat_sum);
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
  geometry.twice_eta_i =
      along_normal ? double_angle(-cos_azimuth, sin_azimuth) : double_angle(toward_i, r.sin * sin_azimuth);
  geometry.twice_eta_r = double_angle(toward_r, i.sin * sin_azimuth);
  return geometry;
}

double facet_azimuth(const BeamAngles& angles) {
  const double sin_i = cos_sin_deg(angles.theta_i_deg).sin;
  const double sin_r = cos_sin_deg(angles.theta_r_deg).sin;
  const CosSin azimuth = cos_sin_deg(angles.delta_phi_deg);  // of the viewer from the incident beam
  return std::atan2(-sin_i * azimuth.sin, sin_r + sin_i * azimuth.cos);
}

CosSin lower_direction(const BeamGeometry& beam) {
  // Compares tangents, because a cosine near 1 loses digits.
  return beam.i.cos * beam.r.sin < beam.r.cos * beam.i.sin ? beam.i : beam.r;
}

double v_cavity_attenuation(const BeamGeometry& beam) {
  const double sec = std::sqrt(1.0 + beam.slope * beam.slope);
  return std::min(1.0, 2.0 * lower_direction(beam).cos / (sec * beam.cos_beta));
}

}  // namespace dolp
