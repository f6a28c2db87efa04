// What a command reports on stdout: a summary for people, or JSON for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/point_result.hpp"
#include "plan/effects.hpp"
#include "run/scene_run.hpp"
#include "scene/scene.hpp"

namespace dolp::cli {

/// The part of a grid where the albedo of the surface model is off: how many entries, and the smallest box around them.
struct EnergyRange {
  std::size_t entries = 0;
  double theta_min_deg = 0.0;  ///< of the view in bistatic mode
  double theta_max_deg = 0.0;
  double sigma_min = 0.0;
  double sigma_max = 0.0;
};

/// Everything there is to say about one run of a scene.
struct RunReport {
  std::string title;
  std::string output;
  std::string shape;  ///< "91 x 32 x 5 (theta x sigma x q)" or "200 points"
  std::size_t entries = 0;
  double tolerance = 0.0;
  double wall_s = 0.0;
  EffectPlan plan;
  std::vector<EffectRow> effects;
  EvaluationReport evaluation;
  // Empty when no entry promises anything.
  std::optional<double> worst_error;      ///< largest stated error of DOLP where status has none of the bits 1, 4, 8
  std::optional<double> worst_rho_error;  ///< largest stated relative error of rho where status has no bit 4
  struct StatusCount {
    std::string meaning;
    std::uint32_t bit = 0;
    std::size_t count = 0;
  };
  std::vector<StatusCount> status;   ///< entries that carry each bit
  std::size_t missed_tolerance = 0;  ///< entries with the bit of a missed tolerance
  double albedo_min = 0.0;
  double albedo_max = 0.0;
  EnergyRange loses;  ///< albedo below kAlbedoMin
  EnergyRange gains;  ///< albedo above kAlbedoMax
};

inline constexpr double kAlbedoMin = 0.95;
inline constexpr double kAlbedoMax = 1.05;

RunReport make_report(const Scene& scene, const SceneEntries& entries, const std::vector<PointResult>& results,
                      const EffectPlan& plan, const EvaluationReport& evaluation, double wall_s);

/// Names and reasons of what is kept, dropped and absent.
nlohmann::ordered_json effects_json(const std::vector<EffectRow>& effects, const EffectPlan& plan);

/// The same for people (several lines) and for programs.
std::string summary_text(const RunReport& report);
nlohmann::ordered_json summary_json(const RunReport& report);

/// Prints what `json` and `quiet` ask for: to stdout, or to stderr when the results themselves go to stdout.
void print_report(const RunReport& report, bool json, bool quiet);

}  // namespace dolp::cli
