#include "run/scene_remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <dolp/number_range.hpp>
#include "model/smooth_surface.hpp"
#include "scene/scene_document.hpp"
#include "scene/spectral_data.hpp"
#include "spectrum/planck.hpp"
#include "spectrum/sky_factors.hpp"

namespace dolp {
namespace {

constexpr double kLikelyNanometresOfFilm = 100.0;
constexpr double kHotSky = 2.0;  // a sky hotter than this times the surface gets a remark
// A file has a gap between neighbouring rows if the ratio of their wavelengths reaches a limit. The limit is
// exp(kUsualSpacings * median of ln(ratio)), but at least kNoGapRatio and at most kGapRatio.
constexpr double kGapRatio = 2.0;
constexpr double kNoGapRatio = 1.5;
constexpr double kUsualSpacings = 10.0;
// Rows get a remark if CoarseRows::change (see below) is at least kCoarseChange. Its divisor is at least kLeastPart.
constexpr double kCoarseChange = 0.05;
constexpr double kLeastPart = 0.01;

// Fewer zeniths, or zeniths only below kLeastLikelyRadians, may be meant as degrees near normal incidence.
constexpr std::size_t kFewAngles = 4;
constexpr double kLeastLikelyRadians = 0.5;
constexpr double kSteepSigma = 2.0;
constexpr std::size_t kMostWavelengths = 1000;  // of points, for remarks on files

using Interval = std::pair<double, double>;

/// The wavelengths that a scene uses, as intervals. A single wavelength is an interval of length 0.
std::vector<Interval> used_um(const SceneValues& scene) {
  const std::vector<double>& grid = scene.grid[Axis::kWavelength];
  std::vector<Interval> used;
  for (const Spectrum& band : scene.bands) used.emplace_back(band.min_um, band.max_um);
  if (grid.empty() && used.empty()) return {{scene.spectrum.min_um, scene.spectrum.max_um}};
  for (const double um : grid) used.emplace_back(um, um);
  return used;
}

double least_gap_ratio(const std::vector<double>& wavelength_um) {
  std::vector<double> spacings;
  for (std::size_t i = 1; i < wavelength_um.size(); ++i)
    spacings.push_back(std::log(wavelength_um[i] / wavelength_um[i - 1]));
  const auto median = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::ranges::nth_element(spacings, median);
  return std::clamp(std::exp(kUsualSpacings * *median), kNoGapRatio, kGapRatio);
}

/// The widest gap between rows, among those gaps that contain wavelengths of the scene. dolp interpolates in such gaps.
std::optional<Interval> bridged_gap(const SpectralTable& table, const std::vector<Interval>& used) {
  const std::vector<double>& um = table.wavelength_um;
  if (um.size() < 2 || table.formula.number != 0) return std::nullopt;
  std::optional<Interval> widest;
  double ratio = least_gap_ratio(um);
  for (const auto& [low, high] : used) {
    for (auto above = std::upper_bound(um.begin() + 1, um.end(), low); above != um.end() && above[-1] < high; ++above) {
      if (above[0] < ratio * above[-1]) continue;
      widest = {above[-1], above[0]};
      ratio = above[0] / above[-1];
    }
  }
  return widest;
}

/// Where interpolation errs most. `change`: its error of the normal reflectance R, divided by min(R, 1 - R).
struct CoarseRows {
  double at_um = 0.0;
  double change = 0.0;
};

double normal_reflectance(const OpticalConstants& index) {
  return (std::pow(index.n - 1.0, 2) + std::pow(index.k, 2)) / (std::pow(index.n + 1.0, 2) + std::pow(index.k, 2));
}

/// Compares the reflectance R of each row with R for n and k interpolated between the two neighbouring rows. These two
/// are twice as far apart as successive rows, so the difference is about four times the error between successive rows.
CoarseRows coarsest_rows(const Material& material, const std::vector<Interval>& used) {
  CoarseRows worst;
  const std::vector<double>& um = material.n.wavelength_um;
  for (std::size_t i = 1; i + 1 < um.size(); ++i) {
    const auto uses = [&](const Interval& part) {
      return um[i - 1] < part.second && um[i + 1] > part.first && part != Interval{um[i], um[i]};
    };
    if (std::ranges::none_of(used, uses)) continue;
    const OpticalConstants before = material.at(um[i - 1]);
    const OpticalConstants after = material.at(um[i + 1]);
    const double share = (um[i] - um[i - 1]) / (um[i + 1] - um[i - 1]);
    const double right = normal_reflectance(material.at(um[i]));
    const double line = normal_reflectance({std::lerp(before.n, after.n, share), std::lerp(before.k, after.k, share)});
    const double change = 0.25 * std::abs(right - line) / std::max(std::min(right, 1.0 - right), kLeastPart);
    if (change > worst.change) worst = {um[i], change};
  }
  return worst;
}

class Remarks {
 public:
  explicit Remarks(const SceneValues& scene) : scene_(scene) {}
  /// Remarks on a scene whose axes have the values of the points.
  Remarks(const SceneValues& scene, const Points& points) : scene_(scene), points_(&points) {
    for (const Axis axis : kAllAxes)
      if (points[axis] && !points[axis]->empty() && !describe(axis).has_labels) scene_.grid[axis] = *points[axis];
    std::vector<double>& um = scene_.grid[Axis::kWavelength];  // those of files of rows are compared with each row
    if (um.size() <= kMostWavelengths) return;
    std::ranges::sort(um);
    for (std::size_t i = 0; i < kMostWavelengths; ++i) um[i] = um[i * (um.size() - 1) / (kMostWavelengths - 1)];
    um.resize(kMostWavelengths);
  }

