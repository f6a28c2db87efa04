#include "run/scene_table.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <dolp/errors.hpp>
#include <iterator>
#include <set>
#include <span>

#include "base/hash.hpp"
#include "base/text.hpp"
#include "base/version.hpp"
#include "run/table_scene.hpp"
#include "scene/spectral_data.hpp"

namespace dolp {
namespace {

/// The material that a table stores. With an axis of wavelengths, it has all rows of the material file.
const Material& recorded_material(const Axes& axes, const SceneValues& scene) {
  const Material& material = scene.surface.material;
  return material.tabulated && !axes[Axis::kWavelength].empty() ? *material.tabulated : material;
}

void fill_curves(TableHead& head, const SceneValues& scene) {
  const std::vector<double> one_um = {scene.spectrum.min_um};
  const auto scene_curve = [&](const SpectralTable& tabulated, double constant) -> Curve {
    if (tabulated.wavelength_um.empty()) return {one_um, {constant}, {}};
    return {tabulated.wavelength_um, tabulated.value, {}};
  };
  const bool has_one_material =
      head.axes[Axis::kN].empty() && head.axes[Axis::kK].empty() && head.axes[Axis::kMaterial].empty();
  if (has_one_material && !scene.surface.reflectance) {
    const Material& material = recorded_material(head.axes, scene);
    head.index_n = scene_curve(material.n, material.constant.n);
    head.index_k = scene_curve(material.k, material.constant.k);
  }
  if (scene.source && !scene.source->relative_irradiance)
    head.irradiance =
        scene_curve(scene.source->table ? *scene.source->table : SpectralTable(), scene.source->irradiance);
  fill_used(head, scene);
}

/// The sky profile of the scene as text. Empty for a built-in sky, for which the table stores only the name.
std::string profile_text(const SceneValues& scene) {
  if (scene.names.profile.empty() || built_in_sky(scene.names.profile)) return {};
  if (scene.surroundings->profile) return scene.surroundings->profile->text();
  const double everywhere_K = scene.surroundings->temperature_K;
  return SkyProfile{.zenith_deg = {0.0, 90.0}, .values = {everywhere_K, everywhere_K}}.text();
}

std::string stokes_units(const SceneValues& scene) {
  std::string units = "W m-2";
  if (scene.geometry.mode == Mode::kBistatic) units += " sr-1";
  if (!scene.spectrum.is_band()) units += " um-1";
  return units;
}

std::uint64_t data_hash(const SceneValues& scene) {
  std::uint64_t hash = kHashStart;
  const auto add = [&hash](const SpectralTable& table) {
    hash = hashed(hashed(hash, std::span(table.wavelength_um)), std::span(table.value));
    hash =
        hashed(hashed(hash, static_cast<std::uint64_t>(table.formula.number)), std::span(table.formula.coefficients));
  };
  const Material& used = scene.surface.material;
  for (const Material* material : {&used, used.tabulated.get()}) {
    if (!material) continue;
    hash = hashed(hash, std::span<const double>(std::array{material->constant.n, material->constant.k}));
    add(material->n);
    add(material->k);
  }
  hash = hashed(hashed(hash, coating_text(scene, StoredRows::kAll)), reflectance_text(scene.surface));
  hash = hashed(hash, axis_materials_text(scene, StoredRows::kAll));
  if (scene.source) add(scene.source->table ? *scene.source->table : SpectralTable());
  for (const SpectralTable* table : {scene.spectrum.response.get(), scene.surface.diffuse_table.get()})
    if (table) add(*table);
  if (scene.surroundings && scene.surroundings->profile) hash = hashed(hash, scene.surroundings->profile->text());
  return hash;
}

}  // namespace

void fill_used(TableHead& head, const SceneValues& scene) {
  std::vector<double> wavelengths = head.axes[Axis::kWavelength];
  if (wavelengths.empty()) wavelengths = {scene.spectrum.min_um};
  const auto fill = [&](Curve& curve, const auto& value_at) {
    curve.used.clear();
    if (curve.values.empty() || (scene.spectrum.is_band() && curve.values.size() > 1)) return;
    std::ranges::transform(wavelengths, std::back_inserter(curve.used), value_at);
  };
  const Material& material = scene.surface.material;
  const auto index_at = [&](double wavelength_um) {
    return material.tabulated ? material.tabulated->at(wavelength_um) : material.constant;
  };
  fill(head.index_n, [&](double wavelength_um) { return index_at(wavelength_um).n; });
  fill(head.index_k, [&](double wavelength_um) { return index_at(wavelength_um).k; });
  if (!scene.source) return;
  fill(head.irradiance, [&](double wavelength_um) {
    return scene.source->table ? scene.source->table->at(wavelength_um) : scene.source->irradiance;
  });
}

std::string history_text(const std::string& command_line) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ} {}", fmt::gmtime(now), command_line);
}

