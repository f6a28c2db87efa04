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

/// theta from 0 to 90 degrees in equal steps; sigma from 0.05 to 1, and q - 1 from 0.75 to 7, in equal ratios.
Axes steel_grid(const GridSize& size);

/// The stainless-steel scene with this masking and with a grid of this size.
SceneValues steel_scene(Masking masking, const GridSize& size);

/// The moments of the steel for every entry of a grid, in C order (q fastest).
MomentsRequest steel_request(Masking masking, const Axes& grid);

/// A grid of 64 x 64 x 64 entries, and coarser grids that hold a part of these entries. Slow methods run on the coarser
/// grids. theta is never 0 or 90 degrees, because some methods do not support these directions.
struct NestedGrid {
  static constexpr std::size_t kSide = 64;
  static constexpr std::size_t kLargestStride = 8;

  /// The grid with every `stride`-th value of each axis. `stride` is a power of two up to kLargestStride.
  static Axes with_stride(std::size_t stride);

  /// An entry that all these grids contain. The members are its positions on the axes of the coarsest grid.
  struct Place {
    std::size_t theta = 0;
    std::size_t sigma = 0;
    std::size_t q = 0;
    std::size_t position(std::size_t stride) const;  ///< position of the entry in the grid with_stride(stride)
  };
  /// Chooses `count` entries, spread evenly over the grid. Every call returns the same entries.
  static std::vector<Place> sample(std::size_t count);
};

/// A request for only the entries of the sample, as a list of points.
MomentsRequest sample_request(Masking masking, const std::vector<NestedGrid::Place>& sample);

}  // namespace dolp::bench
