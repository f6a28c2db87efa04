// A validated scene: the values of the TOML file, in its units (degrees, micrometres, kelvins).
#pragma once

#include <cstddef>
#include <dolp/setting.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "model/choices.hpp"
#include "model/facet_optics.hpp"
#include "model/scattering.hpp"
#include "model/scene_entry.hpp"
#include "scene/sky_profile.hpp"

namespace dolp {

inline constexpr int kDispersionFormulas = 9;

/// A refractive index n as a function of wavelength: one of nine formulas, with the coefficients C1, C2, …
/// Source: M. Polyanskiy, "Dispersion formulas", in the refractiveindex.info database, which numbers the formulas.
/// Accuracy: reproduces published indices to their last digit (test Dispersion_Formulas_*).
struct Dispersion {
  int number = 0;                    ///< number of the formula, 1 to kDispersionFormulas; 0 means no formula
  std::vector<double> coefficients;  ///< C1, C2, …; coefficient_counts() says how many are allowed

  double at(double wavelength_um) const;  ///< n; NaN if the formula gives a negative n^2
};

/// The numbers of coefficients that a formula may have. Coefficients missing at the end are zero.
std::vector<std::size_t> coefficient_counts(int number);

/// A quantity over strictly ascending wavelengths, interpolated between them or given by a `formula`.
struct SpectralTable {
  enum class Interpolation { kLinear, kLogLog };
  std::vector<double> wavelength_um;
  std::vector<double> value;
  Interpolation interpolation = Interpolation::kLinear;
  Dispersion formula = {};
  double at(double wavelength_um) const;
};

/// A refractive index n + ik. If the table `n` is empty, the index is `constant` at every wavelength.
struct Material {
  std::string name;    ///< empty if the scene gives n and k as numbers
  std::string source;  ///< where the values come from; empty if the scene gives n and k as numbers
  std::string kind;    ///< kind of a built-in material: "metal", "polymer", ...
  OpticalConstants constant;
  SpectralTable n, k;
  std::shared_ptr<const Material> tabulated = {};  ///< the whole table, if `constant` was taken from it; else null
  double least_k = 0.0;                 ///< smallest k in the file, if it is negative; the tables have 0 instead
  bool is_conjugate = false;            ///< the file gives n - ik with a negative k; the tables have the positive one
  bool has_guessed_unit = false;        ///< the file gives no unit of the wavelength; um was assumed
  std::vector<double> unknown_um = {};  ///< wavelengths of the rows of the file that have NaN; the tables omit them
  bool is_constant() const { return n.wavelength_um.empty(); }
  OpticalConstants at(double wavelength_um) const;
};

struct Layer {
  Material material;
  double thickness_um = 0.0;
  double thickness_spread_um = 0.0;  ///< standard deviation of the thickness over the surface
};

/// Reflectances at ascending wavelengths. If `measured` has only one element, it holds for every wavelength.
struct ReflectanceTable {
  std::vector<double> wavelength_um;
  std::vector<std::shared_ptr<const MeasuredReflectance>> measured;
  std::shared_ptr<const MeasuredReflectance> at(double wavelength_um) const;  ///< interpolated linearly in wavelength
};

struct Surface {
  Material material;
  std::vector<Layer> coating;                                     ///< films from the outside in
  std::shared_ptr<const ReflectanceTable> reflectance = nullptr;  ///< replaces material and coating
  Distribution distribution = Distribution::kCauchy;
  Masking masking = Masking::kIntegral;
  Scattering scattering = Scattering::kSingle;  ///< kMultiple only with v-cavity
  double sigma = 0.0;
  std::optional<double> wind_m_s = {};  ///< wind from which sigma follows; nullopt if the scene gives sigma
  WindModel wind_model = WindModel::kIsotropic;
  double sigma_cross = 0.0;  ///< SlopeShape::sigma_cross
  double q = 2.0;
  double specular = 1.0;  ///< k_s in [0, 1]
  double diffuse = 0.0;   ///< k_d in [0, 1]; the largest k_d of the spectrum if there is a diffuse_table
  std::shared_ptr<const SpectralTable> diffuse_table = nullptr;  ///< k_d over wavelength; null if it is a number
  double diffuse_exponent = -0.5;                                ///< c in (-1, 0]
  DiffusePolarisation diffuse_polarisation = DiffusePolarisation::kNone;
  /// True if q must be in kSmithCauchyQRange, because smith masking needs a finite mean slope.
  bool needs_mean_slope() const { return masking == Masking::kSmith && distribution == Distribution::kCauchy; }
  /// True if slopes may differ along and across.
  bool has_cross_slopes() const { return wind_model == WindModel::kDirectional || sigma_cross > 0.0; }
  /// True if only the direct emission is computed, see MomentsRequest::has_only_direct().
  bool has_only_direct() const { return masking == Masking::kSmith && has_cross_slopes(); }
  bool is_bare() const { return coating.empty() && !reflectance; }
  bool has_constant_optics() const;
  FacetOptics optics_at(double wavelength_um) const;
  /// Wavelengths at which the optics may have kinks: the rows of the tables of n, k and reflectances.
  std::vector<double> optics_rows_um() const;
};

struct Emission {
  double temperature_K = 0.0;
  EmissionModel model = EmissionModel::kMoments;
  bool has_bracket = false;  ///< adds dolp_low and dolp_high to results: DOLP with all bounces lies between them
};

/// Irradiance E0 of the source at normal incidence. A scene gives it in one of three ways.
struct Source {
  double irradiance = 0.0;                    ///< W m-2 um-1, constant over a band
  std::optional<double> relative_irradiance;  ///< E0 / (pi B(T)) at each wavelength, T = emission.temperature_K
  std::shared_ptr<const SpectralTable> table = nullptr;  ///< W m-2 um-1; null if E0 is a number
  double scale = 1.0;                                    ///< E0 is multiplied by this
};

struct Surroundings {
  double temperature_K = 0.0;                           ///< used if there is no profile
  std::optional<double> zenith_K, horizon_K;            ///< ends of a profile that is a straight line
  SkyAir air = {};                                      ///< air of a built-in sky
  std::shared_ptr<const SkyProfile> profile = nullptr;  ///< null for a uniform sky
  void set_sky(SkyProfile sky);
};

/// Path to the sensor. It has the transmittance tau and the radiance L. A radiance I becomes tau I + L; an exitance I
/// becomes tau I + pi L. Q, U and V are multiplied by tau.
struct Path {
  double transmittance = 1.0;
  std::optional<double> temperature_K;  ///< temperature from which L = (1 - tau) B(T) follows
  std::optional<double> radiance;       ///< L in W m-2 sr-1 um-1, instead of a temperature
};

/// A single wavelength, a band, or the wavelengths at which the response of a camera is not 0.
struct Spectrum {
  double min_um = 0.0;
  double max_um = 0.0;                                      ///< equal to min_um for a single wavelength
  std::shared_ptr<const SpectralTable> response = nullptr;  ///< null: 1 in the whole band
  ResponsePer response_per = ResponsePer::kPower;
  double photon_um = 0.0;  ///< lambda_0 of a response per photon, the wavelength of its largest row; else 0
  bool is_band() const { return max_um > min_um; }
  /// The weight of the radiance at a wavelength of the band.
  /// Equation: R(lambda), or R(lambda) lambda / lambda_0 for a response per photon.
  double weight(double wavelength_um) const;
  const char* key() const;  ///< the key of a band in the scene
  std::string label() const { return format_number(min_um) + '-' + format_number(max_um); }  ///< such as "8-14"
};

struct Geometry {
  Mode mode = Mode::kHemispherical;
  double view_zenith_deg = 60.0;        ///< zenith of the view; only for bistatic mode
  double relative_azimuth_deg = 180.0;  ///< only for bistatic mode; 180 is the specular side
  double surface_azimuth_deg = 0.0;     ///< SlopeShape::azimuth_deg
};

struct Accuracy {
  double tolerance = 1e-4;
  Precision precision = Precision::kAuto;
  bool may_interpolate = true;  ///< if false, the program integrates every entry and interpolates none
};

/// Name and path of a material as a scene gives them. Loading a built-in material makes `material` the full name.
struct MaterialNames {
  std::string material, material_file;
  friend bool operator==(const MaterialNames&, const MaterialNames&) = default;
};

/// Names and paths as a scene gives them; empty if absent.
struct SceneNames : MaterialNames {
  std::string reflectance_file, diffuse_file;
  std::vector<MaterialNames> coating;
  std::string source_preset, source_file;
  std::string profile;  ///< name of a built-in sky, or path of a file
  std::string response_file;
};

class SceneDocument;
struct KnownData;

/// The part of a scene that determines the physics. SceneValues adds the values on the grid's axes, names and texts.
struct SceneModel {
  Surface surface;
  std::optional<Emission> emission;
  std::optional<Source> source;
  std::optional<Surroundings> surroundings;
  std::optional<Path> path;
  Spectrum spectrum;
  Geometry geometry;
  Accuracy accuracy;
  std::shared_ptr<const std::vector<Material>> materials = {};  ///< materials on the grid's axis of materials
  std::vector<Spectrum> bands = {};                             ///< bands on the grid's axis of bands
  CrossSlopes cross_slopes() const { return {surface.sigma_cross, geometry.surface_azimuth_deg, surface.wind_model}; }
};

struct SceneValues : SceneModel {
  std::string title;
  SceneNames names;
  Axes grid;                       ///< values in the user's order; [surface] gives sigma or q if [grid] does not
  AxisLabels labels;               ///< names of the materials and bands on the grid's axes
  std::vector<double> wind_m_s;    ///< winds from which the grid's sigmas follow; empty if the scene gives sigmas
  std::string path_name;           ///< path of the scene as the user gave it, for messages
  std::string text;                ///< text of the scene file, unchanged
  std::vector<std::string> files;  ///< paths by which the program opens the files that the scene names
  std::vector<Setting> settings;   ///< settings that were applied to the text
  std::shared_ptr<const SceneDocument> document;  ///< text and settings as TOML; null without a text
  std::shared_ptr<KnownData> known;  ///< data of the table from which the scene comes; null for other scenes
};

/// The scene at one wavelength instead of its spectrum. Errors: InputError if n, k or E0 are not known there.
SceneModel at_wavelength(const SceneModel& scene, double wavelength_um);

/// The beams of an entry in bistatic mode.
BeamAngles beam_angles(const SceneModel& scene, const SceneEntry& entry);

/// The zenith for which the moments of an entry are computed: in bistatic mode the view, otherwise theta of the entry.
double moment_zenith_deg(const SceneModel& scene, const SceneEntry& entry);

void set_films(Surface& surface, const std::vector<FilmValue>& films);

/// The scene with the values of `variant`. Domain: `scene` has the films of `variant`. Errors: errors of at_wavelength.
SceneModel with_variant(const SceneModel& scene, const SceneVariant& variant);

/// Wavelengths in um at which a scene of one wavelength may have kinks, ascending: the rows of the tables of optics,
/// source, diffuse part and sky.
std::vector<double> kinks_um(const SceneModel& scene);

}  // namespace dolp
