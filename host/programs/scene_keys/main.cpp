// Prints the table of the scene keys as Markdown, for host/core/scene/README.md.
#include <fmt/format.h>

#include <string>

#include "scene/scene_reader.hpp"

namespace {

using dolp::KeyDescription;

std::string values(const KeyDescription& key) {
  switch (key.type) {
    case KeyDescription::Type::kNumber:
      return key.range.text();
    case KeyDescription::Type::kWord:
      return fmt::format("`{}`", fmt::join(key.words, "`, `"));
    case KeyDescription::Type::kFlag:
      return "`true`, `false`";
    case KeyDescription::Type::kText:
      return "text";
    case KeyDescription::Type::kPair:
      return "two of " + key.range.text();
    case KeyDescription::Type::kAxis:
      return "axis in " + key.range.text();
  }
  return {};
}

std::string code_or_dash(const std::string& text) { return text.empty() ? "—" : "`" + text + "`"; }

}  // namespace

int main() {
  fmt::print("| key | unit | values | default | meaning |\n|---|---|---|---|---|\n");
  for (const KeyDescription& key : dolp::scene_keys()) {
    const std::string fallback = key.fallback == "required" ? key.fallback : code_or_dash(key.fallback);
    fmt::print("| `{}` | {} | {} | {} | {} |\n", key.key, key.unit, values(key), fallback, key.meaning);
  }
}
