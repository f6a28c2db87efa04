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
// Errors: exceptions derived from std::exception. A call that throws changes nothing and leaves no file; only a
// cancelled write_table leaves its finished parts.
// Threads: each thread may use separate objects. Several threads may also share an Evaluator or a Table; their calls
// then wait for each other. A callback (`progress`, `phase` or `take`) must not call the Evaluator that called it; such
// a call throws InputError.
// Moves: a Scene or a Table keeps its contents after a move. An Evaluator that was moved from throws InputError until
// you assign another one to it.
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

/// A report about the work and the results of a call.
struct Report {
  std::string text;              ///< lines for people
  std::string json;              ///< all values, as --json prints them
  bool is_good = true;           ///< false if an entry misses its tolerance or a check finds something wrong
  std::filesystem::path output;  ///< the file that the call wrote; empty if it wrote none
  /// The lines of `text` that have a label: pairs of the label and the rest of the line.
  std::vector<std::pair<std::string, std::string>> rows = {};
  std::vector<std::string> remarks = {};  ///< one line for each input that was probably meant differently
};

/// A validated scene: surface, radiation, geometry, grid and accuracy. Copies share their data.
class DOLP_EXPORT Scene {
 public:
  /// Reads a scene file (TOML); "-" is stdin. Applies the settings in their order.
  /// Errors: InputError with file, line, key, value and allowed range.
  static Scene from_file(const std::filesystem::path& path, const std::vector<Setting>& settings = {});
  /// Reads a scene from text. Its files are in the folder of `name`; error messages begin with `name`.
  static Scene from_text(const std::string& text, const std::vector<Setting>& settings = {},
                         const std::string& name = "scene");
  /// A copy with another value of a key, for example with("surface.sigma", 0.2). Errors: InputError with key and value.
  Scene with(const std::string& key, const Value& value) const { return with({{key, value}}); }
  Scene with(const std::vector<Setting>& settings) const;
  /// A copy with other axes, for example with_grid({{"theta_deg", AxisRange{0, 60, 7}}, {"sigma", {0.1, 0.2}}}).
  Scene with_grid(const std::vector<Setting>& axes) const;
  /// A copy without a key, or without a whole table such as "surroundings".
  Scene without(const std::string& key) const { return with(key, Value()); }

  const std::string& title() const;
  const std::string& name() const;  ///< the path of its file, or the `name` of its text
  const std::string& text() const;  ///< the text as it was read, without settings
  const std::vector<Setting>& settings() const;
  /// The scene with its settings applied, as TOML. Names of files are relative to `folder`.
  std::string toml(const std::filesystem::path& folder = ".") const;

  /// The value of a key, given or default, in the unit of the key. Empty if the key describes nothing in this scene,
  /// such as n if the surface has a material. Errors: InputError for a key that is unknown or is no number.
  std::optional<double> number(std::string_view key) const;
  /// Like number(), for a word, a text or a flag ("true", "false"). Empty also if the text is empty.
  std::optional<std::string> word(std::string_view key) const;
  /// The values of a key that is an axis or a pair; empty if the scene has none.
  std::vector<double> numbers(std::string_view key) const;
  /// The names of materials and bands on the axes of the grid. Columns of points contain positions in these lists.
  const AxisLabels& labels() const;
  /// One line for each value that was probably meant differently, and for each assumption about data that files lack.
  std::vector<std::string> remarks() const;
  /// n and k at a wavelength. Errors: InputError if the material has none there.
  std::pair<double, double> refractive_index(double wavelength_um) const;

  Scene(const Scene&) = default;
  Scene& operator=(const Scene&) = default;
  ~Scene() = default;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

/// Settings that remove from a scene everything on which a response table does not depend. A scene with these settings
/// needs neither a material nor radiation.
DOLP_EXPORT std::vector<Setting> surface_settings();

/// The text of a scene to start from: bare stainless steel at 10.6 um.
DOLP_EXPORT std::string example_scene();

struct BuiltInMaterial {
  std::string name;      ///< name for surface.material
  double from_um = 0.0;  ///< n and k are known from from_um to to_um
  double to_um = 0.0;
  std::string source;
};
DOLP_EXPORT std::vector<BuiltInMaterial> materials();
/// The material with this name, or the only one whose name begins with this word, ignoring case. Errors: InputError.
DOLP_EXPORT BuiltInMaterial material(const std::string& name);

/// Results at points, in the order of the points. They were computed, or interpolated in a table.
struct Results : ResultColumns {
  Quantities given;          ///< quantities that the scene has; a value that was not computed is NaN
  std::string stokes_units;  ///< UDUNITS: "W m-2 um-1"
  /// Global attributes as in table files: device, precision, effects, rule, ...
  std::vector<Attribute> attributes;
  double integrand_evaluations = 0.0;  ///< evaluations of the integrand for these results
};

/// Points and their results as CSV, in the format of write_points. Errors: InputError for a column of wrong length.
DOLP_EXPORT std::string to_csv(const std::vector<Column>& points, const Results& results);

/// A lookup table in memory. Copies share their data.
class DOLP_EXPORT Table {
 public:
  /// Reads a table that dolp wrote as .nc. Errors: InputError.
  static Table read(const std::filesystem::path& path);
  /// Makes a table from contents like those that values() and file_attributes() return, for instance from a part of
  /// another table. Error messages begin with `name`. Errors: InputError if the contents do not fit together.
  static Table of(TableValues values, const std::string& name = "table");

  const TableValues& values() const;
  /// The global attributes of its file: values().attributes, the names of the conventions, and a hash of the values.
  std::vector<Attribute> file_attributes() const;

