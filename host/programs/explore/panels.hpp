#pragma once

#include <algorithm>
#include <numbers>

#include "explore/background.hpp"

namespace dolp::explore {

inline constexpr double kDegree = std::numbers::pi / 180.0;  ///< in radians

/// A view beside the curve. It is computed only while it is shown.
enum class Panel : std::uint8_t { kMap, kSlopes, kMaterial, kSmooth, kSpectrum, kScattering, kShapes, kSky, kFit };

/// The names in the order of Panel.
inline constexpr std::array kPanelNames = {"map",   "slopes", "material", "smooth", "spectrum",
                                           "pBRDF", "sphere", "sky",      "fit"};

Panel panel_of(const std::string& name);  ///< Errors: InputError that lists the names

/// The scene with a Gaussian slope distribution instead of a Cauchy one, or the reverse. The density D(0) stays equal:
/// sigma of the Gaussian is sigma / sqrt(q - 1) of the Cauchy one. Empty if the new sigma or q is outside the model.
std::optional<Scene> with_other_distribution(const Scene& scene);

/// The slope distribution D at an angle alpha between the normals of facet and mean plane. Equation: (8) cauchy and (1)
/// gaussian in the paper that `dolp --cite` names. Units: 1/sr. Accuracy: ExplorePanels.SlopeDensity_IsNormalised.
double slope_density(const Scene& scene, double alpha_deg);

struct MaterialCurve {
  std::vector<double> wavelength_um, n, k;
};

/// n and k of the surface over wavelength. For a built-in material the curve has all known wavelengths. For another
/// material it has the scene's band, or wavelengths from 20 % below to 25 % above the scene's single wavelength.
MaterialCurve material_curve(const Scene& scene, std::size_t count);

std::pair<double, double> spectrum_um(const Scene& scene);  ///< ends of the band; equal for a single wavelength
Scene at_one_wavelength(const Scene& scene);                ///< replaces a band by the wavelength in its middle

/// The scene with a smooth surface, so that its rho_s and rho_p are the reflectances R_s and R_p of a facet.
Scene smooth_scene(const Scene& scene);

/// The Mueller pBRDF for directions of reflection in the plane of incidence.
struct ScatteringCut {
  std::vector<double> theta_r_deg;  ///< from -90 to 90; a mirror reflects to the positive side
  std::vector<MuellerMatrix> matrices;
  double wavelength_um = 0.0;  ///< wavelength of the scene, or the middle of its band
};

/// Light comes from the zenith `theta_i_deg`. Errors: the errors of Evaluator::mueller; InputError without a pBRDF.
ScatteringCut scattering_cut(Evaluator& evaluator, const Scene& scene, double theta_i_deg, std::size_t count);

struct ImagePolarisation {
  double dolp = 0.0;
  double angle_deg = 0.0;  ///< direction of the electric field from the image's horizontal, counterclockwise, 0 to 180
};

/// The polarisation of a surface element in a camera's image. Its normal is tilted by `theta_deg` from the direction to
/// the camera, towards `azimuth_deg` in the image. Interpolates in a hemispherical curve between the two points beside
/// `theta_deg`. Empty if one of these points is not good. Conventions: s polarisation (Q > 0) is perpendicular to the
/// plane of normal and view; p lies in the plane. In the image this plane is a line along the azimuth.
std::optional<ImagePolarisation> polarisation_at(const std::vector<Point>& curve, double theta_deg, double azimuth_deg);

/// DOLP of a bistatic scene for all directions of the source. For each azimuth there is a curve over the zenith.
class SourceSky {
 public:
  static constexpr std::size_t kZeniths = 31;   ///< 0 to 90 degrees
  static constexpr std::size_t kAzimuths = 37;  ///< 0 to 180 degrees; the other half of the sky is the mirror image

  void follow(const std::string& key, const Scene& scene);  ///< `key`: content_key() without the azimuth
  std::vector<Job> wanted() const {                         // one job for each azimuth that is not computed yet
    std::vector<Job> jobs;
    for (const Sweep& ring : rings_) {
      if (const std::optional<Job> job = ring.wanted()) jobs.push_back(*job);
    }
    return jobs;
  }
  void take(const JobPart& news) {
    std::ranges::any_of(rings_, [&](Sweep& ring) { return ring.take(news); });
  }
  /// The points at an azimuth, ordered by zenith; empty until they are computed.
  const std::vector<Point>& at(std::size_t azimuth) const { return rings_[azimuth].points(); }
  static double azimuth_deg(std::size_t azimuth) { return 180.0 * static_cast<double>(azimuth) / (kAzimuths - 1); }
  bool is_finished() const { return std::ranges::all_of(rings_, &Sweep::is_finished); }

 private:
  std::array<Sweep, kAzimuths> rings_;
};

}  // namespace dolp::explore
