// The study of throughput measures entries and integrand evaluations per second.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "device/devices.hpp"
#include "evaluate/vulkan/vulkan_evaluator.hpp"
#include "model/choices.hpp"
#include "scene/material_data.hpp"
#include "studies/cases.hpp"
#include "studies/grids.hpp"
#include "studies/study.hpp"
#include "studies/study_run.hpp"
#include "studies/timed_scene.hpp"
#include "studies/timing.hpp"

namespace dolp::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::array kMaskings = {Masking::kNone, Masking::kVCavity, Masking::kIntegral, Masking::kSmith};
constexpr std::array kMaskingsByRows = {Masking::kIntegral, Masking::kSmith};
constexpr double kTolerance = 1e-4;
constexpr std::array kTolerances = {1e-3, 1e-4, 1e-6};
constexpr std::array<GridSize, 8> kGrids = {{{32, 32, 32},
                                             {64, 64, 64},
                                             {128, 64, 64},
                                             {64, 128, 64},
                                             {64, 64, 128},
                                             {256, 64, 64},
                                             {256, 128, 64},
                                             {256, 128, 128}}};
// Position of the main grid in kGrids. The part `grids` also runs the other grids, and `materials` runs kMaterialGrids.
// All other parts run only the main grid.
constexpr std::size_t kMainGrid = 1;
constexpr std::size_t kQuickGridEntries = std::size_t{24} * 24 * 24;
constexpr std::size_t kFullRepeats = 5;
constexpr std::size_t kQuickRepeats = 2;
constexpr double kLongGridTime = 1.0;  // seconds; a grid that takes longer runs only kQuickRepeats times
/// A part of the study, with its name for the option --case.
struct Part {
  std::string name;
};
const std::vector<Part> kParts = {{"grids"}, {"materials"}};

/// The grids of kGrids with at most `entries` entries. If there is none, a cubic grid of about `entries` entries.
std::vector<GridSize> grids_up_to(std::size_t entries) {
  std::vector<GridSize> sizes;
  for (const GridSize& size : kGrids) {
    if (size.entries() <= entries) sizes.push_back(size);
  }
  if (sizes.empty()) {
    const auto side = static_cast<std::size_t>(std::max(2.0, std::floor(std::cbrt(static_cast<double>(entries)))));
    sizes.push_back({side, side, side});
  }
  return sizes;
}

/// The largest error estimate of a run, over the entries without a status bit.
double stated_error(const RunResults& results) {
  double largest = 0.0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results.status[i] == 0) largest = std::max(largest, results[Quantity::kRhoErrorEstimate][i]);
  }
  return largest;
}

ordered_json row_start(const char* part, const std::string& which, const ordered_json& setting) {
  return {{"part", part}, {"case", which}, {"setting", setting}};
}

/// A grid that the study runs like `dolp table`.
struct GridRun {
  GridSize size;
  double tolerance = kTolerance;
  bool may_interpolate = true;
  std::unique_ptr<TimedScene> timed = {};

  /// True if this run is `other` with one axis twice as long.
  bool doubles(const GridRun& other) const {
    return tolerance == other.tolerance && may_interpolate == other.may_interpolate &&
           size.entries() == 2 * other.size.entries() && size.thetas % other.size.thetas == 0 &&
           size.sigmas % other.size.sigmas == 0 && size.qs % other.size.qs == 0;
  }
};

// The first grid is for a full study, the second grid for a quick study.
constexpr std::array<GridSize, 2> kMaterialGrids = {{{64, 16, 16}, {8, 8, 8}}};
constexpr std::size_t kManyIndices = 12;  // number of values of n, and of k
constexpr std::size_t kManyWavelengths = 300;

std::vector<double> spaced(double first, double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    values.push_back(std::lerp(first, last, static_cast<double>(i) / static_cast<double>(count - 1)));
  return values;
}

constexpr OpticalConstants kAluminium{27.0, 90.0};
constexpr OpticalConstants kOxide{0.7, 0.1};
constexpr OpticalConstants kPaint{1.5, 0.02};

