#include "explore/toml_file.hpp"

#include <fmt/format.h>

#include <dolp/errors.hpp>

#include "base/text.hpp"

namespace dolp::explore {

toml::table read_toml(const std::string& path) {
  const std::string text = read_named_file(path, path + ": ");
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}: {}", path, error.source().begin.line, one_line(error.description())));
  }
}

std::vector<std::string> texts_in(toml::node_view<const toml::node> node) {
  std::vector<std::string> texts;
  const toml::array* const array = node.as_array();
  if (!array) return texts;
  for (const toml::node& one : *array) {
    if (const auto text = one.value<std::string>()) texts.push_back(*text);
  }
  return texts;
}

toml::array array_of(const std::vector<std::string>& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

}  // namespace dolp::explore
