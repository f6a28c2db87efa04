// Commands that list keys, materials and devices, and print the plan of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <dolp/errors.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/text.hpp"
#include "cli/commands.hpp"

namespace dolp::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string default_text(const Key& key) {
  if (key.fallback.empty()) return "absent when not given";
  return key.fallback == "required" ? "required" : "default " + key.fallback;
}

void add_key(Report& report, Json& list, const Key& key) {
  const bool has_unit = !key.unit.empty() && key.unit != "1";
  report.text += fmt::format("{}\n    {}\n    {}{}; {}\n", key.key, key.meaning, key.allowed(),
                             has_unit ? ", " + key.unit : "", default_text(key));
  list.push_back({{"key", key.key},
                  {"meaning", key.meaning},
                  {"unit", key.unit},
                  {"allowed", key.allowed()},
                  {"default", key.fallback}});
}

int finish_list(Report report, const char* name, const Json& list, const Options& options) {
  report.json = Json{{name, list}}.dump(2, ' ', true);
  return finish(report, options);
}

/// n and k of one material, as a scene with it has them.
int show_material(const Options& options) {
  Setting wavelength = Setting::from_text("spectrum.wavelength_um=" + options.wavelength_um);
  wavelength.origin = one_line("--at " + options.wavelength_um);
  const Scene scene = Scene::from_text(
      example_scene(), {{"surface.material", options.material, one_line(options.material)}, wavelength}, "materials");
  const std::string name = scene.word("surface.material").value();
  const std::vector<BuiltInMaterial> known = materials();
  const std::string& source = std::ranges::find(known, name, &BuiltInMaterial::name)->source;
  const double wavelength_um = scene.number("spectrum.wavelength_um").value();
  const auto [n, k] = scene.refractive_index(wavelength_um);
  Report report;
  report.text = fmt::format("{} at {} um: n = {}, k = {}\n    {}\n", name, wavelength_um, n, k, source);
  report.json =
      Json{{"name", name}, {"wavelength_um", wavelength_um}, {"n", n}, {"k", k}, {"source", source}}.dump(2, ' ', true);
  return finish(report, options);
}

}  // namespace

int run_keys(const Options& options) {
  Report report;
  Json list = Json::array();
  std::vector<std::string> names;
  for (const Key& key : dolp::keys()) {
    names.push_back(key.key);
    const bool is_wanted = options.key.empty() || key.key == options.key || key.key.starts_with(options.key + ".");
    if (is_wanted) add_key(report, list, key);
  }
  if (list.empty()) {
    throw InputError(fmt::format("{}: is no key of a scene; the nearest is {}", one_line(options.key),
                                 nearest_name(options.key, names)));
  }
  return finish_list(report, "keys", list, options);
}

int run_materials(const Options& options) {
  if (!options.material.empty()) return show_material(options);
  Report report;
  Json list = Json::array();
  for (const BuiltInMaterial& material : materials()) {
    report.text += fmt::format("{:<46}  {:>7} to {:<8} um  {}\n", material.name, material.from_um, material.to_um,
                               material.source);
    list.push_back({{"name", material.name},
                    {"from_um", material.from_um},
                    {"to_um", material.to_um},
                    {"source", material.source}});
  }
  return finish_list(report, "materials", list, options);
}

int run_devices(const Options& options) {
  const int status = finish(device_report(), options);
  require_device(options.device);
  return status;
}

int run_plan(const Options& options) {
  return finish(plan(load_scene(options), options.device, options.keep_all), options);
}

}  // namespace dolp::cli
