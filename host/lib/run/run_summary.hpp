#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <cstdint>
#include <dolp/status.hpp>
#include <vector>
#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "run/run_results.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// A check of the error bounds: a run computes some entries a second time in another way.
struct SelfCheck {
  std::size_t entries = 0;
  /// Largest ratio of the difference of an entry's two results to the sum of their bounds. Above 1, a bound was wrong.
  double worst_ratio = 0.0;

  void add(const PointResult& result, const PointResult& again);
  void add(const SelfCheck& other);
};

/// Number of moments that the check of a table computes again. They cost at most a fiftieth of the run.
std::size_t checked_count(std::size_t moments);

/// Positions of `count` random entries of a table with `size` entries, or of all entries if there are fewer. No
/// position appears twice; they ascend. `seed` fixes the choice.
std::vector<std::size_t> sample_positions(std::size_t size, std::size_t count, std::uint64_t seed);

inline constexpr double kAlbedoMin = 0.95;
inline constexpr double kAlbedoMax = 1.05;

/// Number and ranges of the entries that lose energy (albedo < kAlbedoMin), or that gain energy (albedo > kAlbedoMax).
struct EnergyRange {
  std::size_t entries = 0;
  std::pair<double, double> theta_deg;  ///< zenith angle of the view in bistatic mode, otherwise theta
  std::pair<double, double> sigma;
};

/// How much further bounces change some entries. Entries for which promises_dolp() is false do not count.
struct ModelChange {
  double i = 0.0;            ///< largest PointResult::model_change
  double dolp_points = 0.0;  ///< largest PointResult::model_change_dolp, in percentage points
  std::uint32_t status = 0;  ///< kModelInaccurate if an entry has this bit

  void add(const PointResult& result);
  void add(const ModelChange& other);
};

struct RunSummary {
  std::size_t entries = 0;
  std::array<std::size_t, kStatusBits.size()> status{};
  std::optional<double> worst_error;      ///< largest error bound of DOLP among entries for which promises_dolp() holds
  std::optional<double> worst_rho_error;  ///< largest error bound of rho among entries in the model's domain
  std::size_t albedos = 0;
  std::pair<double, double> albedo;
  EnergyRange loses, gains;
  ModelChange model_change;
  SelfCheck check;
  double response_basis_s = 0.0;  ///< time to plan which moments kernels compute (MomentsPlan), with its responses
  double radiometry_s = 0.0;
  double check_s = 0.0;  ///< time of the check, which the other times do not contain
  Work work;

  void add(const SceneValues& scene, const SceneEntries& part, const RunResults& results);
  void add(const RunSummary& other);

  std::size_t count(std::uint32_t bit) const;
  bool meets_tolerance() const { return count(kToleranceNotMet) + count(kRhoToleranceNotMet) == 0; }

  /// text() writes the summary as one line; from_text() reads that line, and returns nothing for any other line. The
  /// line has no times, because they are parts of the time of one run.
  std::string text() const;
  static std::optional<RunSummary> from_text(const std::string& text);
};

}  // namespace dolp
