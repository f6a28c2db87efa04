// The entries of a table or of a list of points.
#include <fmt/format.h>

#include "base/error.hpp"
#include "run/scene_run.hpp"
#include "scene/number_range.hpp"
#include "scene/text.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

/// Refuses points that lack what the scene does not say.
void check_columns(const Scene& scene, const Points& points) {
  if (!points.theta_deg && scene.grid.theta_deg.size() != 1) {
    throw InputError(
        fmt::format("{}:1: column \"theta_deg\" is missing, a number in {}; only a scene with a single grid.theta_deg "
                    "does without",
                    points.name, kZenithDegRange.text()));
  }
  if (points.n.has_value() != points.k.has_value() && !scene.surface.material.is_constant()) {
    const char* given = points.n ? "n" : "k";
    const char* missing = points.n ? "k" : "n";
    throw InputError(
        fmt::format("{}:1: column \"{}\" needs column \"{}\" beside it, because the scene's material \"{}\" "
                    "depends on the wavelength",
                    points.name, given, missing, scene.surface.material.name));
  }
}

double value_or(const std::optional<std::vector<double>>& column, std::size_t row, double fallback) {
  return column ? (*column)[row] : fallback;
}

}  // namespace

void check_smith(const Scene& scene, const Points& points) {
  const Surface& surface = scene.surface;
  if (surface.masking != Masking::kSmith || surface.distribution != Distribution::kCauchy || !points.q) return;
  for (std::size_t row = 0; row < points.size(); ++row) {
    const double q = (*points.q)[row];
    if (kSmithCauchyQRange.contains(q)) continue;
    throw InputError(
        fmt::format("{}:{}: q = {}: out of range, a number in {} with masking = \"smith\" and distribution = "
                    "\"cauchy\"",
                    points.name, points.line(row), format_number(q), kSmithCauchyQRange.text()));
  }
}

SceneEntries grid_entries(const Scene& scene) {
  const Grid& grid = scene.grid;
  const double count = static_cast<double>(grid.theta_deg.size()) * static_cast<double>(grid.sigma.size()) *
                       static_cast<double>(grid.q.size());
  if (count > static_cast<double>(kMostTableEntries)) {
    throw InputError(fmt::format("{}: grid: {} x {} x {} entries; at most {} in one table", scene.path_name,
                                 grid.theta_deg.size(), grid.sigma.size(), grid.q.size(), kMostTableEntries));
  }
  return SceneEntries::grid(grid.theta_deg, grid.sigma, grid.q);
}

SceneEntries point_entries(const Scene& scene, const Points& points) {
  check_columns(scene, points);
  check_smith(scene, points);
  const Surface& surface = scene.surface;
  const bool has_own_index = points.n || points.k;
  if (points.theta_deg && !points.sigma && !points.q && !has_own_index) {
    return SceneEntries::grid(*points.theta_deg, {surface.sigma}, {surface.q});
  }
  std::vector<SceneEntry> entries;
  entries.reserve(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    SceneEntry entry;
    entry.theta_deg = value_or(points.theta_deg, row, scene.grid.theta_deg.front());
    entry.shape = {value_or(points.sigma, row, surface.sigma), value_or(points.q, row, surface.q)};
    const OpticalConstants& index = surface.material.constant;
    if (has_own_index)
      entry.index = OpticalConstants{value_or(points.n, row, index.n), value_or(points.k, row, index.k)};
    entries.push_back(entry);
  }
  return entries;
}

}  // namespace dolp
