// Grids of the stainless-steel scene (host/scenes/stainless_steel.toml), of any size.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/moments.hpp"
#include "scene/scene.hpp"

namespace dolp::bench {

/// Number of values on each axis.
struct GridSize {
  std::size_t thetas = 1;
  std::size_t sigmas = 1;
  std::size_t qs = 1;

  std::size_t entries() const { return thetas * sigmas * qs; }
  std::string text() const;  ///< "64 x 64 x 64"
};

/// theta: 0 to 90 degrees. sigma: 0.05 to 1, q - 1: 0.75 to 7, both in equal ratios.
Axes steel_grid(const GridSize& size);

/// The unchanged surface of the scene with this grid.
SceneValues steel_scene(Masking masking, const GridSize& size);

/// The moments of the steel for every entry of a grid, in C order (q fastest).
MomentsRequest steel_request(Masking masking, const Axes& grid);

/// A grid of 64 x 64 x 64 entries for comparisons. No direction lies at 0 or 90 degrees, which some methods do not
/// support. It contains smaller grids of the same extent, so a slow method may compute only some of its entries.
struct NestedGrid {
  static constexpr std::size_t kSide = 64;
  static constexpr std::size_t kLargestStride = 8;

  /// Every `stride`-th value of each axis. `stride` is a power of two up to kLargestStride.
  static Axes with_stride(std::size_t stride);

  /// An entry that the grids of all strides have.
  struct Place {
    std::size_t theta = 0;  ///< positions in the grid of the largest stride
    std::size_t sigma = 0;
    std::size_t q = 0;
    std::size_t position(std::size_t stride) const;  ///< position in the request of the grid with this stride
  };
  /// `count` such entries, evenly spread, equal at each call.
  static std::vector<Place> sample(std::size_t count);
};

/// Only the entries of a sample, each with a separate direction and shape.
MomentsRequest sample_request(Masking masking, const std::vector<NestedGrid::Place>& sample);

}  // namespace dolp::bench
