// dolp: infrared degree of linear polarisation (DOLP) of rough surfaces. This header is all of the library's interface.
//
//   #include <dolp/dolp.hpp>
//
//   const dolp::Scene scene = dolp::Scene::from_file("scene.toml", {{"surface.masking", "smith"}});
//   dolp::Evaluator evaluator;                                     // keeps the device and its kernels
//   const std::vector<double> theta_deg = {0, 30, 60};
//   const dolp::Results results = evaluator.evaluate(scene, {{"theta_deg", theta_deg}});
//   std::cout << results[dolp::Quantity::kDolp][2] << '\n';
//   evaluator.write_table(scene, "table.nc");                      // over the scene's [grid]
//
// CMake: find_package(dolp CONFIG REQUIRED), target_link_libraries(program PRIVATE dolp::dolp). C++20.
//
// Units and names are as on the command line and in files: angles in degrees, wavelengths in um, temperatures in K.
// On the same device the library and the command line compute the same numbers, bit for bit.
//
// Errors: exceptions derived from std::exception. A call that throws changes nothing and leaves no file. Only
// write_table leaves the parts of its table that are finished.
// Threads: each thread may use separate objects. Several threads may also share an Evaluator or a Table; their calls
// then wait for each other. A callback (`progress`, `phase` or `take`) must not call the Evaluator that called it; such
// a call throws InputError.
// Moves: a Scene or a Table keeps its contents after a move. An Evaluator that was moved from throws InputError until
// you assign another one to it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <dolp/axis.hpp>
#include <dolp/device.hpp>
#include <dolp/effect.hpp>
#include <dolp/errors.hpp>
#include <dolp/fit.hpp>
#include <dolp/key.hpp>
#include <dolp/options.hpp>
#include <dolp/results.hpp>
#include <dolp/setting.hpp>
#include <dolp/status.hpp>
#include <dolp/table_values.hpp>

namespace dolp {

DOLP_EXPORT std::string version();
/// The git commit from which the library was built; "unknown" if it was built outside a repository.
DOLP_EXPORT std::string commit();
/// How to cite the program and the model, in the Citation File Format.
DOLP_EXPORT std::string citation();

/// The report that a call returns: what the call did, its results, and any problems.
struct Report {
  std::string text;              ///< report as readable lines
  std::string json;              ///< all values as JSON, as the option --json of the program prints them
  bool is_good = true;           ///< false if a result misses its tolerance, a check fails or a fit finds no minimum
  std::filesystem::path output;  ///< the file that the call wrote; empty if it wrote none
  /// The lines of `text` with a label, such as "entries    5 x 1 x 1". A pair has the label and the rest of the line.
  std::vector<std::pair<std::string, std::string>> rows = {};
  std::vector<std::string> remarks = {};  ///< one line for each suspicious input, such as nm instead of um
};

/// A validated scene: surface, radiation, geometry, grid and accuracy. Copies of a Scene share its data.
class DOLP_EXPORT Scene {
 public:
  /// Reads a scene file (TOML; "-" is stdin), or the scene that a table (.nc) stores, with the n, k and other data that
  /// the table was computed with. Applies the settings in their order.
  /// Errors: InputError with file, line, key, value and allowed range.
  static Scene from_file(const std::filesystem::path& path, const std::vector<Setting>& settings = {});
  /// Reads a scene from text, as if from a file with the path `name`: paths in the text are relative to its folder.
  static Scene from_text(const std::string& text, const std::vector<Setting>& settings = {},
                         const std::string& name = "scene");
  /// A copy in which a key has another value, for example with("surface.sigma", 0.2). Errors: InputError.
  Scene with(const std::string& key, const Value& value) const { return with({{key, value}}); }
  Scene with(const std::vector<Setting>& settings) const;
  /// A copy with other axes in [grid]: with_grid({{"theta_deg", AxisRange{0, 60, 7}}, {"sigma", {0.1, 0.2}}}).
  Scene with_grid(const std::vector<Setting>& axes) const;
  /// The scene of a table from the attributes of the table, such as Table::file_attributes(). `name`: see from_text().
  static Scene from_attributes(const std::vector<Attribute>& attributes, const std::string& name = "table");
  /// A copy in which keys such as surface.sigma have the value of an axis in [grid], where the axis has only one value.
  /// So points without a column for this axis get the value.
  Scene for_points() const;
  /// A copy with these settings instead of all present settings.
  Scene with_all(const std::vector<Setting>& settings) const;
  /// A copy of the scene without a key, or without a whole TOML table such as "surroundings".
  Scene without(const std::string& key) const { return with(key, Value()); }

