#include "run/run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <sstream>
#include <vector>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

constexpr std::size_t kSummaryEntriesAtOnce = 65536;  // of a thread

using Range = std::pair<double, double>;

void widen(Range& range, bool is_first, const Range& by) {
  range.first = is_first ? by.first : std::min(range.first, by.first);
  range.second = is_first ? by.second : std::max(range.second, by.second);
}

void add_range(EnergyRange& range, const EnergyRange& other) {
  if (other.entries == 0) return;
  widen(range.theta_deg, range.entries == 0, other.theta_deg);
  widen(range.sigma, range.entries == 0, other.sigma);
  range.entries += other.entries;
}

void raise(std::optional<double>& worst, const std::optional<double>& error) {
  if (error) worst = std::max(worst.value_or(0.0), *error);
}

void add_result(RunSummary& summary, double theta_deg, double sigma, const PointResult& result) {
  for (std::size_t bit = 0; bit < kStatusBits.size(); ++bit)
    summary.status[bit] += (result.status & kStatusBits[bit].mask) != 0 ? 1 : 0;
  if ((result.status & kNoDolpPromised) == 0) raise(summary.worst_error, result[Quantity::kErrorEstimate]);
  if ((result.status & kOutsideModelDomain) == 0) raise(summary.worst_rho_error, result[Quantity::kRhoErrorEstimate]);
  if (promises_dolp(result.status)) summary.model_change = std::max(summary.model_change, result.model_change);
  if (std::isnan(result[Quantity::kAlbedo])) return;
  widen(summary.albedo, summary.albedos++ == 0, {result[Quantity::kAlbedo], result[Quantity::kAlbedo]});
  const EnergyRange here{1, {theta_deg, theta_deg}, {sigma, sigma}};
  if (result[Quantity::kAlbedo] < kAlbedoMin) add_range(summary.loses, here);
  if (result[Quantity::kAlbedo] > kAlbedoMax) add_range(summary.gains, here);
}

}  // namespace

void RunSummary::add(const SceneValues& scene, const SceneEntries& part, std::span<const PointResult> results) {
  const bool bistatic = scene.geometry.mode == Mode::kBistatic;
  std::vector<RunSummary> of_ranges((results.size() + kSummaryEntriesAtOnce - 1) / kSummaryEntriesAtOnce);
  parallel_ranges(results.size(), kSummaryEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    RunSummary& own = of_ranges[first / kSummaryEntriesAtOnce];
    own.entries = last - first;
    for (std::size_t i = first; i < last; ++i) {
      const SceneEntry entry = part[i];
      add_result(own, bistatic ? scene.geometry.view_zenith_deg : entry.theta_deg, entry.shape.sigma, results[i]);
    }
  });
  for (const RunSummary& own : of_ranges) add(own);
}

void RunSummary::add(const RunSummary& other) {
  entries += other.entries;
  for (std::size_t bit = 0; bit < status.size(); ++bit) status[bit] += other.status[bit];
  raise(worst_error, other.worst_error);
  raise(worst_rho_error, other.worst_rho_error);
  if (other.albedos > 0) widen(albedo, albedos == 0, other.albedo);
  albedos += other.albedos;
  add_range(loses, other.loses);
  add_range(gains, other.gains);
  model_change = std::max(model_change, other.model_change);
  check.add(other.check);
  radiometry_s += other.radiometry_s;
  work += other.work;
}

std::size_t RunSummary::count(std::uint32_t bit) const {
  return status[static_cast<std::size_t>(std::ranges::find(kStatusBits, bit, &StatusBit::mask) - kStatusBits.begin())];
}

std::string RunSummary::text() const {
  const auto range = [](const EnergyRange& r) {
    return fmt::format("{} {} {} {} {}", r.entries, r.theta_deg.first, r.theta_deg.second, r.sigma.first,
                       r.sigma.second);
  };
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", entries, fmt::join(status, " "),
                     worst_error.value_or(-1.0), worst_rho_error.value_or(-1.0), albedos, albedo.first, albedo.second,
                     range(loses), range(gains), model_change, check.entries, check.worst_ratio, radiometry_s,
                     work.evaluations, work.kernel_s, work.sums_s, work.dispatches, work.interpolated,
                     work.interpolation_nodes, "end");
}

std::optional<RunSummary> RunSummary::from_text(const std::string& text) {
  RunSummary summary;
  std::istringstream words(text);
  std::string word;
  const auto number = [&] {
    words >> word;
    return std::strtod(word.c_str(), nullptr);  // inf too
  };
  const auto range = [&](EnergyRange& r) {
    words >> r.entries;
    r.theta_deg = {number(), 0.0};
    r.theta_deg.second = number();
    r.sigma.first = number();
    r.sigma.second = number();
  };
  words >> summary.entries;
  for (std::size_t& count : summary.status) words >> count;
  for (std::optional<double>* worst : {&summary.worst_error, &summary.worst_rho_error}) {
    const double value = number();
    if (value >= 0.0) *worst = value;
  }
  words >> summary.albedos;
  summary.albedo.first = number();
  summary.albedo.second = number();
  range(summary.loses);
  range(summary.gains);
  summary.model_change = number();
  words >> summary.check.entries;
  summary.check.worst_ratio = number();
  summary.radiometry_s = number();
  summary.work.evaluations = number();
  summary.work.kernel_s = number();
  summary.work.sums_s = number();
  words >> summary.work.dispatches >> summary.work.interpolated >> summary.work.interpolation_nodes >> word;
  if (!words || word != "end") return std::nullopt;
  return summary;
}

}  // namespace dolp
