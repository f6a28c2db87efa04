// Random surfaces and pairs of directions for tests of the pBRDF, including hard cases.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "draws.hpp"
#include "model/scattering.hpp"

namespace dolp {

struct ScatteringPoint {
  BeamAngles angles;
  SlopeShape shape;
  OpticalConstants index;
};

inline std::string text_of(const ScatteringPoint& p) {
  return fmt::format("theta_i {:.17g} theta_r {:.17g} dphi {:.17g} sigma {:.17g} q {:.17g} n {:.17g} k {:.17g}",
                     p.angles.theta_i_deg, p.angles.theta_r_deg, p.angles.delta_phi_deg, p.shape.sigma, p.shape.q,
                     p.index.n, p.index.k);
}

inline ScatteringRequest request_of(Distribution distribution, Masking masking,
                                    const std::vector<ScatteringPoint>& points) {
  ScatteringRequest request;
  request.distribution = distribution;
  request.masking = masking;
  for (const ScatteringPoint& point : points) {
    const auto i = static_cast<std::uint32_t>(request.entries.size());
    request.angles.push_back(point.angles);
    request.shapes.push_back(point.shape);
    request.optics.push_back(point.index);
    request.entries.push_back({i, i, i});
  }
  return request;
}

/// Points with sigma 1e-3 to 5, q 1.01 to 1001 (smith masking: from 1.51), any index, and zeniths to 89.99 degrees.
class RandomPoints : public Draws {
 public:
  RandomPoints(std::uint64_t seed, Masking masking) : Draws(seed), masking_(masking) {
    std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  }

  std::vector<ScatteringPoint> draw(std::size_t count) {
    std::vector<ScatteringPoint> points(count);
    for (ScatteringPoint& point : points) {
      point.shape = {std::pow(10.0, uniform(-3.0, 0.7)), least_q() + std::pow(10.0, uniform(-2.0, 3.0))};
      point.index = index();
      point.angles = angles(point.shape.sigma, point.index);
    }
    return points;
  }

 private:
  double least_q() const { return masking_ == Masking::kSmith ? 1.5 : 1.0; }

  OpticalConstants index() {
    switch (static_cast<int>(uniform(0.0, 7.0))) {
      case 0:
        return {uniform(0.5, 27.0), uniform(1.0, 90.0)};
      case 1:
        return {uniform(0.2, 0.99), 0.0};
      case 2:
        return {uniform(0.01, 0.99), std::pow(10.0, uniform(-6.0, 0.5))};
      case 3:
        return {1.0 + std::pow(10.0, uniform(-6.0, -1.0)), 0.0};
      case 4:
        return {1000.0, 1000.0};
      default:
        return {uniform(1.1, 4.0), uniform(0.0, 1.0) < 0.5 ? 0.0 : uniform(0.0, 0.5)};
    }
  }

  // The default case has the probability 0.4. Its second direction is near the mirror direction of the first: zenith
  // and azimuth differ by at most 3 width_deg. width_deg is about sigma in degrees, at most 30.
  BeamAngles angles(double sigma, const OpticalConstants& index) {
    BeamAngles a{zenith(), zenith(), uniform(-180.0, 180.0)};
    const double width_deg = 60.0 * std::min(sigma, 0.5);
    switch (static_cast<int>(uniform(0.0, 10.0))) {
      case 0:
        return a;
      case 1:  // retro direction, exactly or nearly
        return {a.theta_i_deg, clamped(a.theta_i_deg + nearly_zero()), nearly_zero()};
      case 2:  // normal
        return {0.0, clamped(uniform(0.0, width_deg)), a.delta_phi_deg};
      case 3:
        return {clamped(std::abs(nearly_zero())), clamped(std::abs(nearly_zero())), a.delta_phi_deg};
      case 4:  // both directions near the critical angle, if there is one
        if (index.k == 0.0 && index.n < 1.0) a.theta_i_deg = std::asin(index.n) * 180.0 / 3.14159265358979323846;
        return {clamped(a.theta_i_deg), clamped(a.theta_i_deg + nearly_zero()), 180.0 - nearly_zero()};
      case 5:
        return {a.theta_i_deg, a.theta_r_deg, uniform(0.0, 1.0) < 0.5 ? 180.0 : 0.0};
      default:
        return {a.theta_i_deg, clamped(a.theta_i_deg + width_deg * uniform(-3.0, 3.0)),
                180.0 + width_deg * uniform(-3.0, 3.0)};
    }
  }

  double zenith() { return uniform(0.0, 1.0) < 0.3 ? 90.0 - std::pow(10.0, uniform(-2.0, 1.0)) : uniform(0.0, 89.0); }
  double nearly_zero() { return uniform(0.0, 1.0) < 0.2 ? 0.0 : std::pow(10.0, uniform(-9.0, 0.0)); }
  static double clamped(double zenith_deg) { return std::clamp(zenith_deg, 0.0, 89.99); }

  Masking masking_;
};

}  // namespace dolp
