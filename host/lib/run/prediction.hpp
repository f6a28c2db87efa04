// Prediction of a run's cost before it starts.
#pragma once

#include <functional>

#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"

namespace dolp {

/// Number of a run's entries whose nodes are counted; they represent all entries of a larger run.
inline constexpr std::size_t kCountedEntries = 256;

/// Number of directions whose entries are counted instead, where the entries of a direction share their work (slope
/// samples, interpolation between slope distributions).
inline constexpr std::size_t kCountedDirections = 6;

/// Work of a run.
struct RunPrediction {
  std::size_t entries = 0;
  std::size_t spectral_samples = 0;
  std::size_t moments = 0;         ///< moments that the first level computes; shared moments count once
  std::size_t interpolated = 0;    ///< moments that it interpolates between others
  std::size_t beams = 0;           ///< values of f in the first level, for one geometry and index each
  RefinementLevel first;           ///< precision and tolerance of the first level
  double first_evaluations = 0.0;  ///< integrand evaluations of the first level
  double again_share =
      0.0;  ///< moments and beams of other levels, over the entries and beams that the first level gives
  double again_evaluations = 0.0;
  double again_beams = 0.0;
  bool counts_directions = false;
  bool is_exact = true;     ///< all moments and beams were counted, none estimated from others
  double cpu_s = 0.0;       ///< time of all levels on this machine's processor, from counting
  double host_bytes = 0.0;  ///< memory of the largest part, and of the columns that are written
};

/// Called with each request of the first level.
struct RequestVisitor {
  std::function<void(const MomentsRequest&)> moments;
  std::function<void(const ScatteringRequest&)> beams;
};

/// Counts the work by running up to kCountedEntries entries, or all of up to kCountedDirections directions, drawn
/// evenly by a fixed sequence, through the code of the run itself on the CPU. `has_double`: whether the device that
/// will run has it.
///
/// Accuracy: exact for scenes with up to kCountedEntries entries, but for orders that a device's float rounds
/// otherwise; a few percent beyond, or where directions are counted a fifth (tests Plan.FewEntries_*,
/// Plan.ManyEntries_*, Plan.Device_*).
RunPrediction predict_run(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                          bool has_double, const RequestVisitor& visit);

}  // namespace dolp