  void add(const std::string& key, const std::string& what) { lines_.push_back(scene_.document->prefix(key) + what); }

  /// A remark on the values of an axis, or on one of them. The scene has them in [grid] or, where it has no such axis,
  /// in `key`.
  void add(Axis axis, const std::string& key, const std::string& what, std::optional<double> value = {}) {
    const std::string column = describe(axis).column;
    if (points_ && (*points_)[axis]) {
      lines_.push_back(fmt::format("{}: {}: {}", value ? place(*(*points_)[axis], *value) : points_->where(),
                                   points_->has_winds && axis == Axis::kSigma ? kWind.column : column, what));
    } else {
      add(scene_.document->find("grid." + column) ? "grid." + column : key, what);
    }
  }

  void add_sorted_axes() {
    std::vector<const char*> columns = {kWind.column};
    for (const Axis axis : kAllAxes) {
      if (!describe(axis).has_labels) columns.push_back(describe(axis).column);
    }
    for (const char* const column : columns) {
      const std::string key = std::string("grid.") + column;
      const toml::node* const node = scene_.document->find(key);
      std::vector<double> values;
      if (const toml::array* const list = node ? node->as_array() : nullptr) {
        for (const toml::node& value : *list) values.push_back(value.value_or(0.0));
      }
      if (!std::ranges::is_sorted(values) && !std::ranges::is_sorted(values, std::greater<>()))
        add(key, "neither ascends nor descends; the table has the values in ascending order");
    }
  }

  void add_wavelengths() {
    for (const auto& [low, high] : used_um(scene_)) {
      if (high <= kLikelyNanometres) continue;
      add(Axis::kWavelength,
          !scene_.bands.empty()       ? "grid.band_um"
          : scene_.spectrum.is_band() ? scene_.spectrum.key()
                                      : "spectrum.wavelength_um",
          "is in micrometres; were nanometres or wavenumbers meant?", high);
      return;
    }
  }

  void add_temperatures() {
    const auto check = [&](const char* key, double lowest_K) {
      if (lowest_K < kLikelyCelsius_K) add(key, fmt::format("{} K is cold; were degrees Celsius meant?", lowest_K));
    };
    if (const std::optional<double> surface_K = coldest_K(); surface_K && *surface_K < kLikelyCelsius_K)
      add(Axis::kTemperature, "emission.temperature_K",
          fmt::format("{} K is cold; were degrees Celsius meant?", *surface_K), surface_K);
    if (scene_.path && scene_.path->temperature_K) check("path.temperature_K", *scene_.path->temperature_K);
    if (!scene_.surroundings) return;
    const SkyProfile* profile = scene_.surroundings->profile.get();
    if (profile && profile->kind == SkyProfile::Kind::kTemperature)
      check(surroundings_key(), std::ranges::min(profile->values));
    if (!profile) check(surroundings_key(), scene_.surroundings->temperature_K);
    add_hot_sky(profile);
    add_sky_beyond_data(profile);
  }

