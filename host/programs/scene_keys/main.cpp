// Prints the table of scene keys as Markdown, for host/core/scene/README.md.
#include <fmt/format.h>

#include <string>

#include "scene/scene_reader.hpp"

namespace {

using dolp::Key;

std::string values(const Key& key) {
  switch (key.type) {
    case Key::Type::kNumber:
      return key.range.text();
    case Key::Type::kWord:
      return fmt::format("`{}`", fmt::join(key.words, "`, `"));
    case Key::Type::kFlag:
      return "`true`, `false`";
    case Key::Type::kText:
      return "text";
    case Key::Type::kPair:
      return "two of " + key.range.text();
    case Key::Type::kNames:
      return "texts";
    case Key::Type::kPairs:
      return "pairs in " + key.range.text();
    case Key::Type::kAxis:
      return "axis in " + key.range.text();
  }
  return {};
}

std::string code_or_dash(const std::string& text) { return text.empty() ? "—" : "`" + text + "`"; }

}  // namespace

int main() {
  fmt::print("| key | unit | values | default | meaning |\n|---|---|---|---|---|\n");
  for (const Key& key : dolp::keys()) {
    if (key.layer > 1) continue;  // later layers have the keys of the first
    const std::string fallback = key.fallback == "required" ? key.fallback : code_or_dash(key.fallback);
    fmt::print("| `{}` | {} | {} | {} | {} |\n", key.key, key.unit, values(key), fallback, key.meaning);
  }
}
