#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include <dolp/number_range.hpp>
#include "api/impl.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "base/version.hpp"
#include "device/devices.hpp"
#include "evaluate/cpu/cpu_evaluator.hpp"
#include "model/choices.hpp"
#include "plan/effects.hpp"
#include "report/run_report.hpp"
#include "report/verify_report.hpp"
#include "run/estimates.hpp"
#include "run/scene_run.hpp"
#include "run/table_scene.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"
#include "table/table_reader.hpp"

namespace dolp {
namespace {

/// The precisions to check. If "auto" leaves a precision out, sets `left_out` to the reason.
std::vector<Precision> checked_precisions(const DeviceCheckOptions& options, std::string& left_out) {
  const std::optional<Precision> wanted = named<Precision>(options.precision);
  if (!wanted) throw InputError("precision " + one_line(options.precision) + ": must be auto, float or double");
  if (*wanted != Precision::kAuto) return {*wanted};
  if (options.evaluator == "cpu") return {Precision::kFloat, Precision::kDouble};
  const DeviceList list = list_devices();
  if (list.devices.empty()) throw DeviceError(list.why_empty);
  const Device& device = list.devices[choose_device(list.devices, options.device, false)];
  if (device.has_double) return {Precision::kFloat, Precision::kDouble};
  left_out = "double is left out: " + device.name + " has no double precision (shaderFloat64)";
  return {Precision::kFloat};
}

BuiltInMaterial to_facts(const Material& material) {
  const Spectrum range = known_range(material);
  return {material.name, range.min_um, range.max_um, material.source, material.kind};
}

/// The quantities with these names; DOLP without names. Errors: InputError for a quantity that the table lacks.
Quantities chosen_quantities(const Quantities& given, const std::vector<std::string>& names, const std::string& table) {
  std::vector<std::string> known;
  for (const Quantity quantity : given) known.emplace_back(describe(quantity).name);
  Quantities chosen;
  for (const std::string& name : names.empty() ? std::vector<std::string>{"dolp"} : names) {
    const auto found = std::ranges::find(known, name);
    if (found == known.end())
      throw InputError(fmt::format("{}: has no quantity \"{}\"; it has {}", table, one_line(name), join(known)));
    chosen.push_back(given[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

}  // namespace

std::string version() { return program_version(); }
std::string commit() { return program_commit(); }
std::string citation() { return fmt::format("{}commit: \"{}\"\n", embedded_citation_cff(), commit()); }

Report plan(const Scene& scene, const std::string& device, bool keep_all) {
  const SceneValues& values = scene.impl().scene;
  return public_report(plan_report(values, device, plan_effects(values, grid_entries(values), keep_all)));
}

std::vector<Effect> effects(const Scene& scene, const std::vector<Column>& points, bool keep_all) {
  const SceneValues& values = scene.impl().scene;
  const SceneEntries entries = point_entries(values, points_of_columns(points, PointsKind::kDirections));
  const EffectPlan plan = plan_effects(values, entries, keep_all);
  std::vector<Effect> all = list_effects(values, entries, plan);
  add_influences(all, values, entries, plan);
  return all;
}

std::vector<BuiltInMaterial> materials() {
  std::vector<BuiltInMaterial> all;
  for (const Material& material : built_in_materials()) all.push_back(to_facts(material));
  return all;
}

BuiltInMaterial material(const std::string& name) { return to_facts(named_material(name, one_line(name) + ": ")); }

Report verify(const std::filesystem::path& path, const TableCheckOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const std::string name = path.string();
  check_may_hold_scene(name);
  const TableReader reader(path);
  const SceneValues scene =
      table_scene(reader.head(), name, options.named_files ? NamedData::kOfFiles : NamedData::kOfTable);
  TableSample sample;
  sample.positions = sample_positions(reader.head().size(), options.samples, options.seed);
  sample.table = reader.read_entries(sample.positions, options.progress);
  use_scene_labels(sample.table, scene, name);
  const auto check_sample = sample.table.beta_deg.empty() ? check_table : check_responses;
  const TableCheck check = check_sample(sample, scene, name, options.progress);
  return public_report(table_report(check, name, scene.title, options.seed, seconds_since(start)), check.passed());
}

Report verify_between(const std::filesystem::path& path, const BetweenOptions& options) {
  const std::string name = path.string();
  check_may_hold_scene(name);
  const TableReader reader(path);
  const TableHead& table = reader.head();
  const SceneValues scene = table_scene(table, name);
  const Quantities quantities = chosen_quantities(reader.layout().quantities, options.quantities, name);
  const PointsBetween between(table, options.points, options.seed);
  const TableValues entries = reader.read_entries(between.positions(), {});
  CpuEvaluator evaluator;
  const std::vector<PointResult> computed =
      evaluate_scene(scene, point_entries(scene, between.points()), evaluator, options.progress);
  return public_report(
      between_report(between.errors(entries, computed, quantities), options.points, name, scene.title));
}

Report verify_device(const DeviceCheckOptions& options) {
  if (!kToleranceRange.contains(options.tolerance)) {
    throw InputError(fmt::format("tolerance {:g}: must be a number in {}", options.tolerance, kToleranceRange.text()));
  }
  report_start(options.progress, 1);
  std::string left_out;
  std::vector<PrecisionCheck> checks;
  for (const Precision precision : checked_precisions(options, left_out)) {
    const std::unique_ptr<ModelEvaluator> evaluator =
        make_evaluator({options.evaluator, options.device}, precision == Precision::kDouble);
    PrecisionCheck& check = checks.emplace_back();
    check.outcomes = qualify(hard_cases(), *evaluator, {options.tolerance, precision}, options.progress);
    check.evaluation = evaluator->report();
  }
  const ReportBuilder report = hard_case_report(checks, options, left_out);
  return public_report(report, report.json()["passed"] == true);
}

Report device_report() {
  const ReportBuilder report = device_report(list_devices());
  const bool is_any_usable =
      std::ranges::any_of(report.json()["devices"], [](const auto& d) { return d["usable"] == true; });
  return public_report(report, is_any_usable);
}

}  // namespace dolp
