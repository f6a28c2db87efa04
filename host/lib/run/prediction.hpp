#pragma once

#include <functional>

#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"

namespace dolp {

/// Number of entries whose work the prediction counts. In a larger run they represent all entries.
inline constexpr std::size_t kCountedEntries = 256;

/// Number of directions whose entries are counted instead, if the entries of a direction share work.
inline constexpr std::size_t kCountedDirections = 6;

struct RunPrediction {
  std::size_t entries = 0;
  std::size_t spectral_samples = 0;
  std::size_t moments = 0;         ///< moments that the kernels compute in the first level; shared moments count once
  std::size_t interpolated = 0;    ///< moments that the first level interpolates
  std::size_t beams = 0;           ///< beams of the first level, each for one geometry and one index
  RefinementLevel first;           ///< precision and tolerance of the first level
  double first_evaluations = 0.0;  ///< integrand evaluations of the first level
  double again_share = 0.0;        ///< moments and beams of later levels, divided by those of the first level
  double again_evaluations = 0.0;
  double again_beams = 0.0;
  bool counts_directions = false;
  bool is_exact = true;     ///< all moments and beams were counted, none estimated from others
  double cpu_s = 0.0;       ///< time of all levels on this machine's processor, from counting
  double host_bytes = 0.0;  ///< memory for the largest part of the run, and for the columns being written
};

/// Functions that predict_run() calls with each request of the first level.
struct RequestVisitor {
  std::function<void(const MomentsRequest&)> moments;
  std::function<void(const ScatteringRequest&)> beams;
};

/// Counts the work of some entries, which the code of the run itself computes on the CPU: up to kCountedEntries
/// entries, spread evenly by a fixed sequence, or all entries of up to kCountedDirections directions. `has_double`:
/// true if the device of the run supports double precision.
/// Accuracy: exact for scenes with up to kCountedEntries entries, except for rule orders that a device chooses
/// differently because its float rounds differently. Larger runs: a few percent; a fifth if directions are counted
/// (tests Plan.FewEntries_*, Plan.ManyEntries_*, Plan.Device_*).
RunPrediction predict_run(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                          bool has_double, const RequestVisitor& visit);

}  // namespace dolp