  const std::string& title() const;
  const std::string& name() const;  ///< the path of the scene file, or the argument `name` of from_text()
  const std::string& text() const;  ///< the text of the scene as it was read, without the settings
  const std::vector<Setting>& settings() const;
  /// The attributes of the table from which the scene comes. Empty for other scenes.
  const std::vector<Attribute>& table_attributes() const;
  std::string evaluator() const;  ///< name of the evaluator that computed this table; "vulkan" for other scenes
  /// The scene with its settings applied, as TOML. The names of files in it are relative to `folder`.
  std::string toml(const std::filesystem::path& folder = ".") const;

  /// The given or default value of a key, in the unit of the key. Empty if the scene does not use the key: a surface
  /// with a material does not use surface.n. Errors: InputError if the key is unknown or its value is not a number.
  std::optional<double> number(std::string_view key) const;
  /// A key's word or text; "true" or "false" for a flag. Empty if the text is empty or the scene does not use the key.
  std::optional<std::string> word(std::string_view key) const;
  /// The numbers of a key that has an axis, a pair of numbers or a list of pairs. Empty if the scene lacks the key. A
  /// scene with a response of the camera has spectrum.band_um, the wavelengths between which the response is not 0.
  std::vector<double> numbers(std::string_view key) const;
  /// The materials and bands in [grid]. In points, the columns material and band_um contain positions in these lists.
  const AxisLabels& labels() const;
  /// One line for each suspicious value (nm instead of um) and for each assumption (k = 0, if a file lacks k).
  std::vector<std::string> remarks() const;
  std::string model_advice() const;  ///< the keys to change if entries have the status bit kModelInaccurate
  /// n and k of the surface at a wavelength. Errors: InputError if n or k is unknown at this wavelength.
  std::pair<double, double> refractive_index(double wavelength_um) const;
  /// The weight of the radiance at a wavelength: the response of the camera, 1 in a band without one, and 0 outside.
  double response(double wavelength_um) const;

  Scene(const Scene&) = default;
  Scene& operator=(const Scene&) = default;
  ~Scene() = default;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

/// Settings that prepare a scene for a response table (see response.hpp). They remove keys that do not influence the
/// table, such as material and radiation. They set arbitrary values for keys that every scene must have.
DOLP_EXPORT std::vector<Setting> surface_settings();

/// The text of an example scene: bare stainless steel at 10.6 um.
DOLP_EXPORT std::string example_scene();

struct BuiltInMaterial {
  std::string name;      ///< name of the material, as a value of the key surface.material
  double from_um = 0.0;  ///< shortest wavelength at which n and k are known
  double to_um = 0.0;    ///< longest wavelength at which n and k are known
  std::string source;
  std::string kind;  ///< "metal", "infrared window", "glass or oxide", "polymer", "water or ice", "mineral or carbon"
};
DOLP_EXPORT std::vector<BuiltInMaterial> materials();
/// The built-in material with this name. Whole words are enough if only one name begins with them or, if no name begins
/// with them, only one name contains them. Ignores case. Errors: InputError if no material or several materials fit.
DOLP_EXPORT BuiltInMaterial material(const std::string& name);

/// Results at points, in the order of the points.
struct Results : ResultColumns {
  Quantities given;          ///< quantities that have a column in these results; a value that is unknown is NaN
  std::string stokes_units;  ///< unit of the Stokes parameters for UDUNITS, such as "W m-2 um-1"
  /// The global attributes that a table file would have: device, precision, effects, rule, ...
  std::vector<Attribute> attributes;
  double integrand_evaluations = 0.0;  ///< number of evaluations of the integrand for these results
  std::vector<std::string> remarks;    ///< one line for each column of points that was probably meant differently
};

/// Points and their results as CSV, in the format of write_points. Errors: InputError for a column of wrong length.
DOLP_EXPORT std::string to_csv(const std::vector<Column>& points, const Results& results);

/// A lookup table in memory. Copies of a Table share its data.
class DOLP_EXPORT Table {
 public:
  /// Reads a table that dolp wrote as .nc. Errors: InputError.
  static Table read(const std::filesystem::path& path);
  /// Makes a table. For a part of another table, `values.attributes` may be the file_attributes() of the other table.
  /// Error messages begin with `name`. Errors: InputError if an axis, attribute or column is wrong.
  static Table of(TableValues values, const std::string& name = "table");

  const TableValues& values() const { return *values_; }
  /// The attributes that write() gives a .nc file: values().attributes and a few more, such as a hash of the values.
  std::vector<Attribute> file_attributes() const;

  Table(const Table&) = default;
  Table& operator=(const Table&) = default;
  ~Table() = default;

  /// Writes the table as .nc, .csv or .npy, by the suffix. The file is complete or absent. Errors: InputError, IoError.
  void write(const std::filesystem::path& path) const;

