// Grids of the stainless-steel scene (host/scenes/stainless_steel.toml), of any size.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/moments.hpp"
#include "scene/scene.hpp"

namespace dolp::bench {

/// Values on each axis.
struct GridSize {
  std::size_t thetas = 1;
  std::size_t sigmas = 1;
  std::size_t qs = 1;

  std::size_t entries() const { return thetas * sigmas * qs; }
  std::string text() const;  ///< "64 x 64 x 64"
};

/// theta: 0 to 90 degrees; sigma: 0.05 to 1, q - 1: 0.75 to 7, both in equal ratios.
Axes steel_grid(const GridSize& size);

/// The surface of the scene as it stands, with this grid.
SceneValues steel_scene(Masking masking, const GridSize& size);

/// The moments of the steel for every entry of a grid, in C order, q fastest.
MomentsRequest steel_request(Masking masking, const Axes& grid);

/// A grid of 64 x 64 x 64 entries for comparisons: no direction lies at 0 or 90 degrees, which not every method
/// supports, and it contains smaller grids of the same extent, so that a slow method may compute fewer of its entries.
struct NestedGrid {
  static constexpr std::size_t kSide = 64;
  static constexpr std::size_t kLargestStride = 8;

  /// Every `stride`-th value of each axis, a power of two up to kLargestStride.
  static Axes with_stride(std::size_t stride);

  /// An entry that all of them have.
  struct Place {
    std::size_t theta = 0;  ///< positions in the grid of the largest stride
    std::size_t sigma = 0;
    std::size_t q = 0;
    std::size_t position(std::size_t stride) const;  ///< in the request of that grid
  };
  /// `count` of them, evenly spread, the same at each call.
  static std::vector<Place> sample(std::size_t count);
};

/// The entries of a sample alone, each with a direction and a shape of its own.
MomentsRequest sample_request(Masking masking, const std::vector<NestedGrid::Place>& sample);

}  // namespace dolp::bench
