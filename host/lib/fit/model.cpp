#include "fit/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <ranges>
#include <set>
#include <string_view>
#include <utility>

#include "base/text.hpp"
#include "model/moments.hpp"
#include "run/scene_run.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_reader.hpp"

namespace dolp::fit {
namespace {

// Parameter sets that differ only in these keys become points of one list, which one call of the evaluator computes.
constexpr std::array<std::string_view, 7> kPointKeys = {"surface.n",
                                                        "surface.k",
                                                        "surface.sigma",
                                                        "surface.wind_m_s",
                                                        "surface.q",
                                                        "surface.sigma_cross",
                                                        "geometry.surface_azimuth_deg"};

bool is_point_key(const std::string& key) { return std::ranges::find(kPointKeys, key) != kPointKeys.end(); }

template <class ValueOf>
Eigen::VectorXd each(const std::vector<FitRange>& parameters, ValueOf range_value) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(parameters.size()));
  std::ranges::transform(parameters, values.begin(), range_value);
  return values;
}

Eigen::VectorXd start_values(const std::vector<FitRange>& parameters) {
  return each(parameters, [](const FitRange& range) { return range.start.value_or(range.at(0.5)); });
}

Eigen::RowVector2d observed_components(Observable observable, const PointResult& point) {
  const Eigen::RowVector2d q_u(point[Quantity::kStokesQ] / point[Quantity::kStokesI],
                               point[Quantity::kStokesU] / point[Quantity::kStokesI]);
  switch (observable) {
    case Observable::kDolp:  // at a zenith of 90 degrees, DOLP may be finite although Q/I is not
      return q_u.allFinite() ? q_u : Eigen::RowVector2d(point[Quantity::kDolp], 0.0);
    case Observable::kQOverI:
      return {q_u[0], 0.0};
    case Observable::kEmissivityS:
      return {point[Quantity::kEmissivityS], 0.0};
    case Observable::kEmissivityP:
      return {point[Quantity::kEmissivityP], 0.0};
  }
  return {};
}

EmissionModel other_bracket_end(const SceneValues& scene) {
  const std::string origin = "model error of the bracket: ";
  if (!scene.emission) throw InputError(origin + "needs the table [emission]");
  try {
    with_settings(scene, {{"emission.bracket", true}});
  } catch (const InputError& error) {
    throw InputError(origin + error.what());
  }
  return scene.emission->model == EmissionModel::kDirect ? EmissionModel::kMoments : EmissionModel::kDirect;
}

double observed_value(Observable observable, const Eigen::RowVector2d& components) {
  return observable == Observable::kDolp ? components.norm() : components[0];
}

/// The bracket of an observable: the range between `end` and `other`, NaN if one of them is. For DOLP these two are
/// values of Q/I, so the bracket is the range of the absolute value of Q/I between them.
std::pair<double, double> bracket(Observable observable, double end, double other) {
  if (std::isnan(end + other)) return {end + other, end + other};
  const auto [low, high] = std::minmax(end, other);
  if (observable != Observable::kDolp) return {low, high};
  return {std::max({low, -high, 0.0}), std::max(-low, high)};
}

bool is_polarisation(Observable observable) {
  return observable == Observable::kDolp || observable == Observable::kQOverI;
}

double point_error(Observable observable, const PointResult& point) {
  return is_polarisation(observable) ? point[Quantity::kErrorEstimate]
                                     : 2.0 * point[Quantity::kRhoErrorEstimate] * point[Quantity::kRhoI];
}

}  // namespace

Model::Model(const SceneValues& scene, std::vector<MeasuredData> data, std::vector<FitRange> parameters,
             ModelError error)
    : data_(std::move(data)), parameters_(std::move(parameters)), error_(error) {
  for (const MeasuredData& data_set : data_) count_ += data_set.measurements.size();
  check();
  data_scene(scene, data_.front(), {}, each(parameters_, &FitRange::low));
  data_scene(scene, data_.front(), {}, each(parameters_, &FitRange::high));
  Eigen::Index first_row = 0;
  for (const MeasuredData& measured : data_) {
    groups_.push_back(make_group(scene, measured, first_row));
    first_row += static_cast<Eigen::Index>(measured.measurements.size());
  }
}

