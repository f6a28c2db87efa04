// The beam of the bistatic mode: f of the scene's one view direction for many sources and surfaces.
#pragma once

#include <vector>

#include "evaluate/moments.hpp"
#include "evaluate/radiometry/radiometry.hpp"

namespace dolp {

/// First column of f cos(theta_i) cos(theta_r) for each entry of a request, whose directions are those of the source;
/// by the shaders' text on the CPU in double, on all cores.
///
/// Units: sr-1.
/// Accuracy: 1e-11 of f_00, with `integral` and smith masking 1e-5 (tests RandomGeometries.AllElements_*,
/// MuellerAtGrazing.*).
std::vector<Scattered> scattered_beams(const MomentsRequest& request, double view_zenith_deg,
                                       double relative_azimuth_deg);

}  // namespace dolp
