#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "api/impl.hpp"
#include "base/text.hpp"
#include "run/scene_remarks.hpp"
#include "run/table_scene.hpp"
#include "scene/embedded_data.hpp"
#include "scene/material_data.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_reader.hpp"
#include "table/table_reader.hpp"

namespace dolp {
namespace {

using Type = Key::Type;

std::optional<KeyValue> find_value(const SceneValues& scene, std::string_view key, std::initializer_list<Type> types) {
  const SceneKey* const known = find_scene_key(key);
  if (!known)
    throw InputError(fmt::format("{}: is no key of a scene; the nearest is {}", one_line(key), key_hint(key)));
  if (std::ranges::find(types, known->description.type) == types.end()) {
    throw InputError(fmt::format("{}: is {}", known->description.key, known->description.allowed()));
  }
  return known->value(scene);
}

/// Errors: InputError if `scene` is of a response table, whose material and radiation are arbitrary, unless it serves
/// for another response table: then `settings` contain surface_settings().
void check_has_material(const Scene& scene, const std::string& name, const std::vector<Setting>& settings) {
  if (std::ranges::find(scene.table_attributes(), "c0", &Attribute::name) == scene.table_attributes().end()) return;
  const auto is_given = [&](const Setting& placeholder) {
    return std::ranges::find(settings, placeholder.key, &Setting::key) != settings.end();
  };
  if (!std::ranges::all_of(surface_settings(), is_given)) {
    throw InputError(fmt::format(
        "{}: is a response table, which has no material and no radiation; give the file of a scene, or pass "
        "the table to dolp.moments",
        name));
  }
}

/// The values of the axes and keys that have one value and no dimension in the file of a part of a table. Errors:
/// InputError if a part has slopes that do not follow from its wind.
std::vector<Setting> lone_settings(const SceneValues& scene, const std::filesystem::path& path) {
  const std::vector<std::pair<std::string, double>> values = read_lone_values(path);
  const auto find = [&](std::string_view name) {
    return std::ranges::find(values, name, [](auto& v) { return v.first; });
  };
  const WindModel model = scene.surface.wind_model;
  const auto wind = find(kWind.column), sigma = find("sigma");
  if (wind == values.end() && sigma != values.end() && model == WindModel::kDirectional)
    throw InputError(path.string() + ": has a sigma without its wind_m_s, which gives the slopes along and across");
  if (wind != values.end() && sigma != values.end()) {
    constexpr double kRounding = 1e-6;  // a coordinate may have become single precision
    const double expected = sigma_in_wind(wind->second, model);
    if (!(std::abs(sigma->second - expected) <= kRounding * expected))
      throw InputError(fmt::format("{}: sigma = {:g} is not the sigma of wind_m_s = {:g}, as after interpolating",
                                   path.string(), sigma->second, wind->second));
  }
  std::vector<Setting> settings;
  for (const auto& [name, value] : values) {
    if (name == "sigma" && wind != values.end()) continue;
    const bool is_key = name.find('.') != std::string::npos;
    settings.push_back(is_key ? Setting{name, value} : Setting{"grid." + name, std::vector{value}});
  }
  return settings;
}

}  // namespace

Scene Scene::from_file(const std::filesystem::path& path, const std::vector<Setting>& settings) {
  if (path.extension() == ".nc" || is_table_file(path.string())) {
    const Scene scene = from_attributes(read_attributes(path), path.string());
    check_has_material(scene, path.string(), settings);
    const std::vector<Setting> lone = lone_settings(scene.impl_->scene, path);
    const Scene part = lone.empty() ? scene : scene.with(lone).for_points();
    return settings.empty() ? part : part.with(settings);
  }
  if (path.extension() == ".csv" || path.extension() == ".npy") check_may_hold_scene(path.string());
  return Scene(std::make_shared<const Impl>(Impl{read_scene(path.string(), settings)}));
}

Scene Scene::from_attributes(const std::vector<Attribute>& attributes, const std::string& name) {
  TableHead head;
  head.attributes = attributes;
  take_spectral_data(head, name);
  return Scene(std::make_shared<const Impl>(Impl{table_scene(head, name), attributes}));
}

Scene Scene::from_text(const std::string& text, const std::vector<Setting>& settings, const std::string& name) {
  return Scene(std::make_shared<const Impl>(Impl{parse_scene(text, name, settings)}));
}

Scene Scene::with(const std::vector<Setting>& settings) const {
  return Scene(std::make_shared<const Impl>(Impl{with_settings(impl_->scene, settings), impl_->table_attributes}));
}

Scene Scene::with_all(const std::vector<Setting>& settings) const {
  const SceneValues& scene = impl_->scene;
  return Scene(std::make_shared<const Impl>(
      Impl{parse_scene(scene.text, scene.path_name, settings, scene.known), impl_->table_attributes}));
}

Scene Scene::for_points() const {
  const SceneValues& scene = impl_->scene;
  std::vector<Setting> settings;
  for (const Axis axis : kAllAxes) {
    const std::string key = describe(axis).key;
    if (key.empty() || scene.grid[axis].size() != 1) continue;
    const bool is_wind = axis == Axis::kSigma && !scene.wind_m_s.empty();
    settings.push_back(is_wind ? Setting{kWind.key, scene.wind_m_s.front()} : Setting{key, scene.grid[axis].front()});
  }
  return with(settings);
}

Scene Scene::with_grid(const std::vector<Setting>& axes) const {
  std::vector<Setting> settings = axes;
  for (Setting& axis : settings) axis.key = "grid." + axis.key;
  return with(settings);
}

const std::string& Scene::title() const { return impl_->scene.title; }
const std::string& Scene::name() const { return impl_->scene.path_name; }
const std::string& Scene::text() const { return impl_->scene.text; }
const std::vector<Setting>& Scene::settings() const { return impl_->scene.settings; }
const std::vector<Attribute>& Scene::table_attributes() const { return impl_->table_attributes; }

std::string Scene::evaluator() const {
  TableHead head;
  head.attributes = impl_->table_attributes;
  const std::string* name = find_attribute<std::string>(head, "evaluator");
  return name ? *name : "vulkan";
}

std::string Scene::toml(const std::filesystem::path& folder) const {
  return scene_toml(impl_->scene, std::filesystem::absolute(folder));
}

std::optional<double> Scene::number(std::string_view key) const {
  const std::optional<KeyValue> value = find_value(impl_->scene, key, {Type::kNumber});
  return value ? std::optional(std::get<double>(*value)) : std::nullopt;
}

std::optional<std::string> Scene::word(std::string_view key) const {
  const std::optional<KeyValue> value = find_value(impl_->scene, key, {Type::kWord, Type::kText, Type::kFlag});
  if (!value) return std::nullopt;
  if (const bool* const flag = std::get_if<bool>(&*value)) return *flag ? "true" : "false";
  return std::get<std::string>(*value);
}

std::vector<double> Scene::numbers(std::string_view key) const {
  const std::optional<KeyValue> value = find_value(impl_->scene, key, {Type::kAxis, Type::kPair, Type::kPairs});
  return value ? std::get<std::vector<double>>(*value) : std::vector<double>{};
}

const AxisLabels& Scene::labels() const { return impl_->scene.labels; }

std::vector<std::string> Scene::remarks() const { return remarks_on(impl_->scene); }
std::string Scene::model_advice() const { return dolp::model_advice(impl_->scene); }

std::pair<double, double> Scene::refractive_index(double wavelength_um) const {
  const Material& used = impl_->scene.surface.material;
  const Material& material = used.tabulated ? *used.tabulated : used;
  if (!material.is_constant()) {
    const Spectrum range = known_range(material);
    if (wavelength_um < range.min_um || wavelength_um > range.max_um) {
      throw InputError(fmt::format("{} um: n and k of {} are known from {} to {} um", wavelength_um, material.name,
                                   range.min_um, range.max_um));
    }
  }
  const OpticalConstants index = material.at(wavelength_um);
  return {index.n, index.k};
}

double Scene::response(double wavelength_um) const {
  const Spectrum& spectrum = impl_->scene.spectrum;
  const bool is_inside = wavelength_um >= spectrum.min_um && wavelength_um <= spectrum.max_um;
  return is_inside ? spectrum.weight(wavelength_um) : 0.0;
}

std::string example_scene() { return std::string(embedded_stainless_steel_toml()); }

}  // namespace dolp