 private:
  friend class Evaluator;
  explicit Table(TableValues values) : values_(std::make_shared<const TableValues>(std::move(values))) {}
  std::shared_ptr<const TableValues> values_;
};

/// The result of a fit. If the call compared models, it is the result of the best model.
struct Fit : FitNumbers {
  Report report;             ///< report on parameters, intervals, correlations, minima and residuals
  bool has_minimum = false;  ///< true if any descent of the fit converged to a minimum
  Scene scene;               ///< scene of the best model, with the fitted values; unchanged if has_minimum is false
};

/// Computes results. The first call that needs a device sets up the device and the kernels, and the Evaluator keeps
/// both. It never switches from the device to the CPU. Errors of all calls: InputError; DeviceError if no device is
/// usable. A child process gets a DeviceError after fork(), because a Vulkan device does not survive a fork.
class DOLP_EXPORT Evaluator {
 public:
  explicit Evaluator(EvaluatorOptions options = {});
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;
  ~Evaluator();

  /// Computes the table over the scene's [grid], in memory.
  Table table(const Scene& scene, const RunOptions& options = {});
  /// Computes the table part by part, so that memory does not grow with the table. `take` gets each part as a Table
  /// whose axes have only some of the values. An exception from `take` ends the call.
  void table_parts(const Scene& scene, const std::function<void(const Table&)>& take, const RunOptions& options = {});
  /// Writes the table to a file (.nc, .csv or .npy), part by part as in table_parts(). A cancelled or killed call
  /// leaves its finished parts beside the file, and a later call with `resume` uses these parts. With `shard`, writes
  /// only this shard, to a file with "N-of-M" before its suffix. A complete .nc file of this shard stays if it has the
  /// same program, scene, n, k, irradiance, evaluator and keep_all. Errors: InputError, IoError.
  Report write_table(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {},
                     const Shard& shard = {});
  /// Computes a response table (see response.hpp) and the albedo over the scene's theta, sigma and q. First applies
  /// surface_settings() to the scene, because material, wavelength and radiation do not influence the table. The
  /// scene's tolerance limits response_error / albedo. Errors: InputError if the scattering is "multiple".
  Table response(const Scene& scene, const RunOptions& options = {});
  /// Writes the response table to a .nc file part by part. Errors: InputError, IoError.
  Report write_response(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {});
  /// Computes the same quantities as table(), at points. A variable without a column has the scene's value.
  Results evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& options = {});
  /// Computes results for a CSV of points. Writes a CSV: columns of the points, then results. "-" is stdin or stdout.
  Report write_points(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                      const RunOptions& options = {});
  /// Computes Mueller matrices at points, without a device. The error of each element is at most 1e-11 m00, where m00
  /// is the first element; with surface.scattering = "multiple", at most 1e-5 m00 and a tenth of the tolerance. All 16
  /// elements are NaN where the model has no finite value.
  std::vector<MuellerMatrix> mueller(const Scene& scene, const std::vector<Column>& points,
                                     const RunOptions& options = {});
  /// Computes Mueller matrices for the pairs of directions in a CSV. Writes a CSV, as write_points does.
  Report write_mueller(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                       const RunOptions& options = {});
  /// Fits numbers of the scene to data, with profile-likelihood intervals. Errors: IoError if a file cannot be written.
  Fit fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options);

 private:
  struct Impl;
  Impl& impl();
  std::unique_ptr<Impl> impl_;
};

/// Joins all shards of a table into one file. For `history` see RunOptions::history. Errors: InputError if a shard is
/// missing, occurs twice or belongs to another table; IoError.
DOLP_EXPORT Report merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& path,
                         const std::string& history = {});

/// All effects of the scene, and what a run at these points does with them.
DOLP_EXPORT std::vector<Effect> effects(const Scene& scene, const std::vector<Column>& points, bool keep_all = false);

/// The plan for a table over the scene's [grid]: kept and dropped effects, reasons, memory, and estimated CPU time.
DOLP_EXPORT Report plan(const Scene& scene, const std::string& device = {}, bool keep_all = false);

/// Checks a table file: computes some of its entries again by adaptive quadrature, which shares no formula with the
/// kernels, and compares the differences with the error bounds in the table. Errors: InputError.
DOLP_EXPORT Report verify(const std::filesystem::path& table, const TableCheckOptions& options = {});

/// Tells what interpolation between the entries of a table costs: computes values at random points inside the cells of
/// the table file, on the CPU, and compares them with linear and cubic interpolation. Errors: InputError.
DOLP_EXPORT Report verify_between(const std::filesystem::path& table, const BetweenOptions& options = {});

/// Computes cases that are numerically hard and compares them with stored references. Errors: InputError, DeviceError.
DOLP_EXPORT Report verify_device(const DeviceCheckOptions& options = {});

/// The limits of all devices, and their accuracy in a few ordinary cases. Report::is_good: true if a device is usable.
DOLP_EXPORT Report device_report();

}  // namespace dolp
