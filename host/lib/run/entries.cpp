#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <dolp/errors.hpp>
#include <map>
#include <ranges>
#include <set>

#include <dolp/number_range.hpp>
#include "base/text.hpp"
#include "model/films.hpp"
#include "plan/slope_orders.hpp"
#include "run/part_requests.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_reader.hpp"
#include "table/table.hpp"

namespace dolp {
namespace {

void check_columns(const SceneValues& scene, const Points& points) {
  if (!points[Axis::kTheta] && scene.grid[Axis::kTheta].size() != 1) {
    throw InputError(
        fmt::format("{}: column \"theta_deg\" is missing, a number in {}; only a scene with a single grid.theta_deg "
                    "does without",
                    points.where(), kZenithDegRange.text()));
  }
  for (const Axis axis : {Axis::kN, Axis::kK}) {
    if (points[axis] && points[Axis::kMaterial])
      throw InputError(
          fmt::format("{}: columns \"material\" and \"{}\" cannot be combined", points.where(), describe(axis).column));
  }
  for (const Axis axis : {Axis::kViewZenith, Axis::kRelativeAzimuth}) {
    if (points[axis] && scene.geometry.mode != Mode::kBistatic)
      throw InputError(fmt::format("{}: column \"{}\" needs geometry.mode = \"bistatic\" in the scene", points.where(),
                                   describe(axis).column));
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

std::vector<std::pair<Axis, std::vector<double>>> variant_columns(const SceneValues& scene, const Points& points) {
  std::vector<std::pair<Axis, std::vector<double>>> columns;
  for (const Axis axis : kVariantAxes) {
    if (!points[axis] || points.size() == 0) continue;
    if (axis == Axis::kTemperature && !scene.emission)
      throw InputError(points.where() + ": column \"temperature_K\" needs [emission] in the scene");
    columns.emplace_back(axis, describe(axis).has_labels ? label_positions(points, axis, scene.labels) : *points[axis]);
  }
  return columns;
}

void check_wavelengths(const SceneValues& scene, const Points& points) {
  if (scene.spectrum.is_band()) {
    throw InputError(fmt::format(
        "{}: column \"wavelength_um\" cannot be combined with {}; set spectrum.wavelength_um in the scene, which "
        "replaces the band",
        points.where(), scene.spectrum.key()));
  }
  const std::vector<double>& all = *points[Axis::kWavelength];
  const auto [least, most] = std::ranges::minmax_element(all);
  for (const auto at : {least, most}) {
    try {
      at_wavelength(scene, *at);
    } catch (const InputError& error) {
      const auto row = static_cast<std::size_t>(at - all.begin());
      throw InputError(fmt::format("{}: wavelength_um = {}: {}", points.where(row), format_number(*at), error.what()));
    }
  }
}

void check_shapes(const SceneValues& scene, const Points& points) {
  const Surface& surface = scene.surface;
  const bool has_orders = surface.masking == Masking::kNone || surface.masking == Masking::kVCavity;
  if (points[Axis::kSigmaCross] && !has_orders && !surface.has_only_direct()) {
    throw InputError(points.where() + ": column \"sigma_cross\" needs surface.masking = \"none\" or \"v-cavity\", or " +
                     "\"smith\" and surface.sigma_cross in the scene");
  }
  if (points[Axis::kSigmaCross] && surface.wind_model == WindModel::kDirectional) {
    throw InputError(points.where() +
                     ": column \"sigma_cross\" cannot be combined with surface.wind_model = \"directional\"");
  }
  if (points[Axis::kSigmaCross] && scene.emission && scene.emission->has_bracket)
    throw InputError(points.where() + ": column \"sigma_cross\" needs emission.bracket = false in the scene");
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

void check_films(const SceneValues& scene, const Points& points) {
  const std::vector<Layer>& coating = scene.surface.coating;
  std::set<std::size_t> varied;
  for (std::size_t i = 0; i < coating.size(); ++i)
    if (coating[i].thickness_spread_um > 0.0) varied.insert(i);
  for (const auto& [film, column] : points.films) {
    const std::size_t layer = film.first + 1;
    if (layer > coating.size()) {
      throw InputError(fmt::format("{}: column of layer {}: the scene's surface.coating has {} layers", points.where(),
                                   layer, coating.size()));
    }
    if (film.second == FilmValue::Part::kSpread) varied.insert(film.first);
    if (varied.size() > kMostVariedFilms)
      throw InputError(
          fmt::format("{}: thickness_spread_um of layer {}: at most {} films of a coating can have a spread",
                      points.where(), layer, kMostVariedFilms));
    const bool is_thickness = film.second == FilmValue::Part::kThickness || film.second == FilmValue::Part::kSpread;
    if (is_thickness || coating[film.first].material.name.empty()) continue;
    throw InputError(fmt::format("{}: columns of n and k of layer {} need n and k of it in the scene, which has \"{}\"",
                                 points.where(), layer, coating[film.first].material.name));
  }
}

void check_cross_slopes(const SceneValues& scene, const SlopeShape& shape, const std::string& where) {
  if (!is_elliptic(shape)) return;
  const double most = largest_width_ratio(scene.accuracy.tolerance);
  if (widest_sigma(shape) <= most * narrowest_sigma(shape)) return;
  throw InputError(fmt::format(
      "{}: sigma = {} and sigma_cross = {}: the quotient of the widths along and across is at most {:.3g} at "
      "accuracy.tolerance = {:g}",
      where, format_number(shape.sigma), format_number(shape.sigma_cross), most, scene.accuracy.tolerance));
}

// A longer list is no grid, because the results of all parts of such a grid are kept until the last one is there.
constexpr std::size_t kMostGridPoints = 1U << 20U;

bool is_monotonic(const std::vector<double>& values) {
  return std::ranges::adjacent_find(values, std::ranges::greater_equal()) == values.end() ||
         std::ranges::adjacent_find(values, std::ranges::less_equal()) == values.end();
}

/// The only grid that can have the same entries as the points, in their order. Nullopt if none can, or if a list shares
/// more work: among several indices, or with few directions and slope distributions.
std::optional<SceneEntries> grid_like(const SceneValues& scene, const Points& points) {
  const auto is_column = [&](Axis axis) { return points[axis].has_value(); };
  const std::array<Axis, 5> index_axes = {Axis::kMaterial, Axis::kBand, Axis::kWavelength, Axis::kN, Axis::kK};
  if (!points.films.empty() || std::ranges::any_of(index_axes, is_column)) return std::nullopt;
  if (points.size() > kMostGridPoints) return std::nullopt;
  Axes axes = make_axes({scene.grid[Axis::kTheta].front()}, {scene.surface.sigma}, {scene.surface.q});
  std::size_t together = 1;  // points that differ only on the axes so far
  for (const Axis axis : std::views::reverse(kAllAxes)) {
    if (!points[axis]) continue;
    const std::vector<double>& column = *points[axis];
    axes[axis].clear();
    for (std::size_t row = 0; row < column.size() && (row == 0 || column[row] != column.front()); row += together)
      axes[axis].push_back(axis == Axis::kSigma ? shape_at(scene, points, row).sigma : column[row]);
    together *= axes[axis].size();
  }
  if (!std::ranges::all_of(axes, is_monotonic) || !is_worth_responses(scene, axis_counts(axes))) return std::nullopt;
  return SceneEntries::grid(std::move(axes), scene.surface.material.constant, scene.cross_slopes());
}

bool has_same_entries(const SceneEntries& grid, const SceneEntries& list) {
  EntryReader reader(grid);
  if (grid.size() != list.size()) return false;
  for (std::size_t i = 0; i < list.size(); ++i) {
    SceneEntry entry = reader[i];
    const SceneEntry listed = list[i];
    if (grid.variants()[entry.variant] != list.variants()[listed.variant]) return false;
    entry.variant = listed.variant;
    if (entry != listed) return false;
  }
  return true;
}

}  // namespace

void check_surface(const SceneValues& scene, const Points& points) {
  check_shapes(scene, points);
  check_films(scene, points);
}

void check_labels_chosen(const SceneValues& scene, const Points& points) {
  for (const Axis axis : kAllAxes) {
    const std::vector<std::string>& labels = scene.labels[axis];
    if (labels.size() < 2 || points[axis]) continue;
    const char* const key = axis == Axis::kMaterial ? "surface.material=NAME" : "spectrum.band_um=[FROM, TO]";
    const bool is_of_table = scene.known && !scene.known->table.empty();  // dolp lookup has no --set
    std::vector<std::string> ways;
    if (!is_of_table || points.name.empty()) ways.push_back(fmt::format("choose one with --set {}", key));
    if (!points.name.empty())
      ways.push_back(fmt::format("add the column \"{}\" to {}", describe(axis).column, points.name));
    throw InputError(fmt::format("{}: grid.{} has {} values; {}", is_of_table ? scene.known->table : scene.path_name,
                                 describe(axis).column, labels.size(), fmt::join(ways, ", or ")));
  }
}

SceneEntries grid_entries(const SceneValues& scene) {
  const PerAxis counts = axis_counts(scene.grid);
  double size = 1.0;
  for (const std::size_t count : counts) size *= static_cast<double>(count);
  if (size > static_cast<double>(kMostTableEntries)) {
    throw InputError(fmt::format("{}: grid: {} entries; at most {} in one table", scene.path_name,
                                 fmt::join(counts, " x "), kMostTableEntries));
  }
  SceneEntries entries = SceneEntries::grid(scene.grid, scene.surface.material.constant, scene.cross_slopes());
  for (std::size_t i = 0; scene.surface.has_cross_slopes() && i < entries.entries_per_direction(); ++i)
    check_cross_slopes(scene, entries[i].shape, scene.path_name);
  return entries;
}

SlopeShape shape_at(const SceneValues& scene, const Points& points, std::size_t row) {
  const bool is_directional = scene.surface.wind_model == WindModel::kDirectional;
  double sigma = value_or(points[Axis::kSigma], row, scene.surface.sigma);
  if (points.has_winds && is_directional) sigma = sigma_along_wind(wind_of_sigma(sigma));
  SlopeShape shape = scene.cross_slopes().shape(sigma, value_or(points[Axis::kQ], row, scene.surface.q));
  shape.sigma_cross = value_or(points[Axis::kSigmaCross], row, shape.sigma_cross);
  shape.azimuth_deg = value_or(points[Axis::kSurfaceAzimuth], row, shape.azimuth_deg);
  return shape;
}

SceneEntries point_entries(const SceneValues& scene, const Points& points) {
  check_columns(scene, points);
  check_surface(scene, points);
  const Surface& surface = scene.surface;
  const bool has_own_index = points[Axis::kN] || points[Axis::kK];
  const bool has_own_widths = points[Axis::kSigma] || points[Axis::kSigmaCross];
  const auto columns = variant_columns(scene, points);
  if (points[Axis::kWavelength] && points.size() > 0) check_wavelengths(scene, points);
  std::map<SceneVariant, std::uint32_t> variants;
  std::vector<SceneEntry> entries;
  entries.reserve(points.size());
  for (std::size_t row = 0; row < points.size(); ++row) {
    SceneEntry entry;
    entry.theta_deg = value_or(points[Axis::kTheta], row, scene.grid[Axis::kTheta].front());
    entry.shape = shape_at(scene, points, row);
    check_cross_slopes(scene, entry.shape, has_own_widths ? points.where(row) : scene.path_name);
    const OpticalConstants& index = surface.material.constant;
    if (has_own_index)
      entry.index =
          OpticalConstants{value_or(points[Axis::kN], row, index.n), value_or(points[Axis::kK], row, index.k)};
    if (points[Axis::kViewZenith]) entry.view_zenith_deg = (*points[Axis::kViewZenith])[row];
    if (points[Axis::kRelativeAzimuth]) entry.relative_azimuth_deg = (*points[Axis::kRelativeAzimuth])[row];
    SceneVariant variant{.films = points.films_at(row)};
    for (const auto& [axis, values] : columns) set_value(variant, axis, values[row]);
    entry.variant = variants.try_emplace(std::move(variant), static_cast<std::uint32_t>(variants.size())).first->second;
    entries.push_back(entry);
  }
  std::vector<SceneVariant> all(std::max<std::size_t>(1, variants.size()));
  for (const auto& [variant, position] : variants) all[position] = variant;
  SceneEntries list(std::move(entries), std::move(all), scene.cross_slopes().wind_model);
  std::optional<SceneEntries> grid = grid_like(scene, points);
  if (grid && has_same_entries(*grid, list)) return std::move(*grid);
  return list;
}

}  // namespace dolp
