// Summary of results for reports, gathered part by part.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <dolp/results.hpp>
#include <dolp/status.hpp>
#include "model/evaluator.hpp"
#include "model/scene_entry.hpp"
#include "run/self_check.hpp"
#include "scene/scene.hpp"

namespace dolp {

inline constexpr double kAlbedoMin = 0.95;
inline constexpr double kAlbedoMax = 1.05;

/// Entries whose albedo is out of range, and the smallest box around them.
struct EnergyRange {
  std::size_t entries = 0;
  std::pair<double, double> theta_deg;  ///< of the view in bistatic mode
  std::pair<double, double> sigma;
};

struct RunSummary {
  std::size_t entries = 0;
  std::array<std::size_t, kStatusBits.size()> status{};
  std::optional<double> worst_error;      ///< of DOLP, of entries that promise one
  std::optional<double> worst_rho_error;  ///< of rho, of entries in the model's domain
  std::size_t albedos = 0;
  std::pair<double, double> albedo;
  EnergyRange loses, gains;
  SelfCheck check;
  double radiometry_s = 0.0;
  // Totals of the evaluator.
  double evaluations = 0.0;
  double kernel_s = 0.0, sums_s = 0.0;
  std::uint64_t dispatches = 0, interpolated = 0, interpolation_nodes = 0;

  /// Adds the results of some entries.
  void add(const SceneValues& scene, const SceneEntries& part, std::span<const PointResult> results);
  void add(const RunSummary& other);
  /// Adds an evaluator's counts and kernel time to those of the summary.
  void add(const EvaluationReport& report);
  /// The report of an evaluator with the totals of the summary.
  EvaluationReport totals(EvaluationReport report) const;

  std::size_t count(std::uint32_t bit) const;

  /// Writes the summary in one line, and reads it back. A line of another kind gives nothing.
  std::string text() const;
  static std::optional<RunSummary> from_text(const std::string& text);
};

}  // namespace dolp
