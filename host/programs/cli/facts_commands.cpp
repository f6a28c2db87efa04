#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <dolp/errors.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/text.hpp"
#include "cli/commands.hpp"
#include "terminal/terminal.hpp"

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

/// The scene key that `wanted` means or, if none is known, the most similar one: "surface.q" for "q". Empty if more
/// than half of the letters differ.
std::string near_key(const std::string& wanted, const std::vector<std::string>& names) {
  if (const std::optional<KeyHint> meant = key_by_meaning(wanted)) return meant->text();
  const auto distance = [&](const std::string& name) {
    return std::min(edit_distance(wanted, name), edit_distance(wanted, name.substr(name.find('.') + 1)));
  };
  const std::string& near = *std::ranges::min_element(names, {}, distance);
  return 2 * distance(near) <= wanted.size() ? near : "";
}

int finish_list(Report report, const char* name, const Json& list, const Options& options) {
  report.json = Json{{name, list}}.dump(2, ' ', true);
  return finish(report, options);
}

/// The wavelengths in um that the argument of --at means: "UM", "FROM:TO" or "FROM:TO:COUNT". Errors: InputError.
std::vector<double> parse_wavelengths(const std::string& text) {
  constexpr double kDefaultCount = 11.0;
  constexpr double kMost = 1e6;
  std::vector<double> numbers;
  for (const std::string_view piece : split(text, ':')) numbers.push_back(parse_number(piece).value_or(0.0));
  if (numbers.size() == 2) numbers.push_back(kDefaultCount);
  const bool is_range = numbers.size() == 3 && numbers[0] > 0.0 && numbers[0] < numbers[1] && numbers[2] >= 2.0 &&
                        numbers[2] <= kMost && numbers[2] == std::floor(numbers[2]);
  if (numbers.size() == 1 && numbers[0] > 0.0) return numbers;
  if (!is_range)
    throw InputError(one_line("--at " + text) +
                     ": must be UM, FROM:TO or FROM:TO:COUNT, with FROM below TO and a COUNT from 2 to 1000000 (11)");
  std::vector<double> wavelengths;
  for (double i = 0.0; i < numbers[2]; ++i)
    wavelengths.push_back(std::lerp(numbers[0], numbers[1], i / (numbers[2] - 1.0)));
  return wavelengths;
}

int show_material(const Options& options) {
  const std::vector<double> wavelengths = parse_wavelengths(options.wavelength_um);
  const auto [name, from_um, to_um, source, kind] = material(options.material);
  if (wavelengths.front() < from_um || wavelengths.back() > to_um) {
    throw InputError(
        fmt::format("--at {}: {} is known from {} to {} um", one_line(options.wavelength_um), name, from_um, to_um));
  }
  const Scene scene =
      Scene::from_text(example_scene(), {{"surface.material", name}, {"spectrum.wavelength_um", from_um}}, "materials");
  Report report;
  std::vector<double> n, k;
  for (const double wavelength_um : wavelengths) {
    const auto [own_n, own_k] = scene.refractive_index(wavelength_um);
    report.text += fmt::format("{} at {:.10g} um: n = {:.10g}, k = {:.10g}\n", name, wavelength_um, own_n, own_k);
    n.push_back(own_n);
    k.push_back(own_k);
  }
  report.text += fmt::format("    {}\n", source);
  const auto json = [](const std::vector<double>& values) {
    return values.size() == 1 ? Json(values[0]) : Json(values);
  };
  report.json =
      Json{{"name", name}, {"wavelength_um", json(wavelengths)}, {"n", json(n)}, {"k", json(k)}, {"source", source},
           {"kind", kind}}
          .dump(2, ' ', true);
  return finish(report, options);
}

int show_all_materials(const Options& options) {
  const std::vector<double> wavelengths = parse_wavelengths(options.wavelength_um);
  if (wavelengths.size() != 1)
    throw InputError(
        fmt::format("--at {}: give one wavelength, or the name of a material", one_line(options.wavelength_um)));
  const double at_um = wavelengths.front();
  Report report;
  Json list = Json::array();
  for (const BuiltInMaterial& material : materials()) {
    if (at_um < material.from_um || at_um > material.to_um) continue;
    const Scene scene = Scene::from_text(
        example_scene(), {{"surface.material", material.name}, {"spectrum.wavelength_um", at_um}}, "materials");
    const auto [n, k] = scene.refractive_index(at_um);
    report.text += fmt::format("{:<46}  n = {:<10.6g}  k = {:<10.6g}\n", material.name, n, k);
    list.push_back({{"name", material.name}, {"n", n}, {"k", k}});
  }
  if (list.empty())
    throw InputError(fmt::format("--at {}: no material is known there", one_line(options.wavelength_um)));
  return finish_list(report, "materials", list, options);
}

}  // namespace

int run_keys(const Options& options) {
  Report report;
  Json list = Json::array();
  std::vector<std::string> names;
  for (const Key& key : dolp::keys()) {
    names.push_back(key.key);
    const bool is_further_layer = key.layer > 1;  // every film has the same keys; the full list has them once
    const bool is_wanted = (options.key.empty() && !is_further_layer) || key.key == options.key ||
                           (!options.key.empty() && key.key.starts_with(options.key + "."));
    if (is_wanted) add_key(report, list, key);
  }
  if (list.empty()) {
    const std::string near = near_key(options.key, names);
    throw InputError(fmt::format("{}: is no key of a scene; {}", one_line(options.key),
                                 near.empty() ? "dolp keys lists all" : "the nearest is " + near));
  }
  return finish_list(report, "keys", list, options);
}

int run_materials(const Options& options) {
  const bool is_one = !options.material.empty();
  if (!options.wavelength_um.empty()) return is_one ? show_material(options) : show_all_materials(options);
  const std::string wanted = is_one ? material(options.material).name : "";
  Report report;
  Json list = Json::array();
  for (const BuiltInMaterial& material : materials()) {
    if (is_one && material.name != wanted) continue;
    report.text += fmt::format("{:<46}  {:>7} to {:<8} um  {}\n", material.name, material.from_um, material.to_um,
                               material.source);
    list.push_back({{"name", material.name},
                    {"from_um", material.from_um},
                    {"to_um", material.to_um},
                    {"source", material.source},
                    {"kind", material.kind}});
  }
  return finish_list(report, "materials", list, options);
}

int run_devices(const Options& options) {
  const Report report = device_report();
  print(report, options);
  require_device(options.device);
  if (!report.is_good) throw DeviceError("no Vulkan device is usable; the report says why");
  return kExitDone;
}

}  // namespace dolp::cli