  Table(const Table&) = default;
  Table& operator=(const Table&) = default;
  ~Table() = default;

  /// Interpolates in the table. Missing columns take the only value of their axis, or else the scene's value. The error
  /// estimates include the error of the interpolation. Errors: InputError for a point outside the axes, or if the table
  /// lacks the attribute `scene`, a quantity that results need, or an axis that its scene has.
  Results lookup(const std::vector<Column>& points, const Progress& progress = {}) const;

  /// Writes .nc, .csv or .npy, depending on the suffix. The file is complete or absent. Errors: InputError, IoError.
  void write(const std::filesystem::path& path) const;

 private:
  friend class Evaluator;
  struct Impl;
  explicit Table(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

/// The result of a fit. If models were compared, it is the result of the best one.
struct Fit : FitNumbers {
  Report report;             ///< parameters, intervals, correlation, minima, residuals
  bool has_minimum = false;  ///< true if any descent converged
  Scene scene;               ///< scene with the best choices and the fitted values; unchanged without a minimum
};

/// Computes results. Device and kernels are created when they are first needed, and kept until the object is destroyed.
/// An Evaluator never switches to the CPU by itself. Errors of all calls: InputError; DeviceError if there is no usable
/// device, or if a child process needs Vulkan after fork(), because a device does not survive a fork.
class DOLP_EXPORT Evaluator {
 public:
  explicit Evaluator(EvaluatorOptions options = {});
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;
  ~Evaluator();

  /// Computes the table over the scene's [grid], in memory.
  Table table(const Scene& scene, const RunOptions& options = {});
  /// Computes the table part by part, so that memory does not grow with the table. `take` gets each part with its axes,
  /// which are pieces of the table's axes. An exception from `take` ends the call.
  void table_parts(const Scene& scene, const std::function<void(const Table&)>& take, const RunOptions& options = {});
  /// Writes the table to a file (.nc, .csv or .npy) part by part, so that memory does not grow with the table. A
  /// shard's file gets "N-of-M" before its suffix. If it exists, is complete, and has the same scene, n, k, E0,
  /// evaluator and options, the call keeps it. A cancelled or killed call leaves its finished parts beside the file;
  /// with `resume` the next call uses them. Errors: InputError, also for a shard number above its count; IoError.
  Report write_table(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {},
                     const Shard& shard = {});
  /// Computes the response table over the scene's theta, sigma and q: TableValues::responses and the albedo. It depends
  /// on no material, wavelength or radiation; its attributes have the scene with surface_settings(). Each
  /// response_error is at most the tolerance times the albedo. Errors: InputError for scattering "multiple".
  Table response(const Scene& scene, const RunOptions& options = {});
  /// Writes the response table to a .nc file part by part. Errors: InputError, IoError.
  Report write_response(const Scene& scene, const std::filesystem::path& path, const RunOptions& options = {});
  /// Computes the quantities of a table at scattered points. Missing columns take the scene's values.
  Results evaluate(const Scene& scene, const std::vector<Column>& points, const RunOptions& options = {});
  /// Computes results for a CSV of points. Writes a CSV with the points' columns first. "-" is stdin or stdout.
  Report write_points(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                      const RunOptions& options = {});
  /// Computes Mueller matrices at points. The error of each element is at most 1e-5 m00 in float and 1e-11 m00 in
  /// double. All 16 elements are NaN where the model has no finite value.
  std::vector<MuellerMatrix> mueller(const Scene& scene, const std::vector<Column>& points,
                                     const RunOptions& options = {});
  /// Computes Mueller matrices for a CSV of geometries. Writes a CSV like write_points.
  Report write_mueller(const Scene& scene, const std::filesystem::path& points, const std::filesystem::path& path,
                       const RunOptions& options = {});
  /// Fits numbers of the scene to measured data, with profile-likelihood intervals. Errors: also IoError.
  Fit fit(const Scene& scene, const std::vector<MeasuredData>& data, const FitOptions& options);

 private:
  struct Impl;
  Impl& impl();
  std::unique_ptr<Impl> impl_;
};

/// Interpolates in a table file at a CSV of points. Writes a CSV like write_points. Errors: InputError, IoError.
DOLP_EXPORT Report write_lookup(const std::filesystem::path& table, const std::filesystem::path& points,
                                const std::filesystem::path& path, const Progress& progress = {});

/// Joins all shards of a table into one file. `history`: as in RunOptions. Errors: InputError that names a missing or
/// duplicate shard, or a shard of another table; IoError.
DOLP_EXPORT Report merge(const std::vector<std::filesystem::path>& shards, const std::filesystem::path& path,
                         const std::string& history = {});

/// All effects at these points, in the order of a scene file. The CPU computes influences with the tolerance 1e-3.
DOLP_EXPORT std::vector<Effect> effects(const Scene& scene, const std::vector<Column>& points, bool keep_all = false);

/// The computed and dropped effects of a table over the scene's grid, the reasons, and the cost, estimated on the CPU.
DOLP_EXPORT Report plan(const Scene& scene, const std::string& device = {}, bool keep_all = false);

/// Checks a table file. Computes some of its entries again by adaptive quadrature, which shares no formula with the
/// kernels, and compares the differences with the errors that the table states. Errors: InputError.
DOLP_EXPORT Report verify(const std::filesystem::path& table, const TableCheckOptions& options = {});

/// Computes the model's hard cases and compares them with stored references. Errors: InputError, DeviceError.
DOLP_EXPORT Report verify_device(const DeviceCheckOptions& options = {});

/// Limits of all devices, and their accuracy in a few ordinary cases. `is_good` means that at least one is usable.
DOLP_EXPORT Report device_report();

}  // namespace dolp
