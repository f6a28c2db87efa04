// A validated scene: the contents of the TOML file in its units, degrees, micrometres and kelvins.
#pragma once

#include <dolp/setting.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/scene_entry.hpp"
#include "scene/dispersion.hpp"
#include "scene/sky_profile.hpp"

namespace dolp {

/// A quantity tabulated over wavelength (strictly ascending), with its interpolation; where there is a formula,
/// it applies between the first wavelength and the last.
/// Outside the table the scene reader refuses the scene, so `at` is only called inside.
struct SpectralTable {
  enum class Interpolation { kLinear, kLogLog };
  std::vector<double> wavelength_um;
  std::vector<double> value;
  Interpolation interpolation = Interpolation::kLinear;
  Dispersion formula = {};
  double at(double wavelength_um) const;
};

/// n + ik over wavelength. A constant index has `n.wavelength_um` empty and is `constant` everywhere.
struct Material {
  std::string name;    ///< empty for n, k given in the scene
  std::string source;  ///< where the values come from; empty for n, k given in the scene
  OpticalConstants constant;
  SpectralTable n, k;
  /// For a constant from a table: the whole table.
  std::shared_ptr<const Material> tabulated = {};
  double least_k = 0.0;  ///< least k in the file; noise below 0 counts as 0
  bool is_constant() const { return n.wavelength_um.empty(); }
  OpticalConstants at(double wavelength_um) const;
};

/// A film of a coating.
struct Layer {
  Material material;
  double thickness_um = 0.0;
};

/// Reflectances of a smooth surface at ascending wavelengths; a single one is for all wavelengths.
struct ReflectanceTable {
  std::vector<double> wavelength_um;
  std::vector<std::shared_ptr<const MeasuredReflectance>> measured;
  /// Straight lines between wavelengths.
  std::shared_ptr<const MeasuredReflectance> at(double wavelength_um) const;
};

struct Surface {
  Material material;
  std::vector<Layer> coating;                                     ///< from the outside in
  std::shared_ptr<const ReflectanceTable> reflectance = nullptr;  ///< instead of material and coating
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple: with v-cavity
  double sigma = 0.0;
  std::optional<double> wind_m_s = {};  ///< wind that gives sigma; none if the scene has sigma
  double q = 2.0;
  double specular = 1.0;           ///< k_s in [0, 1]
  double diffuse = 0.0;            ///< k_d in [0, 1]
  double diffuse_exponent = -0.5;  ///< c in (-1, 0]
  DiffusePolarisation diffuse_polarisation = DiffusePolarisation::kNone;
  /// True if the masking needs the mean slope, which the distribution does not always have: kSmithCauchyQRange.
  bool needs_mean_slope() const { return masking == Masking::kSmith && distribution == Distribution::kCauchy; }
  bool is_bare() const { return coating.empty() && !reflectance; }
  /// True if the reflectances of facets do not depend on the wavelength.
  bool has_constant_optics() const;
  FacetOptics optics_at(double wavelength_um) const;
  /// Wavelengths at which the optics bend: the rows of tables.
  std::vector<double> optics_rows_um() const;
};

struct Emission {
  double temperature_K = 0.0;
  EmissionModel model = EmissionModel::kMoments;
  bool has_bracket = false;  ///< dolp_low and dolp_high too
};

/// Irradiance at normal incidence; exactly one of the three kinds.
struct Source {
  enum class Kind { kFlat, kRelative, kTabulated };
  Kind kind = Kind::kFlat;
  double irradiance = 0.0;           ///< W m-2 um-1, flat over a band (kFlat)
  double relative_irradiance = 0.0;  ///< E0 / (pi B(T)) at each wavelength, T of the emission (kRelative)
  SpectralTable table;               ///< W m-2 um-1 (kTabulated)
  double scale = 1.0;                ///< multiplies all three
};

struct Surroundings {
  double temperature_K = 0.0;                           ///< if there is no profile
  SkyAir air = {};                                      ///< air of a built-in profile
  std::shared_ptr<const SkyProfile> profile = nullptr;  ///< null for a uniform sky
};

/// Path to the sensor: I -> tau I + L (times pi in hemispherical mode); Q, U, V -> tau Q, U, V.
struct Path {
  double transmittance = 1.0;
  std::optional<double> temperature_K;  ///< path radiance (1 - tau) B(T)
  std::optional<double> radiance;       ///< W m-2 sr-1 um-1, instead of a temperature
};

struct Spectrum {
  double min_um = 0.0;
  double max_um = 0.0;  ///< equal to min_um for a single wavelength
  bool is_band() const { return max_um > min_um; }
};

struct Geometry {
  Mode mode = Mode::kHemispherical;
  double view_zenith_deg = 60.0;        ///< bistatic only
  double relative_azimuth_deg = 180.0;  ///< bistatic only; 180 is the specular side
};

struct Accuracy {
  double tolerance = 1e-4;
  Precision precision = Precision::kAuto;
  bool may_interpolate = true;  ///< between slope distributions, where the grid is dense
};

/// Names in a scene; empty where the scene gives no name. The name of the material is in full.
struct SceneNames {
  struct OfLayer {
    std::string material, material_file;
  };
  std::string material, material_file, reflectance_file;
  std::vector<OfLayer> coating;
  std::string source_preset, source_file;
  std::string profile;  ///< built-in, or a file
};

class SceneDocument;

/// What the model reads: a scene without its grid, names and texts.
struct SceneModel {
  Surface surface;
  std::optional<Emission> emission;
  std::optional<Source> source;
  std::optional<Surroundings> surroundings;
  std::optional<Path> path;
  Spectrum spectrum;
  Geometry geometry;
  Accuracy accuracy;
  std::shared_ptr<const std::vector<Material>> materials = {};  ///< on the grid's axis of materials
  std::vector<Spectrum> bands = {};                             ///< on the grid's axis of bands
};

struct SceneValues : SceneModel {
  std::string title;
  SceneNames names;
  Axes grid;                       ///< in the user's order; sigma and q fall back to [surface]
  AxisLabels labels;               ///< labels of the grid's materials and bands
  std::vector<double> wind_m_s;    ///< winds that give the grid's values of sigma; empty if the scene has sigma
  std::string path_name;           ///< as given on the command line, for messages
  std::string text;                ///< the file, verbatim
  std::vector<std::string> files;  ///< files that the scene names, as the process finds them
  std::vector<Setting> settings;   ///< settings that were applied to the text
  std::shared_ptr<const SceneDocument> document;  ///< text and settings as TOML; null for a scene that was not read
};

/// The scene at one wavelength. Errors: InputError, where n, k or E0 are not known there.
SceneModel at_wavelength(const SceneModel& scene, double wavelength_um);

/// Gives the films of a surface other numbers.
void set_films(Surface& surface, const std::vector<FilmValue>& films);

/// The scene as a variant changes it. Domain: films that the scene has. Errors: errors of at_wavelength.
SceneModel with_variant(const SceneModel& scene, const SceneVariant& variant);

}  // namespace dolp