struct MaterialAxes {
  std::string name;
  std::string material = {};  ///< name of a built-in material; empty means the scene's material
  std::vector<double> n = {}, k = {}, wavelength_um = {};
  std::optional<OpticalConstants> index = {};  ///< replaces n and k of the scene
  std::vector<Layer> coating = {};
  /// Position of the base case in material_axes(). The results state the kernel time relative to the base case.
  std::size_t over = 0;
  std::vector<Spectrum> bands = {};
  std::vector<double> temperature_K = {};
  bool has_all_materials = false;
  double polarised_diffuse = 0.0;  ///< factor k_d of the diffuse reflection, which is polarised here
};

Layer layer(const OpticalConstants& index, double thickness_um) { return {{.constant = index}, thickness_um}; }

std::vector<MaterialAxes> material_axes() {
  const auto spectrum_of = [](const std::string& material, double from_um) {
    return MaterialAxes{fmt::format("{}, {} wavelengths {:g}-14 um", material, kManyWavelengths, from_um),
                        material,
                        {},
                        {},
                        spaced(from_um, 14.0, kManyWavelengths)};
  };
  return {{"one index"},
          {fmt::format("{} n x {} k", kManyIndices, kManyIndices),
           {},
           spaced(1.2, 4.0, kManyIndices),
           spaced(0.05, 3.0, kManyIndices)},
          spectrum_of("water 25C", 8.0),
          spectrum_of("SiO2 amorphous quartz", 7.6),
          {.name = "aluminium", .index = kAluminium, .over = 4},
          {.name = "aluminium, 1 um oxide", .index = kAluminium, .coating = {layer(kOxide, 1.0)}, .over = 4},
          {.name = "aluminium, 3 um paint on 1 um oxide",
           .index = kAluminium,
           .coating = {layer(kPaint, 3.0), layer(kOxide, 1.0)},
           .over = 4},
          {.name = "aluminium, 20 um paint", .index = kAluminium, .coating = {layer(kPaint, 20.0)}, .over = 4},
          {.name = "all built-in materials", .over = 4, .has_all_materials = true},
          {.name = "30 temperatures", .temperature_K = spaced(270.0, 330.0, 30)},
          {.name = "4 bands of one index", .bands = {{3.0, 4.0}, {4.5, 5.0}, {8.0, 10.0}, {10.0, 12.0}}},
          {.name = "polarised diffuse part", .polarised_diffuse = 0.2}};
}

/// Adds an axis with all built-in materials that have data at the scene's wavelength.
void add_all_materials(SceneValues& scene) {
  std::vector<Material> materials;
  for (const Material& material : built_in_materials()) {
    const Spectrum known = known_range(material);
    if (known.min_um > scene.spectrum.min_um || known.max_um < scene.spectrum.max_um) continue;
    scene.grid[Axis::kMaterial].push_back(static_cast<double>(materials.size()));
    materials.push_back(fit_to_spectrum(material, scene.spectrum, "all materials: "));
  }
  scene.surface.material = materials.front();
  scene.materials = std::make_shared<const std::vector<Material>>(std::move(materials));
}

ordered_json grid_row(Masking masking, const GridRun& run) {
  const std::size_t entries = run.size.entries();
  const double time_s = median(run.timed->times_s());
  const double kernel_s = median(run.timed->kernel_times_s());
  const double evaluations = run.timed->work().evaluations / static_cast<double>(entries);
  const std::string setting =
      fmt::format("{}, {:g}{}", run.size.text(), run.tolerance, run.may_interpolate ? "" : ", off");
  ordered_json row = row_start("grids", to_name(masking), setting);
  row["grid"] = {run.size.thetas, run.size.sigmas, run.size.qs};
  row["tolerance"] = run.tolerance;
  row["entries"] = entries;
  row["interpolation"] = run.may_interpolate ? "auto" : "off";
  row["interpolated"] = run.timed->work().interpolated;
  row["interpolation_nodes"] = run.timed->work().interpolation_nodes;
  row["time_s"] = time_s;
  row["kernel_time_s"] = kernel_s;
  row["run_s"] = rounded_time(time_s * static_cast<double>(entries));
  row["kernel_run_s"] = rounded_time(kernel_s * static_cast<double>(entries));
  row["entries_per_s"] = std::round(1.0 / time_s);
  row["evaluations"] = evaluations;
  row["evaluations_per_s"] = std::round(evaluations / kernel_s);
  row["stated_error"] = stated_error(run.timed->results());
  row["time_min_s"] = minimum(run.timed->times_s());
  row["raw_times_s"] = run.timed->times_s();
  row["raw_kernel_times_s"] = run.timed->kernel_times_s();
  return row;
}

