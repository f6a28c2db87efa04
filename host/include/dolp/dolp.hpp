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
// Units and names are those of the command line and of the files: angles in degrees, wavelengths in um, temperatures in
// K. Numbers are the bits that the command line computes on the same device.
// Errors are exceptions derived from std::exception; a call that throws has changed nothing and left no file, but for
// what write_table says of cancelled calls.
// Threads: objects of one class may be used in several threads at a time as long as each thread has its own; an
// Evaluator and a Table serve several threads too, their calls wait for one another. A call of an Evaluator from its
// own progress, `phase` or `take` is an InputError. Moves: a Scene and a Table that were moved from keep what they
// hold; calls of an Evaluator that was moved from throw InputError, until another is assigned to it.
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
/// The commit that the library was built from; "unknown" outside of a repository.
DOLP_EXPORT std::string commit();
/// How to cite the program and the model, in the Citation File Format.
DOLP_EXPORT std::string citation();

/// Report of a call about its work.
struct Report {
  std::string text;              ///< for people, in lines
  std::string json;              ///< all values, as the command's --json prints them
  bool is_good = true;           ///< no entry misses its tolerance; of a check: nothing is wrong
  std::filesystem::path output;  ///< the file that was written, where there is one
  std::vector<std::pair<std::string, std::string>> rows = {};  ///< the lines of `text` that have a label, and these
  std::vector<std::string> remarks = {};  ///< on points that were probably meant otherwise, one line each
};

/// A validated scene: surface, radiation, geometry, grid and accuracy. Copies share what they hold.
class DOLP_EXPORT Scene {
 public:
  /// Reads a scene file (TOML); "-" is stdin. Settings apply in their order.
  /// Errors: InputError with file, line, key, value and allowed range.
  static Scene from_file(const std::filesystem::path& path, const std::vector<Setting>& settings = {});
  /// The same for a text; files that it names are looked for in the folder of `name`, which messages
  /// begin with.
  static Scene from_text(const std::string& text, const std::vector<Setting>& settings = {},
                         const std::string& name = "scene");
  /// The same scene with another value of a key: with("surface.sigma", 0.2). Errors: InputError with key and value.
  Scene with(const std::string& key, const Value& value) const { return with({{key, value}}); }
  Scene with(const std::vector<Setting>& settings) const;
  /// The same scene on other axes: with_grid({{"theta_deg", AxisRange{0, 60, 7}}, {"sigma", {0.1, 0.2}}}).
  Scene with_grid(const std::vector<Setting>& axes) const;
  /// The same scene without a table, as "surroundings", or a key.
  Scene without(const std::string& key) const { return with(key, Value()); }

  const std::string& title() const;
  const std::string& name() const;  ///< the path of its file, or the name of its text
  const std::string& text() const;  ///< as it was read, without settings
  const std::vector<Setting>& settings() const;
  /// The scene with its settings applied, as TOML; files that it names are found from `folder`.
  std::string toml(const std::filesystem::path& folder = ".") const;

  /// The value of a key, given or default, in its unit. None where the scene has no such thing: the temperature of an
  /// emission that is not there, n where there is a material. Errors: InputError for a key that has no number.
  std::optional<double> number(std::string_view key) const;
  /// Likewise of words, texts (none where they are empty) and flags ("true", "false").
  std::optional<std::string> word(std::string_view key) const;
  /// Likewise of axes and pairs, empty where the scene has none.
  std::vector<double> numbers(std::string_view key) const;
  /// The names on the grid's axes of materials and bands: columns of points have their positions.
  const AxisLabels& labels() const;
  /// What the scene takes that was probably meant otherwise (Celsius, nanometres), and what it assumes because its
  /// files lack it (k, rows across its spectrum): one line each, empty for most scenes.
  std::vector<std::string> remarks() const;
  /// n and k at a wavelength. Errors: InputError where the material has none.
  std::pair<double, double> refractive_index(double wavelength_um) const;

  // Without moves, so that an object that was moved from keeps its contents.
  Scene(const Scene&) = default;
  Scene& operator=(const Scene&) = default;
  ~Scene() = default;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

/// Settings that take out of a scene what responses do not depend on: with them a scene needs no material and no
/// radiation.
DOLP_EXPORT std::vector<Setting> surface_settings();

/// The text of a scene to begin with: bare stainless steel at 10.6 um.
DOLP_EXPORT std::string example_scene();

/// A built-in material.
struct BuiltInMaterial {
  std::string name;      ///< as surface.material takes it
  double from_um = 0.0;  ///< the wavelengths at which n and k are known
  double to_um = 0.0;
  std::string source;
};
DOLP_EXPORT std::vector<BuiltInMaterial> materials();
/// The one of that name, or the only one that begins with it up to a blank; case does not matter.
/// Errors: InputError with the nearest.
DOLP_EXPORT BuiltInMaterial material(const std::string& name);

/// Results at points, computed or read from a table, in the order of the points.
struct Results : ResultColumns {
  Quantities given;          ///< that results of the scene have; NaN where one was not computed
  std::string stokes_units;  ///< UDUNITS: "W m-2 um-1"
  /// Global attributes as in table files: device, precision, effects, rule, ...
  std::vector<Attribute> attributes;
  double integrand_evaluations = 0.0;  ///< evaluations that they took
};

/// Points and their results as CSV, as write_points writes it.
/// Errors: InputError where a column has neither one value nor one for each result.
DOLP_EXPORT std::string to_csv(const std::vector<Column>& points, const Results& results);

/// A lookup table in memory. Copies share what they hold.
class DOLP_EXPORT Table {
 public:
  /// Reads a table that dolp wrote as .nc. Errors: InputError.
  static Table read(const std::filesystem::path& path);
  /// A table of its contents, as values() and file_attributes() give them: of another, or a part of one. `name` is for
  /// messages. Errors: InputError where they do not fit together.
  static Table of(TableValues values, const std::string& name = "table");

