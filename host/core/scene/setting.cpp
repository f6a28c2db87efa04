#include <fmt/format.h>

#include <algorithm>
#include <dolp/setting.hpp>
#include <sstream>
#include <type_traits>

#include <toml++/toml.h>

#include "base/text.hpp"
#include "scene/scene_keys.hpp"

namespace dolp {
namespace {

std::string list_text(const std::vector<double>& numbers) {
  std::string text = "[";
  for (const double number : numbers) {
    if (text.size() > 1) text += ", ";
    append_number(text, number);
  }
  return text + ']';
}

std::string quoted(const std::string& text) {
  std::ostringstream stream;
  stream << toml::value(text);
  return stream.str();
}

struct TextOf {
  std::string operator()(std::monostate) const { return "none"; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(double number) const { return number_text(number); }
  std::string operator()(const std::string& text) const { return quoted(text); }
  std::string operator()(const std::vector<double>& numbers) const { return list_text(numbers); }
  std::string operator()(const AxisRange& range) const {
    return fmt::format("{{ from = {}, to = {}, count = {}, spacing = \"{}\" }}", number_text(range.from),
                       number_text(range.to), range.count, range.is_logarithmic ? "log" : "linear");
  }
  std::string operator()(const TomlText& toml) const { return toml.text; }
};

}  // namespace

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