class ThroughputStudy {
 public:
  explicit ThroughputStudy(StudyRun& run);
  void measure_all();

 private:
  bool runs(const std::string& part) const { return std::ranges::find(parts_, part, &Part::name) != parts_.end(); }
  bool quick() const { return run_.options().quick; }
  GridSize main_grid() const { return grids_[std::min(kMainGrid, grids_.size() - 1)]; }
  void describe();
  void run_grids(Masking masking);
  void run_materials(Masking masking);

  StudyRun& run_;
  std::vector<Part> parts_;
  std::vector<GridSize> grids_;
};

ThroughputStudy::ThroughputStudy(StudyRun& run)
    : run_(run),
      parts_(chosen(kParts, run.options().cases, "--case")),
      grids_(grids_up_to(quick() ? std::min(run.options().entries, kQuickGridEntries) : run.options().entries)) {
  if (runs("grids")) run_.expect(kMaskings.size() * (grids_.size() + 2 * kTolerances.size() - 1));
  if (runs("materials")) run_.expect(kMaskingsByRows.size() * material_axes().size());
}

void ThroughputStudy::describe() {
  run_.describe(
      "throughput", "stated_error: largest rho_error_estimate of the entries without a status",
      "seconds an entry, median: plan, evaluation and radiometry as `dolp table` runs them, warm, files and device "
      "creation not counted");
  run_.json()["grid"] = main_grid().text();
  run_.json()["scene"] = "stainless steel, precision auto";
}

void ThroughputStudy::measure_all() {
  describe();
  if (runs("grids")) {
    for (const Masking masking : kMaskings) run_grids(masking);
  }
  if (runs("materials")) {
    for (const Masking masking : kMaskingsByRows) run_materials(masking);
  }
}

void ThroughputStudy::run_grids(Masking masking) {
  VulkanEvaluator evaluator(VulkanOptions{.device = run_.options().device});
  std::vector<GridRun> runs;
  for (const GridSize& size : grids_) runs.push_back({size});
  for (const double tolerance : kTolerances) {
    if (tolerance != kTolerance) runs.push_back({main_grid(), tolerance});
    runs.push_back({main_grid(), tolerance, false});
  }
  for (GridRun& run : runs) {
    SceneValues scene = steel_scene(masking, run.size);
    scene.accuracy.tolerance = run.tolerance;
    scene.accuracy.may_interpolate = run.may_interpolate;
    run.timed = std::make_unique<TimedScene>(std::move(scene), false, evaluator);
  }
  // Each turn of the loop runs all grids once, so that other load on the machine affects all grids equally.
  for (std::size_t i = 0; i < (quick() ? kQuickRepeats : kFullRepeats); ++i) {
    for (const GridRun& run : runs) {
      const std::vector<double> times_s = run.timed->times_s();
      const bool is_long = !times_s.empty() && times_s.back() * static_cast<double>(run.size.entries()) > kLongGridTime;
      if (i < kQuickRepeats || !is_long) run.timed->repeat();
    }
  }
  for (const GridRun& run : runs) {
    ordered_json row = grid_row(masking, run);
    const auto half = std::ranges::find_if(runs, [&](const GridRun& other) { return run.doubles(other); });
    if (half != runs.end()) {
      const double half_s = median(half->timed->times_s()) * static_cast<double>(half->size.entries());
      row["doubled_ratio"] = row["run_s"].get<double>() / half_s;
    }
    run_.finish(row);
  }
}