  const TableValues& values() const;
  /// The global attributes as a file has them, which also names its conventions and has a hash of the values.
  std::vector<Attribute> file_attributes() const;

  // Without moves, so that an object that was moved from keeps its contents.
  Table(const Table&) = default;
  Table& operator=(const Table&) = default;
  ~Table() = default;

  /// The table between its entries. An axis of one value needs no column; other missing columns take the
  /// scene's values.
  /// Its error estimates contain the interpolation.
  /// Errors: InputError for a point outside of the axes, with its position, value and what is allowed; for a table
  /// without its scene (attribute scene), without a quantity that results need, or without an axis that its scene has.
  Results lookup(const std::vector<Column>& points, const Progress& progress = {}) const;

  /// Writes .nc, .csv or .npy, by the suffix; the file is complete or absent. Errors: InputError, IoError.
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
  Scene scene;               ///< with what was compared and what was found; without a minimum the scene itself
};

/// Computes. Device and kernels are made when they are first needed and kept as long as the object lives.
/// Errors of all calls: InputError; DeviceError when there is no usable device: never a silent switch to the CPU. After
/// fork() the child's calls for vulkan throw DeviceError: a device does not outlive a fork.
class DOLP_EXPORT Evaluator {
 public:
  explicit Evaluator(EvaluatorOptions options = {});
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;
  ~Evaluator();

  /// The table over the scene's [grid], in memory.
  Table table(const Scene& scene, const RunOptions& options = {});
  /// The same part by part, each of which `take` gets with its own axes, which are pieces of the table's. Memory does
  /// not grow with the table. An exception from `take` ends the call.
  void table_parts(const Scene& scene, const std::function<void(const Table&)>& take, const RunOptions& options = {});
  /// The same straight into a file, .nc, .csv or .npy by its suffix, part by part, so that memory does not grow with
  /// the table. A shard's file has "N-of-M" before its suffix; a whole one of the same scene, n, k and E0, evaluator
  /// and options that is there already is kept. The finished parts of a cancelled or killed call stay beside the file,
  /// for `resume`, which computes again what they no longer hold. Errors: InputError, also for a shard that is none of
  /// its count; IoError. The file is complete or absent.
  Report write_table(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {},
                     const Shard& shard = {});
  /// The response table over the scene's theta, sigma and q: TableValues::responses and the albedo. It does not depend
  /// on material, wavelength or radiation, and its scene is that of surface_settings(). Tolerance: response_error is at
  /// most this times the albedo. Errors: InputError for scattering "multiple".
  Table response(const Scene& scene, const RunOptions& options = {});
  /// The same straight into a .nc file, part by part. The file is complete or absent. Errors: InputError, IoError.
  Report write_response(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {});
  /// The same quantities at scattered points; missing columns take the scene's values.
  Results evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& options = {});
  /// The same of a CSV of points into a CSV that has their columns first; "-" is stdin and stdout.
  Report write_points(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                      const RunOptions& options = {});
  /// Mueller matrices, 1e-5 of m00 in float, 1e-11 in double; all 16 NaN where the model has no finite value.
  std::vector<MuellerMatrix> mueller(const Scene& scene, const std::vector<Column>& points,
                                     const RunOptions& options = {});
  /// The same of a CSV of geometries into a CSV, likewise.
  Report write_mueller(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                       const RunOptions& options = {});
  /// Numbers of the scene from measured data, with profile-likelihood intervals.
  /// Errors: InputError too, where data, ranges and scene do not fit together; IoError.
  Fit fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options);

 private:
  struct Impl;
  Impl& impl();
  std::unique_ptr<Impl> impl_;
};

/// Interpolates in a table file at a CSV of points, into a CSV that has their columns first, with the error of that;
/// "-" is stdin and stdout. Errors: InputError, IoError.
DOLP_EXPORT Report write_lookup(const std::filesystem::path& table, const std::filesystem::path& points,
                                const std::filesystem::path& path, const Progress& progress = {});

/// Joins all shards of a table into one file; they are opened one at a time. `history`: as in RunOptions.
/// Errors: InputError that names a shard that is missing, duplicate, or of another table; IoError.
DOLP_EXPORT Report merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& path,
                         const std::string& history = {});

/// All effects, in the order of a scene file. Influences are evaluated on the CPU, to 1e-3.
DOLP_EXPORT std::vector<Effect> effects(const Scene& scene, const std::vector<Column>& points, bool keep_all = false);

/// Plan of a table over the scene's grid: computed and dropped effects, the reasons, and the cost. Only counting on the
/// CPU is run.
DOLP_EXPORT Report plan(const Scene& scene, const std::string& device = {}, bool keep_all = false);

/// Computes entries of a table file again with adaptive quadrature, which shares no formula with the kernels, and
/// compares them with the table's values and errors. Errors: InputError.
DOLP_EXPORT Report verify(const std::filesystem::path& table, const TableCheckOptions& options = {});

/// Computes the model's hard cases and compares them with stored references. Errors: InputError, DeviceError.
DOLP_EXPORT Report verify_device(const DeviceCheckOptions& options = {});

/// The limits of all devices, and how well each computes a few ordinary cases. is_good: a device is usable.
DOLP_EXPORT Report device_report();

}  // namespace dolp
