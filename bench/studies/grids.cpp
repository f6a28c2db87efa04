#include "studies/grids.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace dolp::bench {
namespace {

// Values of host/scenes/stainless_steel.toml: index, range of sigma, range of q - 1.
constexpr double kIndex = 1.508;
constexpr double kFirstSigma = 0.05;
constexpr double kLastSigma = 1.0;
constexpr double kFirstQMinus1 = 0.75;
constexpr double kLastQMinus1 = 7.0;
constexpr double kRightAngle = 90.0;

double share(std::size_t i, std::size_t count) {
  return count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
}

double in_equal_ratios(double first, double last, double share) { return first * std::pow(last / first, share); }

}  // namespace

std::string GridSize::text() const { return fmt::format("{} x {} x {}", thetas, sigmas, qs); }

Axes steel_grid(const GridSize& size) {
  Axes grid;
  for (std::size_t i = 0; i < size.thetas; ++i) grid[Axis::kTheta].push_back(kRightAngle * share(i, size.thetas));
  for (std::size_t i = 0; i < size.sigmas; ++i) {
    grid[Axis::kSigma].push_back(in_equal_ratios(kFirstSigma, kLastSigma, share(i, size.sigmas)));
  }
  for (std::size_t i = 0; i < size.qs; ++i) {
    grid[Axis::kQ].push_back(1.0 + in_equal_ratios(kFirstQMinus1, kLastQMinus1, share(i, size.qs)));
  }
  return grid;
}

SceneValues steel_scene(Masking masking, const GridSize& size) {
  SceneValues scene;
  scene.surface.material.constant = {kIndex, 0.0};
  scene.surface.masking = masking;
  scene.surface.sigma = 0.445;
  scene.surface.q = 5.0;
  scene.surface.specular = 0.5;
  scene.surface.diffuse = 0.3;
  scene.surface.diffuse_exponent = -0.1;
  scene.emission = Emission{298.15, EmissionModel::kMoments};
  Source source;
  source.relative_irradiance = 0.6;
  scene.source = source;
  scene.spectrum.min_um = scene.spectrum.max_um = 10.6;
  scene.grid = steel_grid(size);
  return scene;
}

MomentsRequest steel_request(Masking masking, const Axes& grid) {
  MomentsRequest request;
  request.masking = masking;
  request.theta_deg = grid[Axis::kTheta];
  request.optics = {{kIndex, 0.0}};
  request.shapes = shape_product(grid[Axis::kSigma], grid[Axis::kQ]);
  request.set_grid();
  return request;
}

}  // namespace dolp::bench
