#include "explore/sky_pair.hpp"

#include <cstdlib>
#include <fstream>
#include <system_error>
#include <vector>

#include "base/text.hpp"

namespace dolp::explore {
namespace {

constexpr const char* kHeader = "zenith_deg,temperature_K";

/// The temperature of the row at a zenith.
std::optional<double> temperature_of(std::string_view row, std::string_view zenith_deg) {
  const std::vector<std::string_view> cells = split(row, ',');
  return cells.size() == 2 && cells[0] == zenith_deg ? parse_number(cells[1]) : std::nullopt;
}

}  // namespace

std::string SkyPair::csv() const {
  return std::string(kHeader) + "\n0," + format_number(zenith_K) + "\n90," + format_number(horizon_K) + '\n';
}

std::optional<SkyPair> read_sky_pair(const std::filesystem::path& file) {
  const std::string text = read_named_file(file.string(), "");
  const std::vector<std::string_view> lines = split_lines(text);
  if (lines.size() != 3 || lines[0] != kHeader) return std::nullopt;
  const std::optional<double> zenith_K = temperature_of(lines[1], "0");
  const std::optional<double> horizon_K = temperature_of(lines[2], "90");
  return zenith_K && horizon_K ? std::optional(SkyPair{*zenith_K, *horizon_K}) : std::nullopt;
}

std::filesystem::path sky_file(const Scene& scene) {
  const std::string name = scene.word("surroundings.profile").value_or("");
  if (name.empty() || name == "clear-sky" || name == "overcast") return {};
  return std::filesystem::path(scene.name()).parent_path() / name;
}

SkyFiles::~SkyFiles() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::string SkyFiles::path(const SkyPair& sky) {
  if (folder_.empty()) {
    std::string name = (std::filesystem::temp_directory_path() / "dolp-skies-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw InputError(name + ": the folder cannot be made");
    folder_ = name;
  }
  const std::filesystem::path file =
      folder_ / ("sky_" + format_number(sky.zenith_K) + "_" + format_number(sky.horizon_K) + ".csv");
  if (!std::filesystem::exists(file)) std::ofstream(file) << sky.csv();
  return file.string();
}

}  // namespace dolp::explore