  void add_files() {
    if (!scene_.names.material_file.empty()) add_material("surface.material_file", scene_.surface.material);
    if (!scene_.names.material.empty()) add_coarse_rows("surface.material", scene_.surface.material);
    for (const Material& material : scene_.materials ? *scene_.materials : std::vector<Material>{})
      add_coarse_rows("grid.material", material, material.name + ": ");
    for (std::size_t i = 0; i < scene_.surface.coating.size(); ++i) {
      const Layer& layer = scene_.surface.coating[i];
      const std::string key = fmt::format("surface.coating.{}.", i + 1);
      if (!scene_.names.coating[i].material_file.empty()) add_material(key + "material_file", layer.material);
      if (!scene_.names.coating[i].material.empty()) add_coarse_rows(key + "material", layer.material);
      if (layer.thickness_um >= kLikelyNanometresOfFilm) add(key + "thickness_um", kThickFilm);
      if (layer.thickness_spread_um > layer.thickness_um)
        add(key + "thickness_spread_um", "is above the mean thickness; thicknesses below 0 are left out");
    }
    if (!scene_.names.reflectance_file.empty()) add_reflectances("surface.reflectance_file");
    if (!scene_.names.source_file.empty()) add_gap("source.file", bridged_gap(*scene_.source->table, used_um(scene_)));
  }

  void add_mode() {
    if (scene_.geometry.mode == Mode::kBistatic) {
      if (!scene_.source) add("geometry.mode", "without [source] nothing depends on theta, the zenith of the source");
      return;
    }
    if (scene_.source)
      add(source_key(),
          "mode hemispherical adds the light that the surface reflects from the source into all directions; a camera "
          "needs geometry.mode = \"bistatic\"");
    for (const char* key : {"geometry.view_zenith_deg", "geometry.relative_azimuth_deg"})
      if (scene_.document->find(key))
        add(key, "has no effect: mode hemispherical has its view at grid.theta_deg; mode bistatic uses it");
  }

  void add_angles_and_slopes() {
    for (const char* key : {"geometry.surface_azimuth_deg", "grid.surface_azimuth_deg"})
      if (scene_.document->find(key) && !has_cross_slopes()) add(key, kUnusedAzimuth);
    if (points_ && (*points_)[Axis::kSurfaceAzimuth] && !has_cross_slopes())
      add(Axis::kSurfaceAzimuth, "", kUnusedAzimuth);
    for (const Axis axis : {Axis::kTheta, Axis::kViewZenith}) {
      const std::vector<double>& zeniths_deg = scene_.grid[axis];
      const double most_deg = zeniths_deg.empty() ? 0.0 : std::ranges::max(zeniths_deg);
      if (most_deg > kLeastLikelyRadians && most_deg < kLikelyRadians &&
          std::set<double>(zeniths_deg.begin(), zeniths_deg.end()).size() >= kFewAngles)
        add(axis, "", fmt::format("is at most {} degrees; is it in radians?", most_deg));
    }
    const double roughest = std::ranges::max(scene_.grid[Axis::kSigma]);
    if (roughest > kSteepSigma)
      add(Axis::kSigma, "surface.sigma",
          fmt::format("{} is a slope of {:.0f} degrees, not a height; real surfaces have less than {:g}", roughest,
                      std::atan(roughest) * 180.0 / std::numbers::pi, kSteepSigma),
          roughest);
  }

  void add_diffuse() {
    const Surface& surface = scene_.surface;
    const bool has_diffuse = surface.diffuse > 0.0 || surface.diffuse_table;
    if (!has_diffuse && surface.diffuse_polarisation != DiffusePolarisation::kNone)
      add("surface.diffuse_polarisation",
          "has no effect: the surface has no diffuse part; surface.diffuse gives it one");
  }

