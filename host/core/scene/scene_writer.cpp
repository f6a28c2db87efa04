#include "scene/scene_writer.hpp"

#include <fmt/format.h>

#include <map>
#include <sstream>

#include "base/text.hpp"
#include "scene/scene_document.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_reader.hpp"

namespace dolp {
namespace {

template <class Value>
std::string formatted(const Value& value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

/// A value in one line.
std::string value_text(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return format_number(number->get());
  std::string text;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) text += (text.empty() ? "" : ", ") + value_text(element);
    return '[' + text + ']';
  }
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, inner] : *table) {
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name.str(), value_text(inner));
    }
    return "{ " + text + " }";
  }
  if (const auto* word = node.as_string()) return formatted(*word);
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  return formatted(*node.as_integer());
}

/// True if a key's value is the name of a file.
bool names_file(const std::string& key, const std::string& value) {
  return key.ends_with("material_file") || key == "surface.reflectance_file" || key == "source.file" ||
         (key == "surroundings.profile" && !built_in_sky(value));
}

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// Path from `folder` to a file that a scene names.
std::string path_from(const std::filesystem::path& folder, const std::string& file, const std::string& scene_path) {
  namespace fs = std::filesystem;
  if (fs::path(file).is_absolute()) return file;
  const fs::path found = fs::absolute(fs::path(scene_path).parent_path() / file).lexically_normal();
  return found.lexically_relative(fs::absolute(folder).lexically_normal()).string();
}

}  // namespace

std::string scene_toml(const SceneValues& scene, const std::filesystem::path& folder) {
  const SceneDocument& document = *scene.document;
  std::string written;
  for (const Key& description : dolp::keys()) {
    if (description.key.find('.') != std::string::npos) continue;
    if (const toml::node* node = document.find(description.key)) {
      written += description.key + " = " + value_text(*node) + '\n';
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
              ? formatted(toml::value(path_from(folder, node->value_or(std::string()), scene.path_name)))
              : value_text(*node);
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

}  // namespace dolp
