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
  source.kind = Source::Kind::kRelative;
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
  request.sigma = grid[Axis::kSigma];
  request.q = grid[Axis::kQ];
  return request;
}

Axes NestedGrid::with_stride(std::size_t stride) {
  const Axes all = steel_grid({kSide, kSide, kSide});
  Axes grid;
  for (std::size_t i = 0; i < kSide; i += stride) {
    grid[Axis::kTheta].push_back(kRightAngle * (static_cast<double>(i) + 0.5) / static_cast<double>(kSide));
    grid[Axis::kSigma].push_back(all[Axis::kSigma][i]);
    grid[Axis::kQ].push_back(all[Axis::kQ][i]);
  }
  return grid;
}

std::size_t NestedGrid::Place::position(std::size_t stride) const {
  const std::size_t step = kLargestStride / stride;
  const std::size_t side = kSide / stride;
  return ((theta * step) * side + sigma * step) * side + q * step;
}

std::vector<NestedGrid::Place> NestedGrid::sample(std::size_t count) {
  constexpr std::size_t kPlaces = kSide / kLargestStride;
  std::vector<Place> places;
  for (std::size_t i = 0; i < count; ++i) {
    // The fractional parts of multiples of an irrational number fill [0, 1) evenly and never repeat.
    const auto position = [&](double irrational) {
      const double x = (static_cast<double>(i) + 0.5) * irrational;
      return static_cast<std::size_t>(static_cast<double>(kPlaces) * (x - std::floor(x)));
    };
    places.push_back({position(std::numbers::phi), position(std::numbers::sqrt2), position(std::numbers::sqrt3)});
  }
  return places;
}

MomentsRequest sample_request(Masking masking, const std::vector<NestedGrid::Place>& sample) {
  const Axes grid = NestedGrid::with_stride(NestedGrid::kLargestStride);
  MomentsRequest request;
  request.masking = masking;
  for (const NestedGrid::Place& place : sample) {
    request.append(
        {grid[Axis::kTheta][place.theta], {grid[Axis::kSigma][place.sigma], grid[Axis::kQ][place.q]}, {kIndex, 0.0}});
  }
  return request;
}

}  // namespace dolp::bench
