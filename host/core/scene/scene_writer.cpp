#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <dolp/setting.hpp>
#include <map>

#include "base/text.hpp"
#include "scene/scene_document.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

bool names_file(const std::string& key, const std::string& value) {
  const bool is_file = key.ends_with("_file") || key == "source.file";
  return is_file || (key == "surroundings.profile" && !built_in_sky(value));
}

std::string path_from(const std::filesystem::path& folder, const std::string& file, const std::string& scene_path) {
  namespace fs = std::filesystem;
  if (fs::path(file).is_absolute()) return file;
  const fs::path found = fs::absolute(fs::path(scene_path).parent_path() / file).lexically_normal();
  return found.lexically_relative(fs::absolute(folder).lexically_normal()).string();
}

struct TextOf {
  std::string operator()(std::monostate) const { return "none"; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(double number) const { return number_text(number); }
  std::string operator()(const std::string& text) const { return toml_text(toml::value(text)); }
  std::string operator()(const std::vector<double>& numbers) const {
    std::vector<std::string> texts;
    std::ranges::transform(numbers, std::back_inserter(texts), number_text);
    return '[' + join(texts) + ']';
  }
  std::string operator()(const AxisRange& range) const {
    return fmt::format("{{ from = {}, to = {}, count = {}, spacing = \"{}\" }}", number_text(range.from),
                       number_text(range.to), range.count, range.is_logarithmic ? "log" : "linear");
  }
  std::string operator()(const TomlText& toml) const { return toml.text; }
};

}  // namespace

std::string scene_toml(const SceneValues& scene, const std::filesystem::path& folder) {
  const SceneDocument& document = *scene.document;
  std::string written;
  for (const Key& description : dolp::keys()) {
    if (description.key.find('.') != std::string::npos) continue;
    if (const toml::node* node = document.find(description.key)) {
      written += description.key + " = " + toml_text(*node) + '\n';
    }
  }
  std::map<std::size_t, std::string> layers;
  for (const std::string& table : scene_tables()) {
    if (!document.find(table)) continue;
    written += "\n[" + table + "]\n";
    for (const Key& description : dolp::keys()) {
      const toml::node* node = description.key.starts_with(table + '.') ? document.find(description.key) : nullptr;
      if (!node) continue;
      const std::string value =
          names_file(description.key, node->value_or(std::string()))
              ? toml_text(toml::value(path_from(folder, node->value_or(std::string()), scene.path_name)))
              : toml_text(*node);
      if (description.layer > 0) {
        std::string& layer = layers[description.layer];
        layer += (layer.empty() ? "" : ", ") + last_part(description.key) + " = " + value;
      } else {
        written += description.key.substr(table.size() + 1) + " = " + value + '\n';
      }
    }
    if (layers.empty()) continue;
    written += "coating = [";
    for (const auto& [number, layer] : layers) written += fmt::format("{}{{ {} }}", number == 1 ? "" : ", ", layer);
    written += "]\n";
    layers.clear();
  }
  return written;
}

std::string Value::text() const { return std::visit(TextOf{}, content_); }

Setting Setting::from_text(const std::string& argument, const std::string& option) {
  const std::string origin = (option.empty() ? "" : option + ' ') + one_line(argument);
  const std::size_t equals = argument.find('=');
  const std::string key(trim(std::string_view(argument).substr(0, equals)));
  if (equals == std::string::npos || std::ranges::any_of(split(key, '.'), &std::string_view::empty)) {
    throw InputError(origin + ": must be KEY=VALUE with a scene key, for example surface.masking=smith");
  }
  return {key, TomlText{std::string(trim(std::string_view(argument).substr(equals + 1)))}, origin};
}

std::string Setting::text() const {
  const bool is_removal = std::holds_alternative<std::monostate>(value.content());
  return key + '=' + (is_removal && !is_removed_by_none(key) ? "{}" : value.text());
}

std::vector<Setting> settings_from_text(const std::vector<std::string>& arguments, const std::string& option) {
  std::vector<Setting> settings;
  for (const std::string& argument : arguments) settings.push_back(Setting::from_text(argument, option));
  return settings;
}

}  // namespace dolp
