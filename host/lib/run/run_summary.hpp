// Summary of results for reports, gathered part by part, with a self-check.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <cstdint>
#include <dolp/results.hpp>
#include <dolp/status.hpp>
#include <vector>
#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "scene/scene.hpp"

namespace dolp {

/// Check of all error bounds by the entries that were computed again.
struct SelfCheck {
  std::size_t entries = 0;
  double worst_ratio = 0.0;  ///< largest difference over the sum of the bounds of both results; above 1 a bound failed

  /// Adds the difference between `result` and `again`.
  void add(const PointResult& result, const PointResult& again);
  void add(const SelfCheck& other);
};

/// The number of a table's moments to compute again: they cost a fiftieth of all, and are at most 64 and 64 more for
/// each four million.
std::size_t checked_count(std::size_t moments);

/// `count` of the positions below `size`, ascending. They depend only on the seed.
std::vector<std::size_t> checked_positions(std::size_t size, std::size_t count, std::uint64_t seed);

inline constexpr double kAlbedoMin = 0.95;
inline constexpr double kAlbedoMax = 1.05;

/// Entries whose albedo is out of range, and the smallest box around them.
struct EnergyRange {
  std::size_t entries = 0;
  std::pair<double, double> theta_deg;  ///< zeniths of the view in bistatic mode
  std::pair<double, double> sigma;
};

struct RunSummary {
  std::size_t entries = 0;
  std::array<std::size_t, kStatusBits.size()> status{};
  std::optional<double> worst_error;      ///< error of DOLP, over entries that promise one
  std::optional<double> worst_rho_error;  ///< error of rho, over entries in the model's domain
  std::size_t albedos = 0;
  std::pair<double, double> albedo;
  EnergyRange loses, gains;
  double model_change = 0.0;  ///< largest PointResult::model_change of entries that promise their DOLP
  SelfCheck check;
  double radiometry_s = 0.0;
  Work work;

  /// Adds the results of some entries.
  void add(const SceneValues& scene, const SceneEntries& part, std::span<const PointResult> results);
  void add(const RunSummary& other);

  std::size_t count(std::uint32_t bit) const;
  /// True if DOLP and rho of all entries meet the tolerance.
  bool meets_tolerance() const { return count(kToleranceNotMet) + count(kRhoToleranceNotMet) == 0; }

  /// Writes the summary in one line, and reads it back. A line of another kind gives nothing.
  std::string text() const;
  static std::optional<RunSummary> from_text(const std::string& text);
};

}  // namespace dolp