std::vector<Attribute> RunRecord::attributes(const std::string& command_line) const {
  return {{"history", history_text(command_line)},
          {"device", evaluation.device},
          {"driver", evaluation.driver},
          {"evaluator", evaluation.evaluator},
          {"precision", evaluation.precision},
          {"effects", effects},
          {"rule", rule},
          {kModelChange, model_change.i},
          {kModelChangeDolp, model_change.dolp_points},
          {"self_check_entries", static_cast<double>(check.entries)},
          {"self_check_worst_ratio", check.worst_ratio},
          {"wall_time_s", wall_s}};
}

std::vector<Attribute> run_attributes(const SceneValues& scene, const RunOutcome& run,
                                      const std::string& command_line) {
  const RunRecord record{run.evaluation,
                         effects_text(run.effects, run.plan),
                         rule_text(scene.accuracy.tolerance, run.evaluation),
                         run.summary.model_change,
                         run.summary.check,
                         run.wall_s};
  return record.attributes(command_line);
}

std::string rule_text(double tolerance, const EvaluationReport& evaluation) {
  std::string text = fmt::format(
      "product Gauss rules on the smooth pieces of slope and azimuth, orders for tolerance {:g}, bounds from pairs "
      "of rules",
      tolerance);
  if (evaluation.interpolated > 0) {
    text += "; interpolated in ln(sigma) and ln(q - q0) between Chebyshev nodes, bounds from the last coefficients";
  }
  return text;
}

Quantities output_quantities(const SceneValues& scene, const EffectPlan* plan, const SceneEntries* entries) {
  const bool has_cross_slopes = scene.surface.has_cross_slopes() || (entries && entries->has_own_cross_slopes());
  const auto is_given = [&](QuantityNeeds needs) {
    switch (needs) {
      case QuantityNeeds::kNothing:
        return true;
      case QuantityNeeds::kReflectance:
        return plan == nullptr || plan->gives_rho;
      case QuantityNeeds::kMoments:
        return plan == nullptr || plan->gives_albedo;
      case QuantityNeeds::kEmission:
        return plan == nullptr ? scene.emission.has_value() : gives_emissivity(scene, *plan);
      case QuantityNeeds::kBracket:
        return scene.emission && scene.emission->has_bracket;
      case QuantityNeeds::kCrossSlopes:
        return has_cross_slopes && (plan == nullptr || plan->gives_rho);
    }
    return false;
  };
  Quantities given;
  for (const Quantity quantity : kAllQuantities) {
    if (is_given(describe(quantity).needs)) given.push_back(quantity);
  }
  return given;
}

