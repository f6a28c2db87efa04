#include "explore/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "explore/curve.hpp"
#include "explore/scene_edits.hpp"

namespace dolp::explore {
namespace {

constexpr double kSpecularAzimuth_deg = 180.0;  // azimuth from the source to the mirror direction

std::pair<double, double> known_um(const Scene& scene) {  // range of the wavelengths in material_curve()
  const auto spectrum = spectrum_um(scene);
  if (const auto known = built_in_material(scene)) return {known->from_um, known->to_um};
  return spectrum.first < spectrum.second ? spectrum : std::pair{0.8 * spectrum.first, 1.25 * spectrum.second};
}

}  // namespace

std::optional<Scene> with_other_distribution(const Scene& scene) {
  const double sigma = scene.number("surface.sigma").value();
  const double ratio = std::sqrt(scene.number("surface.q").value() - 1.0);
  const bool is_cauchy = scene.word("surface.distribution") == "cauchy";
  const double factor = is_cauchy ? 1.0 / ratio : ratio;
  if (has_wind(scene) && has_cross_slopes(scene)) return std::nullopt;
  try {
    std::vector<Setting> changes = {{"surface.distribution", is_cauchy ? "gaussian" : "cauchy"},
                                    {"surface.sigma", factor * sigma}};
    if (const auto cross = scene.number(kSigmaCross)) changes.push_back({kSigmaCross, factor * *cross});
    return scene.with(changes);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

double slope_density(const Scene& scene, double alpha_deg) {
  const double sigma = scene.number("surface.sigma").value();
  const double m2 = 2.0 * sigma * sigma;
  const double cosine = std::cos(alpha_deg * kDegree);
  const double slope2 = std::pow(std::tan(alpha_deg * kDegree), 2) / m2;
  const double scale = std::numbers::pi * m2 * std::pow(cosine, 4);
  if (scene.word("surface.distribution") == "gaussian") return std::exp(-slope2) / scale;
  const double q = scene.number("surface.q").value();
  return (q - 1.0) * std::pow(1.0 + slope2, -q) / scale;
}

std::pair<double, double> spectrum_um(const Scene& scene) {
  const std::vector<double> band = scene.numbers("spectrum.band_um");
  if (!band.empty()) return {band[0], band[1]};
  const double wavelength_um = scene.number("spectrum.wavelength_um").value();
  return {wavelength_um, wavelength_um};
}

MaterialCurve material_curve(const Scene& scene, std::size_t count) {
  const auto [from_um, to_um] = known_um(scene);
  MaterialCurve curve;
  for (const double at_um : Scale{from_um, to_um, true}.values(count)) {
    try {
      const auto [n, k] = scene.refractive_index(at_um);
      curve.wavelength_um.push_back(at_um);
      curve.n.push_back(n);
      curve.k.push_back(k);
    } catch (const InputError&) {
      // The file of the material has no n and k at this wavelength. So the curve leaves the wavelength out.
    }
  }
  return curve;
}

Scene at_one_wavelength(const Scene& scene) {
  const auto [from_um, to_um] = spectrum_um(scene);
  if (from_um == to_um) return scene;
  return scene.with({{"spectrum.band_um", Value()}, {"spectrum.wavelength_um", 0.5 * (from_um + to_um)}});
}

Scene smooth_scene(const Scene& scene) {
  return scene.with({{"surface.wind_m_s", Value()},
                     {"grid.wind_m_s", Value()},
                     {"surface.sigma_cross", Value()},
                     {"grid.sigma_cross", Value()},
                     {"geometry.surface_azimuth_deg", Value()},
                     {"grid.surface_azimuth_deg", Value()},
                     {"surface.sigma", 0.0},
                     {"surface.scattering", "single"},
                     {"surface.specular", 1.0},
                     {"surface.diffuse", 0.0},
                     {"geometry.mode", "hemispherical"}});
}

ScatteringCut scattering_cut(Evaluator& evaluator, const Scene& scene, double theta_i_deg, std::size_t count) {
  ScatteringCut cut;
  const auto [from_um, to_um] = spectrum_um(scene);
  cut.wavelength_um = 0.5 * (from_um + to_um);
  cut.theta_r_deg = Scale{-90.0, 90.0}.values(count);
  std::vector<double> zenith_deg, azimuth_deg;
  for (const double theta_r_deg : cut.theta_r_deg) {
    zenith_deg.push_back(std::abs(theta_r_deg));
    azimuth_deg.push_back(theta_r_deg < 0.0 ? 0.0 : kSpecularAzimuth_deg);
  }
  const std::array theta_i = {theta_i_deg};
  cut.matrices =
      evaluator.mueller(at_one_wavelength(scene),
                        {{"theta_i_deg", theta_i}, {"theta_r_deg", zenith_deg}, {"delta_phi_deg", azimuth_deg}});
  return cut;
}

std::optional<ImagePolarisation> polarisation_at(const std::vector<Point>& curve, double theta_deg,
                                                 double azimuth_deg) {
  const auto above = std::ranges::lower_bound(curve, theta_deg, {}, &Point::theta_deg);
  if (above == curve.end()) return std::nullopt;
  const auto below = above == curve.begin() ? above : std::prev(above);
  if (!above->is_good() || !below->is_good()) return std::nullopt;
  const double width = above->theta_deg - below->theta_deg;
  const double part = width > 0.0 ? (theta_deg - below->theta_deg) / width : 0.0;
  const double q_over_i = (1.0 - part) * below->values[Quantity::kQOverI] + part * above->values[Quantity::kQOverI];
  const double angle_deg = std::fmod(azimuth_deg + (q_over_i > 0.0 ? 90.0 : 0.0) + 360.0, 180.0);
  return ImagePolarisation{std::abs(q_over_i), angle_deg};
}

}  // namespace dolp::explore