  void add_films_of_points() {
    for (const auto& [film, column] : points_->films) {
      if (film.second != FilmValue::Part::kThickness || column->empty()) continue;
      const double thickest = std::ranges::max(*column);
      if (thickest >= kLikelyNanometresOfFilm)
        lines_.push_back(fmt::format("{}: surface.coating.{}.thickness_um: {}", place(*column, thickest),
                                     film.first + 1, kThickFilm));
    }
  }

  std::vector<std::string> lines() && { return std::move(lines_); }

 private:
  static constexpr const char* kUnusedAzimuth =
      "has no effect where slopes are equal along and across; give surface.sigma_cross or surface.wind_model";
  static constexpr const char* kThickFilm = "is in micrometres; were nanometres meant?";

  /// The first point with a value in a column.
  std::string place(const std::vector<double>& column, double value) const {
    return points_->where(static_cast<std::size_t>(std::ranges::find(column, value) - column.begin()));
  }

  bool has_cross_slopes() const {
    return scene_.surface.has_cross_slopes() || (points_ && (*points_)[Axis::kSigmaCross]);
  }

  std::optional<double> coldest_K() const {
    const std::vector<double>& grid_K = scene_.grid[Axis::kTemperature];
    if (!grid_K.empty()) return std::ranges::min(grid_K);
    return scene_.emission ? std::optional(scene_.emission->temperature_K) : std::nullopt;
  }

  const char* source_key() const {
    for (const char* key : {"source.preset", "source.file", "source.relative_irradiance"})
      if (scene_.document->find(key)) return key;
    return "source.irradiance";
  }

  const char* surroundings_key() const {
    if (!scene_.names.profile.empty()) return "surroundings.profile";
    const Surroundings& sky = *scene_.surroundings;
    if (!sky.zenith_K) return "surroundings.temperature_K";
    return *sky.zenith_K < *sky.horizon_K ? "surroundings.zenith_temperature_K" : "surroundings.horizon_temperature_K";
  }

  void add_material(const std::string& key, const Material& used) {
    const Material& material = used.tabulated ? *used.tabulated : used;
    if (material.k.wavelength_um.empty() && !material.n.wavelength_um.empty())
      add(key, "the file has no k, so that k = 0");
    if (material.least_k < 0.0)
      add(key, fmt::format("k is down to {} in the file; below 0 it counts as 0", material.least_k));
    if (material.is_conjugate) add(key, "k is negative in the file, which gives N = n - ik; it is taken as positive");
    if (material.has_guessed_unit) add(key, "the file gives no unit of the wavelength; it is taken in um");
    if (const std::vector<double>& um = material.unknown_um; !um.empty()) {
      add(key, fmt::format("rows with NaN are left out: {} at {}", um.size(),
                           wavelength_text(std::ranges::min(um), std::ranges::max(um))));
    }
    const std::optional<Interval> gap = bridged_gap(material.n, used_um(scene_));
    add_gap(key, gap);
    if (const auto k_gap = bridged_gap(material.k, used_um(scene_)); k_gap != gap) add_gap(key, k_gap);
    if (!gap) add_coarse_rows(key, material);
  }

  void add_reflectances(const std::string& key) {
    const std::vector<std::shared_ptr<const MeasuredReflectance>>& measured = scene_.surface.reflectance->measured;
    if (std::ranges::none_of(measured, [](const auto& rows) { return difference_limit_deg(*rows).has_value(); }))
      return;
    add(key, fmt::format("no row between 0 and {} degrees: r_s - r_p, proportional to sin^2 there, is limited so that "
                         "both stay in [0, 1]",
                         measured.front()->beta_deg[1]));
  }

  void add_coarse_rows(const std::string& key, const Material& used, const std::string& name = "") {
    const CoarseRows rows = coarsest_rows(used.tabulated ? *used.tabulated : used, used_um(scene_));
    if (rows.change < kCoarseChange) return;
    add(key,
        name + fmt::format("the rows of n and k are coarse near {} um: straight lines between them change the smooth "
                           "surface's reflectance or absorptance by about {:.0f} %",
                           rows.at_um, 100.0 * rows.change));
  }

  void add_gap(const std::string& key, const std::optional<Interval>& gap) {
    if (gap)
      add(key, fmt::format("the file has no row between {} and {} um; a straight line bridges the gap", gap->first,
                           gap->second));
  }

