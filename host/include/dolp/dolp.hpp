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
// Numbers equal the numbers of the command line on the same device, bit for bit.
//
// Errors: exceptions derived from std::exception. A call that throws changes nothing and leaves no file; only a
// cancelled write_table leaves its finished parts.
// Threads: each thread may use separate objects. Several threads may also share an Evaluator or a Table; their calls
// then wait for each other. If a progress, `phase` or `take` calls the Evaluator that called it, this throws
// InputError. Moves: a Scene or a Table keeps its contents after a move. An Evaluator that was moved from throws
// InputError until you assign another one to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
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

/// "0.2.0".
DOLP_EXPORT std::string version();
/// The commit from which the library was built; "unknown" outside a repository.
DOLP_EXPORT std::string commit();
/// How to cite the program and the model, in the Citation File Format.
DOLP_EXPORT std::string citation();

/// Report of a call about its work.
struct Report {
  std::string text;              ///< lines for people
  std::string json;              ///< all values, as --json prints them
  bool is_good = true;           ///< no entry misses its tolerance; for a check: nothing is wrong
  std::filesystem::path output;  ///< the file that the call wrote; empty without one
  /// the lines of `text` that have a label, with the label
  std::vector<std::pair<std::string, std::string>> rows = {};
  std::vector<std::string> remarks = {};  ///< one line for each input that was probably meant differently
};

/// A validated scene: surface, radiation, geometry, grid and accuracy. Copies share their data.
class DOLP_EXPORT Scene {
 public:
  /// Reads a scene file (TOML); "-" is stdin. Settings apply in their order.
  /// Errors: InputError with file, line, key, value and allowed range.
  static Scene from_file(const std::filesystem::path& path, const std::vector<Setting>& settings = {});
  /// Reads a scene from text. Files that it names are searched in the folder of `name`; error messages begin with
  /// `name`.
  static Scene from_text(const std::string& text, const std::vector<Setting>& settings = {},
                         const std::string& name = "scene");
  /// A copy of the scene with another value of a key: with("surface.sigma", 0.2). Errors: InputError with key and
  /// value.
  Scene with(const std::string& key, const Value& value) const { return with({{key, value}}); }
  Scene with(const std::vector<Setting>& settings) const;
  /// A copy of the scene with other axes: with_grid({{"theta_deg", AxisRange{0, 60, 7}}, {"sigma", {0.1, 0.2}}}).
  Scene with_grid(const std::vector<Setting>& axes) const;
  /// A copy of the scene without a key, or without a whole table such as "surroundings".
  Scene without(const std::string& key) const { return with(key, Value()); }

  const std::string& title() const;
  const std::string& name() const;  ///< the path of its file, or the `name` of its text
  const std::string& text() const;  ///< the text as it was read, without settings
  const std::vector<Setting>& settings() const;
  /// The scene with its settings applied, as TOML. Names of files are relative to `folder`.
  std::string toml(const std::filesystem::path& folder = ".") const;

  /// The value of a key, given or default, in its unit. Empty if the scene lacks the thing that the key describes: the
  /// temperature of an emission that is absent, or n of a scene with a material. Errors: InputError for a key without a
  /// number.
  std::optional<double> number(std::string_view key) const;
  /// The value of a key that is a word, a text (empty texts count as none) or a flag ("true", "false"). Empty as for
  /// number().
  std::optional<std::string> word(std::string_view key) const;
  /// The values of a key that is an axis or a pair; empty if the scene has none.
  std::vector<double> numbers(std::string_view key) const;
  /// The names on the grid's axes of materials and bands. Columns of points contain positions in these lists.
  const AxisLabels& labels() const;
  /// Remarks, one line each: values that were probably meant differently (Celsius, nanometres), and assumptions about
  /// data that files lack (k, rows across the spectrum). Empty for most scenes.
  std::vector<std::string> remarks() const;
  /// n and k at a wavelength. Errors: InputError if the material has none there.
  std::pair<double, double> refractive_index(double wavelength_um) const;