TableLayout table_layout(const SceneValues& scene, const EffectPlan& plan, const Axes& axes) {
  TableLayout layout;
  TableHead& head = layout.head;
  head.axes = axes;
  head.labels = scene.labels;
  if (axes[Axis::kSigma] == scene.grid[Axis::kSigma]) head.wind_m_s = scene.wind_m_s;
  head.stokes_units = stokes_units(scene);
  fill_curves(head, scene);
  head.attributes = {{"title", scene.title},
                     {"source", "dolp " DOLP_VERSION},
                     {"references",
                      "W. Wang, Y. Li, L. Wang, Infrared Polarization Radiation Optimization Model Based on the Cauchy "
                      "Distribution, Infrared 46(8), 2025, doi:10.3969/j.issn.1672-8785.2025.08.004"},
                     {"scene", scene.text},
                     {"scene_path", scene.path_name},
                     {"scene_overrides", settings_text(scene.settings)},
                     {"scene_hash", scene_hash(scene)},
                     {"tolerance", scene.accuracy.tolerance}};
  const Dispersion& formula = recorded_material(axes, scene).n.formula;
  if (formula.number != 0 && !scene.materials) head.attributes.push_back({"index_n_formula", formula_text(formula)});
  const StoredRows rows = axes[Axis::kWavelength].empty() ? StoredRows::kOfSpectrum : StoredRows::kAll;
  const std::initializer_list<Attribute> data_attributes = {
      {"coating", coating_text(scene, rows)},
      {"materials", axis_materials_text(scene, rows)},
      {"reflectance", reflectance_text(scene.surface)},
      {"diffuse", spectral_text(scene.surface.diffuse_table.get(), "reflectance")},
      {"response", spectral_text(scene.spectrum.response.get(), "response")},
      {"surroundings_profile", profile_text(scene)}};
  std::ranges::copy_if(data_attributes, std::back_inserter(head.attributes),
                       [](const Attribute& data) { return !std::get<std::string>(data.value).empty(); });
  layout.quantities = output_quantities(scene, &plan);
  return layout;
}

TableLayout table_layout(const SceneValues& scene, const Run& run) {
  TableLayout layout = table_layout(scene, run.plan(), run.entries().axes());
  layout.derivatives = run.derivatives();
  if (!layout.derivatives.empty())
    layout.head.attributes.push_back({kDerivativeKeys, fmt::format("{}", fmt::join(run.derivative_keys(), ","))});
  return layout;
}

void choose_variables(TableLayout& layout, const std::vector<std::string>& names) {
  if (names.empty()) return;
  std::vector<std::string> allowed;
  for (const Quantity quantity : layout.quantities) allowed.emplace_back(describe(quantity).name);
  allowed.emplace_back(kStatusQualifier);
  for (const std::string& name : names) {
    if (std::ranges::find(allowed, name) == allowed.end())
      throw InputError(fmt::format("quantities: {}: must be one of {}", one_line(name), join(allowed)));
  }
  const auto is_chosen = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  std::erase_if(layout.quantities, [&](Quantity quantity) { return !is_chosen(describe(quantity).name); });
  layout.has_status = is_chosen(kStatusQualifier);
}

std::string run_identity(const SceneValues& scene, const std::string& evaluator, const RunOptions& options) {
  const std::set<std::string> names(options.quantities.begin(), options.quantities.end());
  return fmt::format(
      "program dolp {} ({}); evaluator {}; precision {}; keep_all {}; quantities {}; derivatives {}; scene {}; data "
      "fnv1a64:{:016x}",
      program_version(), program_commit(), evaluator, to_name(scene.accuracy.precision),
      options.keep_all ? "yes" : "no", names.empty() ? "all" : fmt::format("{}", fmt::join(names, ",")),
      options.derivatives.empty() ? "none" : fmt::format("{}", fmt::join(options.derivatives, ",")), scene_hash(scene),
      data_hash(scene));
}

ResultColumns run_columns(const Quantities& quantities, RunResults results) {
  const std::size_t size = results.size();
  ResultColumns columns{.status = std::move(results.status), .derivatives = std::move(results.derivatives)};
  for (const Quantity quantity : quantities) {
    columns[quantity] = std::move(results[quantity]);
    columns[quantity].resize(size, std::numeric_limits<double>::quiet_NaN());
  }
  return columns;
}

TableValues table_part(const TableLayout& layout, const SceneEntries& part, RunResults results) {
  TableValues table;
  table.axes = part.axes();
  table.labels = layout.head.labels;
  static_cast<ResultColumns&>(table) = run_columns(layout.quantities, std::move(results));
  if (!layout.has_status) table.status.clear();
  return table;
}

}  // namespace dolp