  void add_hot_sky(const SkyProfile* profile) {
    const double surface_K = coldest_K().value_or(0.0);
    if (surface_K < kLikelyCelsius_K) return;  // no emission, or probably degrees Celsius
    bool is_hot = !profile && scene_.surroundings->temperature_K > kHotSky * surface_K;
    const std::vector<Interval> used = used_um(scene_);
    for (const double um : {used.front().first, used.back().second}) {
      for (const double zenith_deg : profile ? profile->ends_deg() : std::vector<double>{})
        is_hot |= sky_radiance(*profile, um, zenith_deg) > planck_radiance(um, kHotSky * surface_K);
    }
    if (!is_hot) return;
    const bool is_radiance = profile && profile->kind == SkyProfile::Kind::kRadiance;
    add(surroundings_key(), fmt::format("is hotter than twice the surface, {} K; {}", surface_K,
                                        is_radiance ? "radiance is in W m-2 sr-1 um-1, of which a microflick is 0.01"
                                                    : "are both in kelvins?"));
  }

  void add_sky_beyond_data(const SkyProfile* profile) {
    if (!profile || profile->kind != SkyProfile::Kind::kLayers) return;
    const auto is_beyond = [](const Interval& part) {
      return part.first < kSkyBandFrom_um || part.second > kSkyBandTo_um;
    };
    if (std::ranges::none_of(used_um(scene_), is_beyond)) return;
    add("surroundings.profile",
        fmt::format(
            "is known at {:g}-{:g} um; beyond, the air gets the mean emittance {:.2g} in the vertical, but real "
            "air is opaque near 6.3 and 15 um and clearer near 4 um",
            kSkyBandFrom_um, kSkyBandTo_um, profile->emissivity));
  }

  SceneValues scene_;
  const Points* points_ = nullptr;
  std::vector<std::string> lines_;
};

}  // namespace

std::string model_advice(const SceneModel& scene) {
  const Surface& surface = scene.surface;
  const bool is_direct = scene.emission && scene.emission->model == EmissionModel::kDirect;
  const bool has_bracket = scene.emission && scene.emission->has_bracket;
  const bool can_have_bracket =
      scene.emission && scene.emission->model != EmissionModel::kFresnel && scene.geometry.mode == Mode::kHemispherical;
  if (surface.is_bare()) {
    std::vector<std::string> keys;
    if (surface.masking != Masking::kVCavity) keys.emplace_back("surface.masking = \"v-cavity\"");
    keys.emplace_back("surface.scattering = \"multiple\"");
    if (is_direct) keys.emplace_back("emission.model = \"moments\"");
    if (has_bracket) keys.emplace_back("emission.bracket = false");
    return fmt::format("{} to follow all bounces", fmt::join(keys, ", "));
  }
  const std::string none = "no model follows all bounces of a coating or of measured reflectances";
  if (has_bracket) return none + "; dolp_low and dolp_high enclose the DOLP with all bounces";
  if (!can_have_bracket) return none;
  const bool has_masking = keeps_projected_area(surface.masking);
  return fmt::format("{}; emission.bracket = true{} gives limits of DOLP", none,
                     has_masking ? "" : " with surface.masking = \"smith\" or \"v-cavity\"");
}

std::vector<std::string> remarks_on(const SceneValues& scene) {
  Remarks remarks(scene);
  remarks.add_sorted_axes();
  remarks.add_wavelengths();
  remarks.add_temperatures();
  remarks.add_files();
  remarks.add_mode();
  remarks.add_angles_and_slopes();
  remarks.add_diffuse();
  return std::move(remarks).lines();
}

std::vector<std::string> remarks_on(const SceneValues& scene, const Points& points) {
  Remarks remarks(scene, points);
  remarks.add_wavelengths();
  remarks.add_temperatures();
  remarks.add_files();
  remarks.add_angles_and_slopes();
  remarks.add_films_of_points();
  std::vector<std::string> lines = std::move(remarks).lines();
  const std::vector<std::string> known = remarks_on(scene);
  std::erase_if(lines, [&](const std::string& line) { return std::ranges::find(known, line) != known.end(); });
  return lines;
}

}  // namespace dolp
