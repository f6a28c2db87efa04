#include "explore/sky_pair.hpp"

#include <fstream>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kHeader = "zenith_deg,temperature_K";

}  // namespace

std::string SkyPair::csv() const {
  return std::string(kHeader) + "\n0," + format_number(zenith_K) + "\n90," + format_number(horizon_K) + '\n';
}

std::optional<SkyPair> read_sky_pair(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string header, zenith, horizon, more;
  std::getline(file, header) && std::getline(file, zenith) && std::getline(file, horizon);
  if (header != kHeader || !zenith.starts_with("0,") || !horizon.starts_with("90,") || std::getline(file, more))
    return std::nullopt;
  const std::optional<double> zenith_K = parse_number(zenith.substr(2));
  const std::optional<double> horizon_K = parse_number(horizon.substr(3));
  return zenith_K && horizon_K ? std::optional(SkyPair{*zenith_K, *horizon_K}) : std::nullopt;
}

std::filesystem::path sky_file(const Scene& scene) {
  const std::string name = scene.word("surroundings.profile").value_or("");
  if (name.empty() || name == "clear-sky" || name == "overcast") return {};
  return std::filesystem::path(scene.name()).parent_path() / name;
}

std::string SkyFiles::path(const SkyPair& sky) {
  constexpr const char* kName = "dolp-skies";
  try {
    if (!folder_) folder_.emplace(kName);
  } catch (const IoError&) {
    return kName;
  }
  const std::filesystem::path file =
      folder_->path() / ("sky_" + format_number(sky.zenith_K) + "_" + format_number(sky.horizon_K) + ".csv");
  if (!std::filesystem::exists(file)) std::ofstream(file) << sky.csv();
  return file.string();
}

}  // namespace dolp::explore
