// Values of the views beside the map: slope distributions, a material over wavelength, the pBRDF in the plane of
// incidence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <dolp/dolp.hpp>
#include <optional>
#include <string>
#include <vector>

#include "explore/background.hpp"

namespace dolp::explore {

/// A view beside the curve; it is computed while it is shown.
enum class Panel : std::uint8_t { kMap, kSlopes, kMaterial, kScattering, kShapes, kSky, kFit };

struct PanelDescription {
  Panel panel;
  const char* name;
};
inline constexpr std::array<PanelDescription, 7> kPanels = {{{Panel::kMap, "map"},
                                                             {Panel::kSlopes, "slopes"},
                                                             {Panel::kMaterial, "material"},
                                                             {Panel::kScattering, "pBRDF"},
                                                             {Panel::kShapes, "sphere"},
                                                             {Panel::kSky, "sky"},
                                                             {Panel::kFit, "fit"}}};

/// Errors: InputError that names those there are.
Panel panel_of(const std::string& name);

/// The other distribution with the same density of flat facets, sigma_G = sigma / sqrt(q - 1), as changes of a scene.
std::vector<Setting> other_distribution(const Scene& scene);

/// The slope distribution D at an angle alpha of facets from the mean plane.
/// Equation: (8) cauchy, (1) gaussian. Units: 1/sr. Accuracy: ExplorePanels.SlopeDensity_IsNormalised.
double slope_density(const Scene& scene, double alpha_deg);

/// n and k over wavelengths.
struct MaterialCurve {
  std::vector<double> wavelength_um, n, k;
};

/// From the first to the last wavelength at which a built-in material is known; else over the scene's own spectrum and
/// as much beside it.
MaterialCurve material_curve(const Scene& scene, std::size_t count);

/// The ends of the scene's spectrum, equal for a single wavelength.
std::pair<double, double> spectrum_um(const Scene& scene);

/// The Mueller pBRDF in the plane of incidence.
struct ScatteringCut {
  std::vector<double> theta_r_deg;  ///< from -90 to 90; positive: beyond the normal, where a mirror reflects to
  std::vector<MuellerMatrix> matrices;
  double wavelength_um = 0.0;  ///< the middle of a band
};

/// `count` directions of reflection for one of incidence. Errors: InputError where the scene has no pBRDF there; those
/// of Evaluator.
ScatteringCut scattering_cut(Evaluator& evaluator, const Scene& scene, double theta_i_deg, std::size_t count);

/// The polarisation that a camera sees of a facet of the mean surface.
struct Seen {
  double dolp = 0.0;
  double angle_deg = 0.0;  ///< of the electric field in the image, from its horizontal, counterclockwise, 0 to 180
};

/// That of a surface at `theta_deg` whose normal points to `azimuth_deg` of the image, between the points of a curve in
/// hemispherical mode; none where the model fails.
/// Conventions: s polarised (Q > 0) is normal to the plane of normal and view, which the image shows as a line along
/// the azimuth; p lies in it.
std::optional<Seen> seen_at(const std::vector<Point>& curve, double theta_deg, double azimuth_deg);

/// DOLP of a bistatic scene with the source all around the sky: rings of zeniths at each azimuth.
class Sky {
 public:
  static constexpr std::size_t kZeniths = 31;   ///< 0 to 90 degrees
  static constexpr std::size_t kAzimuths = 37;  ///< 0 to 180 degrees; the other half mirrors it

  /// Switches to the sky of `scene`; `key` identifies its content without the azimuth.
  void follow(const std::string& key, const Scene& scene);
  /// A job for each azimuth that is still to be computed; coarse.
  std::vector<Job> wanted() const;
  bool take(const JobPart& news);
  /// The points at an azimuth, zenith by zenith; empty while they are unknown.
  const std::vector<Point>& at(std::size_t azimuth) const { return rings_[azimuth]; }
  static double azimuth_deg(std::size_t azimuth) { return 180.0 * static_cast<double>(azimuth) / (kAzimuths - 1); }
  /// True where what is shown belongs to an earlier scene in part.
  bool is_finished() const;

 private:
  std::string key_of(std::size_t azimuth) const;

  std::string key_;
  std::optional<Scene> scene_;
  std::array<std::vector<Point>, kAzimuths> rings_;
  std::array<std::string, kAzimuths> known_;  ///< keys of the jobs whose results are here
};

}  // namespace dolp::explore