void ThroughputStudy::run_materials(Masking masking) {
  VulkanEvaluator evaluator(VulkanOptions{.device = run_.options().device});
  const GridSize size = kMaterialGrids[quick() ? 1 : 0];
  std::vector<std::unique_ptr<TimedScene>> all;
  for (const MaterialAxes& axes : material_axes()) {
    SceneValues scene = steel_scene(masking, size);
    if (!axes.material.empty()) {
      const std::vector<Material>& known = built_in_materials();
      const auto found = std::ranges::find(known, axes.material, &Material::name);
      if (found == known.end()) throw InputError("no material " + axes.material);
      scene.surface.material.tabulated = std::make_shared<const Material>(*found);
    }
    if (axes.index) scene.surface.material.constant = *axes.index;
    scene.surface.coating = axes.coating;
    scene.surface.diffuse = axes.polarised_diffuse;
    scene.surface.diffuse_polarisation = DiffusePolarisation::kTransmission;
    if (axes.has_all_materials) add_all_materials(scene);
    for (const Spectrum& band : axes.bands) {
      scene.grid[Axis::kBand].push_back(static_cast<double>(scene.bands.size()));
      scene.bands.push_back(band);
      scene.spectrum = scene.bands.front();
    }
    scene.grid[Axis::kTemperature] = axes.temperature_K;
    scene.grid[Axis::kN] = axes.n;
    scene.grid[Axis::kK] = axes.k;
    scene.grid[Axis::kWavelength] = axes.wavelength_um;
    all.push_back(std::make_unique<TimedScene>(std::move(scene), false, evaluator));
  }
  for (std::size_t i = 0; i < kQuickRepeats; ++i) {
    for (const std::unique_ptr<TimedScene>& one : all) one->repeat();
  }
  // Only the time of the kernels counts. It leaves out the time in which the host computes the moments of each index
  // from the results of the kernels.
  const auto kernels_s = [&](std::size_t i) { return all[i]->work().kernel_s; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto entries = static_cast<double>(all[i]->entries().size());
    const double time_s = median(all[i]->times_s());
    ordered_json row = row_start("materials", to_name(masking), material_axes()[i].name);
    row["grid"] = {size.thetas, size.sigmas, size.qs};
    row["entries"] = all[i]->entries().size();
    row["time_s"] = time_s;
    row["kernel_time_s"] = kernels_s(i) / entries;
    row["run_s"] = rounded_time(time_s * entries);
    row["kernel_run_s"] = rounded_time(kernels_s(i));
    row["kernels_over_one"] = kernels_s(i) / kernels_s(material_axes()[i].over);
    row["entries_per_s"] = std::round(1.0 / time_s);
    row["evaluations_per_s"] = std::round(all[i]->work().evaluations / kernels_s(i));
    row["stated_error"] = stated_error(all[i]->results());
    row["raw_times_s"] = all[i]->times_s();
    run_.finish(row);
  }
}

std::string table_line(const ordered_json& row) {
  std::string line =
      fmt::format("  {:<12} {:<10} {:<24}{:>9}", row["part"].get<std::string>(), row["case"].get<std::string>(),
                  row["setting"].get<std::string>(), time_text(row["time_s"].get<double>()));
  if (row.contains("kernel_time_s")) {
    line += fmt::format(" {:>9} in kernels, {:.3g} entries/s, {:.3g} evaluations/s, run {}",
                        time_text(row["kernel_time_s"].get<double>()), row["entries_per_s"].get<double>(),
                        row["evaluations_per_s"].get<double>(), time_text(row["run_s"].get<double>()));
  }
  if (row.contains("kernels_over_one"))
    line += fmt::format(", kernels {:.2f} of one index", row["kernels_over_one"].get<double>());
  if (row.contains("doubled_ratio")) line += fmt::format(", {:.2f} of half", row["doubled_ratio"].get<double>());
  return line + "\n";
}

std::string throughput_table(const ordered_json& result) {
  std::string text = fmt::format("{}; time per entry on {}\n", result["scene"].get<std::string>(),
                                 result["context"]["device"].value("name", std::string("no device")));
  for (const ordered_json& row : result["results"]) text += table_line(row);
  return text;
}

}  // namespace

void run_throughput(const StudyOptions& options) {
  run_study(options,
            {.measure = [](StudyRun& run) { ThroughputStudy(run).measure_all(); }, .table_text = throughput_table});
}

}  // namespace dolp::bench
