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

}  // namespace dolp::bench
