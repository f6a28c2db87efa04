#pragma once

#include <functional>

#include "model/moments.hpp"
#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "plan/effects.hpp"
#include "plan/refinement.hpp"

namespace dolp {

/// Largest number of entries that the prediction computes. If the run has more, a sample of this size represents them.
inline constexpr std::size_t kCountedEntries = 256;

/// If the entries of a direction share work, the prediction computes whole directions instead, at most this many.
inline constexpr std::size_t kCountedDirections = 6;

/// With films or measured reflectances, the sample has the part of a band that has about so many spectral samples.
inline constexpr std::size_t kCountedSamples = 8;

/// A first sample with about so many moments, or with one direction, decides how large the sample may be.
inline constexpr std::size_t kFewCountedMoments = 8;

// Each of two parts of a plan, the sample and the forecast of lookups, may take 1 / kPlanShare of the run. It may take
// kFreeEvaluations integrand evaluations in any case, which one core computes in about 0.1 s. With films or measured
// reflectances an evaluation takes about three times as long.
inline constexpr double kPlanShare = 25.0;
inline constexpr double kFreeEvaluations = 1e6;
inline constexpr double kFreeEvaluationsOfCurves = 2e5;

/// Integrand evaluations that a part of a plan may take for a run of `scene` with so many evaluations.
double allowed_evaluations(const SceneValues& scene, double run_evaluations);

struct RunPrediction {
  std::size_t entries = 0;
  std::size_t spectral_samples = 0;
  std::size_t moments = 0;         ///< moments that kernels compute in the first refinement level
  std::size_t interpolated = 0;    ///< moments that the first refinement level gets without a kernel
  std::size_t beams = 0;           ///< beams of the first refinement level
  RefinementLevel first;           ///< precision and tolerance of the first level
  double first_evaluations = 0.0;  ///< integrand evaluations of the first level
  double again_share = 0.0;        ///< number of moments and beams in later levels, divided by the number in the first
  double again_evaluations = 0.0;
  double again_beams = 0.0;
  bool counts_directions = false;
  bool has_double = false;             ///< the device of the run supports double
  std::size_t counted_entries = 0;     ///< size of the sample
  std::size_t counted_directions = 0;  ///< number of directions of the sample, if counts_directions
  double counted_evaluations = 0.0;    ///< integrand evaluations that the prediction took
  bool is_exact = true;                ///< the prediction counted all moments and beams, without estimates
  double cpu_s = 0.0;                  ///< time of all levels on this CPU, extrapolated from the computed entries
  double host_bytes = 0.0;  ///< host memory for the largest part of the run and for table columns still being written
};

/// predict_run() calls it with each request for moments of the first level.
using RequestVisitor = std::function<void(const MomentsRequest&)>;

/// Predicts the work of a run from a sample that the CPU computes: at most kCountedEntries entries, or at most
/// kCountedDirections directions if their entries share work. The sample is smaller if it would take more than
/// allowed_evaluations(). `has_double`: the device of the run supports double. The prediction is exact if the sample is
/// the whole run and the device rounds like the CPU. Otherwise it errs by a few percent, or by a fifth for directions
/// (tests Plan.FewEntries_*, Plan.ManyEntries_*, Plan.Device_*).
RunPrediction predict_run(const SceneValues& scene, const SceneEntries& entries, const EffectPlan& plan,
                          bool has_double, const RequestVisitor& visit);

}  // namespace dolp