void Model::check() const {
  if (data_.empty()) throw InputError("fit: no data; at least one set is needed");
  if (parameters_.empty()) throw InputError("fit: nothing varies; at least one parameter is needed");
  for (const auto& [key, low, high, start] : parameters_) {
    check_range({key, low, high, start}, key);
    if (std::ranges::count(parameters_, key, &FitRange::key) > 1)
      throw InputError(fmt::format("{}: varies twice", key));
    for (const MeasuredData& data_set : data_) {
      if (std::ranges::count(data_set.settings, key, &Setting::key) > 0)
        throw InputError(fmt::format("{}: {} is varied and cannot be fixed too", data_set.name, key));
    }
  }
  for (const MeasuredData& measured : data_) {
    if (measured.has_uncertainties == has_uncertainties()) continue;
    throw InputError(fmt::format("{}: column \"uncertainty\" is {}; all data sets have it, or none", measured.name,
                                 measured.has_uncertainties ? "there, and not in " + data_.front().name
                                                            : "missing, and " + data_.front().name + " has it"));
  }
  if (has_model_error() && !has_uncertainties()) {
    throw InputError(fmt::format("{}: a model error needs the column \"uncertainty\", which it is weighed against",
                                 data_.front().name));
  }
  if (parameters_.size() > count_) {
    throw InputError(fmt::format("fit: {} parameters and {} measured points; at most as many parameters as points",
                                 parameters_.size(), count_));
  }
}

Eigen::VectorXd Model::values(const Eigen::VectorXd& point) const {
  Eigen::Index j = 0;
  return each(parameters_, [&](const FitRange& range) { return range.at(point[j++]); });
}

std::vector<Setting> Model::settings(const Eigen::VectorXd& values) const {
  std::vector<Setting> settings;
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    const FitRange& range = parameters_[j];
    const double value = values[static_cast<Eigen::Index>(j)];
    settings.push_back({range.key, value, fmt::format("{} = {}, which varies", range.key, format_number(value))});
  }
  return settings;
}

SceneValues Model::data_scene(const SceneValues& scene, const MeasuredData& data, const std::vector<Setting>& extra,
                              const Eigen::VectorXd& values) const {
  std::vector<Setting> all = data.settings;
  for (const auto& more : {extra, settings(values)}) all.insert(all.end(), more.begin(), more.end());
  return with_settings(scene, all);
}

Model::Group Model::make_group(const SceneValues& scene, const MeasuredData& data, Eigen::Index first_row) const {
  Group group{.data = &data, .first_row = first_row};
  std::set<double> wavelengths;
  for (const Measurement& measurement : data.measurements) {
    if (measurement.wavelength_um) wavelengths.insert(*measurement.wavelength_um);
  }
  group.wavelength_um.assign(wavelengths.begin(), wavelengths.end());
  if (wavelengths.empty()) group.scene = data_scene(scene, data, {}, start_values(parameters_));
  const auto sets_spectrum = [](const Setting& setting) { return setting.key.starts_with("spectrum."); };
  if (!wavelengths.empty() && (std::ranges::any_of(data.settings, sets_spectrum) || varies("spectrum.wavelength_um"))) {
    throw InputError(data.name + ": column \"wavelength_um\" and a spectrum key contradict each other");
  }
  // Checks that the scene accepts the longest and the shortest wavelength. group.scene keeps the shortest.
  for (const double at_um : group.wavelength_um | std::views::reverse) {
    if (at_um != group.wavelength_um.back() && at_um != group.wavelength_um.front()) continue;
    const Setting wavelength{"spectrum.wavelength_um", at_um,
                             fmt::format("{}: wavelength_um = {}", data.name, format_number(at_um))};
    group.scene = data_scene(scene, data, {wavelength}, start_values(parameters_));
  }
  const std::shared_ptr<const Material>& tabulated = group.scene.surface.material.tabulated;
  for (const double at_um : group.wavelength_um)
    group.indices.push_back(tabulated ? tabulated->at(at_um) : OpticalConstants{});
  check_group(group);
  if (has_model_error()) group.other_end = other_bracket_end(group.scene);
  return group;
}

void Model::check_group(const Group& group) const {
  const MeasuredData& data = *group.data;
  const Surface& surface = group.scene.surface;
  const bool has_table = group.scene.source && group.scene.source->table;
  if (varies("spectrum.wavelength_um") && (!surface.material.is_constant() || surface.diffuse_table || has_table))
    throw InputError("spectrum.wavelength_um: to vary it needs n, k, k_d and a source that are constants of the scene");
  if (data.zenith_column == "theta_i_deg" && group.scene.geometry.mode != Mode::kBistatic)
    throw InputError(data.name + ": column \"theta_i_deg\" needs geometry.mode = \"bistatic\"");
  if (!is_polarisation(data.measurements.front().observable) && !group.scene.emission)
    throw InputError(data.name + ": emissivities need the table [emission] in the scene");
}