  // There is no move, so an object that was moved from keeps its contents.
  Scene(const Scene&) = default;
  Scene& operator=(const Scene&) = default;
  ~Scene() = default;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

/// Settings that remove everything on which responses do not depend. A scene with these settings needs no material and
/// no radiation.
DOLP_EXPORT std::vector<Setting> surface_settings();

/// The text of a scene to start from: bare stainless steel at 10.6 um.
DOLP_EXPORT std::string example_scene();

/// A built-in material.
struct BuiltInMaterial {
  std::string name;      ///< name for surface.material
  double from_um = 0.0;  ///< range of wavelengths for which n and k are known
  double to_um = 0.0;
  std::string source;
};
DOLP_EXPORT std::vector<BuiltInMaterial> materials();
/// The material with this name, or the only one whose name begins with this word. Case does not matter.
/// Errors: InputError with the nearest name.
DOLP_EXPORT BuiltInMaterial material(const std::string& name);

/// Results at points, computed or read from a table, in the order of the points.
struct Results : ResultColumns {
  Quantities given;          ///< quantities that results of the scene have; NaN where a value was not computed
  std::string stokes_units;  ///< UDUNITS: "W m-2 um-1"
  /// Global attributes as in table files: device, precision, effects, rule, ...
  std::vector<Attribute> attributes;
  double integrand_evaluations = 0.0;  ///< number of evaluations for these results
};

/// Points and their results as CSV, in the format of write_points.
/// Errors: InputError if a column has neither one value nor one value per result.
DOLP_EXPORT std::string to_csv(const std::vector<Column>& points, const Results& results);

/// A lookup table in memory. Copies share their data.
class DOLP_EXPORT Table {
 public:
  /// Reads a table that dolp wrote as .nc. Errors: InputError.
  static Table read(const std::filesystem::path& path);
  /// Makes a table from contents such as values() and file_attributes() return, for instance a part of another table.
  /// `name` is for messages. Errors: InputError if the contents do not fit together.
  static Table of(TableValues values, const std::string& name = "table");

  const TableValues& values() const;
  /// The global attributes of a file of this table. Unlike values().attributes they name the conventions and include a
  /// hash of the values.
  std::vector<Attribute> file_attributes() const;

  // There is no move, so an object that was moved from keeps its contents.
  Table(const Table&) = default;
  Table& operator=(const Table&) = default;
  ~Table() = default;

  /// Interpolates in the table. An axis with one value needs no column; other missing columns take the scene's values.
  /// The error estimates include the error of the interpolation.
  /// Errors: InputError for a point outside the axes, with position, value and allowed range; also for a table without
  /// its scene (attribute scene), without a quantity that results need, or without an axis that its scene has.
  Results lookup(const std::vector<Column>& points, const Progress& progress = {}) const;

  /// Writes .nc, .csv or .npy, depending on the suffix. The file is complete or absent. Errors: InputError, IoError.
  void write(const std::filesystem::path& path) const;

