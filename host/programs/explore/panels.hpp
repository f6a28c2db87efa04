#pragma once

#include <numbers>

#include "explore/background.hpp"

namespace dolp::explore {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< in radians

/// A view beside the curve, computed only while it is shown. kPanelNames has the names of the views in the same order.
enum class Panel : std::uint8_t {
  kMap,
  kSlopes,
  kMaterial,
  kSmooth,
  kSpectrum,
  kScattering,
  kShapes,
  kSky,
  kCamera,
  kAzimuth,
  kFit
};

inline constexpr std::array kPanelNames = {"map",    "slopes", "material", "smooth",  "spectrum", "pBRDF",
                                           "sphere", "sky",    "camera",   "azimuth", "fit"};

/// Name of the axis (MapAxis::name) over which a view shows the quantity of the curve; "" for other views.
constexpr const char* swept_name(Panel panel) {
  if (panel == Panel::kSpectrum) return "wavelength";
  if (panel == Panel::kCamera) return "view zenith";
  return panel == Panel::kAzimuth ? "surface azimuth" : "";
}

/// The scene with a Gaussian slope distribution instead of a Cauchy one, or the reverse, with the same density D(0) of
/// horizontal facets: sigma_gaussian = sigma_cauchy / sqrt(q - 1). Empty if the model forbids the new sigma or q, and
/// for a directional wind, which is Gaussian.
std::optional<Scene> with_other_distribution(const Scene& scene);

/// The slope distribution D in 1/sr, at the angle alpha between the normals of a facet and of the mean plane. Equations
/// (8) for cauchy and (1) for gaussian of the paper that `dolp --cite` names.
double slope_density(const Scene& scene, double alpha_deg);

struct MaterialCurve {
  std::vector<double> wavelength_um, n, k;
};

/// n and k of the surface over wavelength. A built-in material has all its known wavelengths. Any other material has
/// the scene's band, or the range from 20 % below to 25 % above the scene's wavelength.
MaterialCurve material_curve(const Scene& scene, std::size_t count);

std::pair<double, double> spectrum_um(const Scene& scene);  ///< ends of the band; equal for a single wavelength
Scene at_one_wavelength(const Scene& scene);                ///< replaces a band by the wavelength in its middle

/// The scene with a smooth surface, so that its rho_s and rho_p are the reflectances R_s and R_p of a facet.
Scene smooth_scene(const Scene& scene);

/// The Mueller pBRDF for directions of reflection in the plane of incidence.
struct ScatteringCut {
  std::vector<double> theta_r_deg;  ///< from -90 to 90; positive on the side of the mirror direction
  std::vector<MuellerMatrix> matrices;
  double wavelength_um = 0.0;  ///< wavelength of the scene, or the middle of its band
};

ScatteringCut scattering_cut(Evaluator& evaluator, const Scene& scene, double theta_i_deg, std::size_t count);

struct ImagePolarisation {
  double dolp = 0.0;
  double angle_deg = 0.0;  ///< from the image's horizontal to the electric field, counterclockwise, 0 to 180
};

/// The polarisation of a surface element in a camera's image. The normal of the element is tilted by `theta_deg` from
/// the direction to the camera, towards `azimuth_deg` in the image. Interpolates between two points of `curve`; empty
/// if one of them is missing or not good. The electric field is along `azimuth_deg` if Q < 0 (p), else perpendicular.
std::optional<ImagePolarisation> polarisation_at(const std::vector<Point>& curve, double theta_deg, double azimuth_deg);

}  // namespace dolp::explore