bool Model::varies(const std::string& key) const {
  return std::ranges::find(parameters_, key, &FitRange::key) != parameters_.end();
}

SceneValues Model::with(const SceneValues& scene, const Eigen::VectorXd& values) const {
  SceneValues varied = scene;
  for (std::size_t j = 0; j < parameters_.size(); ++j)
    find_scene_key(parameters_[j].key)->set(varied, values[static_cast<Eigen::Index>(j)]);
  follow_keys(varied);
  return varied;
}

std::vector<Prediction> Model::predict(const std::vector<Eigen::VectorXd>& values, double tolerance,
                                       ModelEvaluator& evaluator, const Progress& progress) const {
  const auto rows = static_cast<Eigen::Index>(observation_count());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(rows);
  std::vector<Prediction> predictions(
      values.size(), {Eigen::MatrixX2d::Zero(rows, 2), none, none, 0, Eigen::MatrixX3d::Zero(rows, 3)});
  std::map<std::vector<double>, std::vector<std::size_t>> calls;
  for (std::size_t set = 0; set < values.size(); ++set) {
    std::vector<double> common;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      if (!is_point_key(parameters_[j].key)) common.push_back(values[set][static_cast<Eigen::Index>(j)]);
    }
    calls[common].push_back(set);
  }
  for (const Group& group : groups_) {
    for (const auto& [common, sets] : calls) {
      std::vector<SceneEntry> points;
      for (const std::size_t set : sets) add_points(points, group, with(group.scene, values[set]));
      const SceneEntries entries(std::move(points), grid_variants(make_axes({}, {}, {}, group.wavelength_um)));
      SceneValues scene = with(group.scene, values[sets.back()]);
      scene.accuracy.tolerance = tolerance;
      const std::vector<PointResult> results = evaluate_scene(scene, entries, evaluator, progress);
      std::vector<PointResult> others;
      if (group.other_end) {
        scene.emission->model = *group.other_end;
        others = evaluate_scene(scene, entries, evaluator, progress);
      }
      const std::vector<Measurement>& measurements = group.data->measurements;
      for (std::size_t i = 0; i < results.size(); ++i) {
        const std::size_t member = i % measurements.size();
        const Measurement& measured = measurements[member];
        const Eigen::Index row = group.first_row + static_cast<Eigen::Index>(member);
        Prediction& prediction = predictions[sets[i / measurements.size()]];
        auto components = prediction.components.row(row);
        double& error = prediction.error[row];
        components = observed_components(measured.observable, results[i]);
        prediction.values[row] = observed_value(measured.observable, components);
        error = point_error(measured.observable, results[i]);
        prediction.status |= results[i].status;
        if (!group.other_end) continue;
        const auto [low, high] =
            bracket(measured.observable, components[0], observed_components(measured.observable, others[i])[0]);
        prediction.bracket.row(row) << prediction.values[row], low, high;
        components << (std::isnan(low) ? low : std::clamp(measured.value, low, high)), 0.0;
        prediction.values[row] = observed_value(measured.observable, components);
        error = std::max(error, point_error(measured.observable, others[i]));
        prediction.status |= others[i].status;
      }
    }
  }
  return predictions;
}

void Model::add_points(std::vector<SceneEntry>& points, const Group& group, const SceneValues& scene) const {
  const Surface& surface = scene.surface;
  for (const Measurement& measurement : group.data->measurements) {
    SceneEntry& point = points.emplace_back(
        SceneEntry{measurement.theta_deg, scene.cross_slopes().shape(surface.sigma, surface.q), {}});
    if (surface.material.is_constant()) point.index = surface.material.constant;
    if (!measurement.wavelength_um) continue;
    const auto position = std::ranges::lower_bound(group.wavelength_um, *measurement.wavelength_um);
    point.variant = static_cast<std::uint32_t>(position - group.wavelength_um.begin());
    if (!surface.material.tabulated) continue;
    if (!varies("surface.n")) point.index->n = group.indices[point.variant].n;
    if (!varies("surface.k")) point.index->k = group.indices[point.variant].k;
  }
}

}  // namespace dolp::fit
