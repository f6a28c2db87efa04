// Scenes and evaluators for tests of whole runs.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "fixed_precision.hpp"
#include "model/choices.hpp"
#include "reference/reference_evaluator.hpp"
#include "run/scene_run.hpp"

namespace scene_run_support {

using namespace dolp;

enum class Evaluator { kFloat, kDouble, kReference };

inline constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
inline constexpr std::array kDistributions = {Distribution::kCauchy, Distribution::kGaussian};
inline constexpr std::array kPrecisions = {Evaluator::kFloat, Evaluator::kDouble};

inline constexpr OpticalConstants kDielectric{1.508, 0.0};
inline constexpr OpticalConstants kAbsorbing{2.0, 0.7};
inline constexpr OpticalConstants kMetal{27.0, 90.0};
inline constexpr OpticalConstants kTotallyReflecting{0.6, 0.0};
inline constexpr std::array kIndices = {kDielectric, kAbsorbing, kMetal, kTotallyReflecting};

/// A scene at 300 K under surroundings of 240 K at 10.6 um. The surface has no diffuse part.
inline SceneValues make_scene(Distribution distribution, Masking masking, const OpticalConstants& index) {
  SceneValues scene;
  scene.surface.material.constant = index;
  scene.surface.distribution = distribution;
  scene.surface.masking = masking;
  scene.surface.sigma = 0.3;
  scene.emission = Emission{300.0, EmissionModel::kMoments};
  scene.surroundings = Surroundings{240.0};
  scene.spectrum = {10.6, 10.6};
  scene.grid = make_axes({60.0}, {0.3}, {2.0});
  return scene;
}

inline std::unique_ptr<ModelEvaluator> make_evaluator(Evaluator evaluator) {
  if (evaluator == Evaluator::kReference) return std::make_unique<ReferenceEvaluator>();
  return std::make_unique<FixedPrecision>(evaluator == Evaluator::kFloat ? Precision::kFloat : Precision::kDouble);
}

/// Runs a scene in the precision of the evaluator. Entries that miss the tolerance in float are not computed in double.
inline std::vector<PointResult> run(const SceneValues& scene, const SceneEntries& entries, Evaluator evaluator) {
  SceneValues own = scene;
  if (evaluator == Evaluator::kFloat) own.accuracy.precision = Precision::kFloat;
  if (evaluator == Evaluator::kDouble) own.accuracy.precision = Precision::kDouble;
  return evaluate_scene(own, entries, *make_evaluator(evaluator), {});
}

inline std::vector<SceneEntry> list_of(const SceneEntries& entries) {
  std::vector<SceneEntry> list;
  for (const SceneEntry& entry : entries.all()) list.push_back(entry);
  return list;
}

inline PointResult run_one(const SceneValues& scene, double theta_deg, const SlopeShape& shape, Evaluator evaluator) {
  return run(scene, {{theta_deg, shape, {}}}, evaluator).front();
}

/// Fresnel reflectances of a smooth surface.
struct SmoothReflectance {
  long double s = 0.0L;
  long double p = 0.0L;
  double rho_i() const { return static_cast<double>((s + p) / 2.0L); }
  double rho_q() const { return static_cast<double>((s - p) / 2.0L); }
};

inline SmoothReflectance smooth_reflectance(const OpticalConstants& index, long double cosine) {
  using Complex = std::complex<long double>;
  const Complex square = Complex(index.n, index.k) * Complex(index.n, index.k);
  const Complex w = std::sqrt(square - (1.0L - cosine * cosine));
  return {std::norm((cosine - w) / (cosine + w)), std::norm((square * cosine - w) / (square * cosine + w))};
}

/// All numbers of a result as bits, because NaN is not equal to NaN.
inline std::vector<std::uint64_t> bits_of(const PointResult& result) {
  std::vector<std::uint64_t> bits = {result.status};
  for (const Quantity quantity : kAllQuantities) bits.push_back(std::bit_cast<std::uint64_t>(result[quantity]));
  return bits;
}

/// Scene and entry for the message of a failed check.
inline std::string text_of(const SceneValues& scene, const SceneEntry& entry) {
  const OpticalConstants index = entry.index.value_or(scene.surface.material.constant);
  return std::string(to_name(scene.surface.distribution)) + " " + to_name(scene.surface.masking) + " theta " +
         std::to_string(entry.theta_deg) + " log10 sigma " + std::to_string(std::log10(entry.shape.sigma)) + " q " +
         std::to_string(entry.shape.q) + " N " + std::to_string(index.n) + " + " + std::to_string(index.k) + "i";
}

/// Calls `check` for every distribution with every masking.
template <class Check>
void for_each_model(Check&& check) {
  for (const Distribution distribution : kDistributions) {
    for (const Masking masking : kMaskings) check(distribution, masking);
  }
}

}  // namespace scene_run_support