 private:
  friend class Evaluator;
  struct Impl;
  explicit Table(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

/// A fit: the result for the best of the compared models.
struct Fit : FitNumbers {
  Report report;             ///< parameters, intervals, correlation, minima, residuals
  bool has_minimum = false;  ///< true if any descent converged
  /// the scene with the best choices and the fitted values; without a minimum the unchanged scene
  Scene scene;
};

/// Computes results. Device and kernels are created when they are first needed, and kept until the object is destroyed.
/// Errors of all calls: InputError; DeviceError if there is no usable device. It never switches to the CPU by itself.
/// After fork() calls in the child process that need Vulkan throw DeviceError, because a device does not survive a
/// fork.
class DOLP_EXPORT Evaluator {
 public:
  explicit Evaluator(EvaluatorOptions options = {});
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;
  ~Evaluator();

  /// Computes the table over the scene's [grid], in memory.
  Table table(const Scene& scene, const RunOptions& options = {});
  /// Computes the table over the scene's [grid] part by part, so that memory does not grow with the table. `take` gets
  /// each part with its axes, which are pieces of the table's axes. An exception from `take` ends the call.
  void table_parts(const Scene& scene, const std::function<void(const Table&)>& take, const RunOptions& options = {});
  /// Writes the table over the scene's [grid] to a file part by part, so that memory does not grow with the table. The
  /// suffix selects .nc, .csv or .npy. The file of a shard gets "N-of-M" before its suffix. A complete shard of the
  /// same scene, n, k and E0, evaluator and options is kept if it exists already. A cancelled or killed call leaves its
  /// finished parts beside the file; with `resume` the next call uses them and computes the rest. Errors: InputError,
  /// also for a shard number above its count; IoError. The file is complete or absent.
  Report write_table(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {},
                     const Shard& shard = {});
  /// Computes the response table over the scene's theta, sigma and q: TableValues::responses and the albedo. It depends
  /// on no material, wavelength or radiation, and has the scene with surface_settings(). Tolerance: response_error is
  /// at most the tolerance times the albedo. Errors: InputError for scattering "multiple".
  Table response(const Scene& scene, const RunOptions& options = {});
  /// Writes the response table to a .nc file part by part. The file is complete or absent. Errors: InputError, IoError.
  Report write_response(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {});
  /// Computes the quantities of a table at scattered points. Missing columns take the scene's values.
  Results evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& options = {});
  /// Computes results for a CSV of points. Writes a CSV with the columns of the points first; "-" is stdin and stdout.
  Report write_points(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                      const RunOptions& options = {});
  /// Mueller matrices, with an error of 1e-5 of m00 in float and 1e-11 in double. All 16 values are NaN where the model
  /// has no finite value.
  std::vector<MuellerMatrix> mueller(const Scene& scene, const std::vector<Column>& points,
                                     const RunOptions& options = {});
  /// Computes Mueller matrices for a CSV of geometries. Writes a CSV with the columns of the geometries first; "-" is
  /// stdin and stdout.
  Report write_mueller(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                       const RunOptions& options = {});
  /// Fits numbers of the scene to measured data, with profile-likelihood intervals.
  /// Errors: also InputError if data, ranges and scene do not fit together; IoError.
  Fit fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options);

 private:
  struct Impl;
  Impl& impl();
  std::unique_ptr<Impl> impl_;
};

/// Interpolates in a table file at a CSV of points. Writes a CSV with the columns of the points first, and with the
/// error of the interpolation; "-" is stdin and stdout. Errors: InputError, IoError.
DOLP_EXPORT Report write_lookup(const std::filesystem::path& table, const std::filesystem::path& points,
                                const std::filesystem::path& path, const Progress& progress = {});

/// Joins all shards of a table into one file. Opens one shard at a time. `history`: as in RunOptions.
/// Errors: InputError that names a missing or duplicate shard, or a shard of another table; IoError.
DOLP_EXPORT Report merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& path,
                         const std::string& history = {});

/// All effects, in the order of a scene file. Influences are evaluated on the CPU, to 1e-3.
DOLP_EXPORT std::vector<Effect> effects(const Scene& scene, const std::vector<Column>& points, bool keep_all = false);

/// Plan of a table over the scene's grid: computed and dropped effects, the reasons, and the cost. Counts the work on
/// the CPU, without computing the table.
DOLP_EXPORT Report plan(const Scene& scene, const std::string& device = {}, bool keep_all = false);

/// Checks a table file: computes some of its entries again by adaptive quadrature, which shares no formula with the
/// kernels, and compares values and errors. Errors: InputError.
DOLP_EXPORT Report verify(const std::filesystem::path& table, const TableCheckOptions& options = {});

/// Computes the model's hard cases and compares them with stored references. Errors: InputError, DeviceError.
DOLP_EXPORT Report verify_device(const DeviceCheckOptions& options = {});

/// The limits of all devices, and the accuracy of each one in a few ordinary cases. is_good: at least one device is
/// usable.
DOLP_EXPORT Report device_report();

}  // namespace dolp
