#include "explore/preferences.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <dolp/errors.hpp>
#include <sstream>

#include "base/atomic_file.hpp"
#include "explore/toml_file.hpp"

namespace dolp::explore {

std::filesystem::path Preferences::default_path() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  if (config && *config != '\0') return std::filesystem::path(config) / "dolp/window.toml";
  return home && *home != '\0' ? std::filesystem::path(home) / ".config/dolp/window.toml" : "";
}

void Preferences::load(const std::filesystem::path& path) {
  path_ = path;
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return;
  const toml::table table = read_toml(path.string());
  is_light = table["light"].value_or(false);
  zoom_by(table["zoom"].value_or(0));
  recent_ = texts_in(table["recent"]);
}

void Preferences::save() const {
  if (path_.empty()) return;
  std::error_code failure;
  std::filesystem::create_directories(path_.parent_path(), failure);
  if (failure) throw IoError(path_.parent_path().string() + ": " + failure.message());
  std::ostringstream text;
  text << toml::table{{"light", is_light}, {"zoom", zoom_steps_}, {"recent", array_of(recent())}} << '\n';
  write_text_atomically(path_, text.str());
}

double Preferences::zoom() const {
  constexpr double kStep = 1.1;
  return std::pow(kStep, zoom_steps_);
}

void Preferences::zoom_by(int steps) {
  constexpr int kMostSteps = 8;  // twice the size, or half of it
  zoom_steps_ = std::clamp(zoom_steps_ + std::clamp(steps, -2 * kMostSteps, 2 * kMostSteps), -kMostSteps, kMostSteps);
}

void Preferences::remember(const std::filesystem::path& file) {
  const std::string path = std::filesystem::absolute(file).lexically_normal().string();
  std::erase(recent_, path);
  recent_.insert(recent_.begin(), path);
  recent_.resize(std::min(recent_.size(), kMostRecent));
}

std::vector<std::string> Preferences::recent() const {
  std::vector<std::string> found;
  std::error_code unknown;
  std::ranges::copy_if(recent_, std::back_inserter(found),
                       [&](const std::string& path) { return std::filesystem::exists(path, unknown); });
  return found;
}

}  // namespace dolp::explore
