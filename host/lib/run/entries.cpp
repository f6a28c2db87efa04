// The entries of a table or of a list of points.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <dolp/errors.hpp>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "run/scene_run.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

/// Refuses points that lack a value which the scene does not give either.
void check_columns(const SceneValues& scene, const Points& points) {
  if (!points[Axis::kTheta] && scene.grid[Axis::kTheta].size() != 1) {
    throw InputError(
        fmt::format("{}: column \"theta_deg\" is missing, a number in {}; only a scene with a single grid.theta_deg "
                    "does without",
                    points.where(), kZenithDegRange.text()));
  }
  const Material& material = scene.surface.material;
  const bool is_dispersive = !material.is_constant() || (points[Axis::kWavelength] && material.tabulated);
  const bool has_n = points[Axis::kN].has_value();
  if (has_n != points[Axis::kK].has_value() && is_dispersive) {
    const char* given = has_n ? "n" : "k";
    const char* missing = has_n ? "k" : "n";
    throw InputError(
        fmt::format("{}: column \"{}\" needs column \"{}\" beside it, because the scene's material \"{}\" "
                    "depends on the wavelength",
                    points.where(), given, missing, material.name));
  }
}

/// The distinct wavelengths of the points, which all must be where n, k and E0 are known.
std::vector<double> wavelengths_of(const SceneValues& scene, const Points& points) {
  if (scene.spectrum.is_band()) {
    throw InputError(
        fmt::format("{}: column \"wavelength_um\" cannot be combined with spectrum.band_um", points.where()));
  }
  const std::vector<double>& all = *points[Axis::kWavelength];
  std::vector<double> wavelengths = all;
  std::ranges::sort(wavelengths);
  const auto twice = std::ranges::unique(wavelengths);
  wavelengths.erase(twice.begin(), twice.end());
  for (const double wavelength_um : {wavelengths.front(), wavelengths.back()}) {
    try {
      at_wavelength(scene, wavelength_um);
    } catch (const InputError& error) {
      const auto row = static_cast<std::size_t>(std::ranges::find(all, wavelength_um) - all.begin());
      throw InputError(
          fmt::format("{}: wavelength_um = {}: {}", points.where(row), format_number(wavelength_um), error.what()));
    }
  }
  return wavelengths;
}

}  // namespace

void check_shapes(const SceneValues& scene, const Points& points) {
  const Surface& surface = scene.surface;
  if (points.has_winds && surface.distribution != Distribution::kGaussian) {
    throw InputError(points.where() + ": column \"wind_m_s\" needs surface.distribution = \"gaussian\"");
  }
  if (surface.masking != Masking::kSmith || surface.distribution != Distribution::kCauchy || !points[Axis::kQ]) return;
  for (std::size_t row = 0; row < points.size(); ++row) {
    const double q = (*points[Axis::kQ])[row];
    if (kSmithCauchyQRange.contains(q)) continue;
    throw InputError(
        fmt::format("{}: q = {}: out of range; must be a number in {} with masking = \"smith\" and distribution = "
                    "\"cauchy\"",
                    points.where(row), format_number(q), kSmithCauchyQRange.text()));
  }
}

SceneEntries grid_entries(const SceneValues& scene) {
  const PerAxis counts = counts_of(scene.grid);
  double size = 1.0;
  for (const std::size_t count : counts) size *= static_cast<double>(count);
  if (size > static_cast<double>(kMostTableEntries)) {
    throw InputError(fmt::format("{}: grid: {} entries; at most {} in one table", scene.path_name,
                                 fmt::join(counts, " x "), kMostTableEntries));
  }
  return SceneEntries::of_grid(scene.grid, scene.surface.material.constant);
}

SceneEntries point_entries(const SceneValues& scene, const Points& points) {
  check_columns(scene, points);
  check_shapes(scene, points);
  const Surface& surface = scene.surface;
  const bool has_own_index = points[Axis::kN] || points[Axis::kK];
  const bool has_wavelength = points[Axis::kWavelength] && points.size() > 0;
  if (points[Axis::kTheta] && !points[Axis::kSigma] && !points[Axis::kQ] && !has_own_index && !has_wavelength) {
    return SceneEntries::grid(*points[Axis::kTheta], {surface.sigma}, {surface.q});
  }
  const std::vector<double> wavelengths = has_wavelength ? wavelengths_of(scene, points) : std::vector<double>{};
  std::vector<SceneEntry> entries;
  entries.reserve(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    SceneEntry entry;
    entry.theta_deg = value_or(points[Axis::kTheta], row, scene.grid[Axis::kTheta].front());
    entry.shape = {value_or(points[Axis::kSigma], row, surface.sigma), value_or(points[Axis::kQ], row, surface.q)};
    const OpticalConstants& index = surface.material.constant;
    if (has_own_index)
      entry.index =
          OpticalConstants{value_or(points[Axis::kN], row, index.n), value_or(points[Axis::kK], row, index.k)};
    if (has_wavelength) {
      const auto found = std::ranges::lower_bound(wavelengths, (*points[Axis::kWavelength])[row]);
      entry.wavelength = static_cast<std::uint32_t>(found - wavelengths.begin());
    }
    entries.push_back(entry);
  }
  return {std::move(entries), wavelengths};
}

}  // namespace dolp
