#include "run/run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <sstream>

#include "base/parallel_ranges.hpp"

namespace dolp {
namespace {

constexpr std::size_t kMostChecked = 64;
// The check computes kMostChecked moments again, and kMostChecked more for each kManyMoments moments of the table.
constexpr std::size_t kManyMoments = std::size_t{1} << 22U;
// The check may take 1 / kShare of the run. A checked moment is assumed to take as long as kCostOfOne others.
constexpr std::size_t kShare = 50;
constexpr std::size_t kCostOfOne = 4;
constexpr double kPointsInAll = 100.0;  // percentage points of DOLP = 1

double ratio(double difference, double bounds) {
  if (!(std::abs(difference) > 0.0)) return 0.0;  // equal values, or NaN
  return std::abs(difference) / bounds;
}

double rho_bound(const PointResult& result) {
  return result[Quantity::kRhoErrorEstimate] * std::abs(result[Quantity::kRhoI]);
}

constexpr std::size_t kSummaryEntriesAtOnce = 65536;

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

template <class Summary, class Use>
void for_each_number(Summary& s, const Use& use) {
  use(s.entries);
  for (auto& count : s.status) use(count);
  use(s.worst_error);
  use(s.worst_rho_error);
  use(s.albedos);
  use(s.albedo.first);
  use(s.albedo.second);
  for (auto* range : {&s.loses, &s.gains}) {
    use(range->entries);
    for (auto* ends : {&range->theta_deg, &range->sigma}) use(ends->first), use(ends->second);
  }
  use(s.model_change.i);
  use(s.model_change.dolp_points);
  use(s.model_change.status);
  use(s.check.entries);
  use(s.check.worst_ratio);
  use(s.work.evaluations);
  for (auto* number : {&s.work.dispatches, &s.work.interpolated, &s.work.interpolation_nodes}) use(*number);
}

void raise(std::optional<double>& worst, const std::optional<double>& error) {
  if (error) worst = std::max(worst.value_or(0.0), *error);
}

void add_result(RunSummary& summary, const RunResults& results, std::size_t i) {
  const std::uint32_t status = results.status[i];
  for (std::size_t bit = 0; status != 0 && bit < kStatusBits.size(); ++bit)
    summary.status[bit] += (status & kStatusBits[bit].mask) != 0 ? 1 : 0;
  if ((status & kNoDolpPromised) == 0) raise(summary.worst_error, results[Quantity::kErrorEstimate][i]);
  const std::vector<double>& rho_errors = results[Quantity::kRhoErrorEstimate];
  if ((status & kOutsideModelDomain) == 0 && !rho_errors.empty()) raise(summary.worst_rho_error, rho_errors[i]);
  if (promises_dolp(status)) {
    summary.model_change.add(
        {results.model_change[i], kPointsInAll * results.model_change_dolp[i], status & kModelInaccurate});
  }
}

void add_albedo(RunSummary& summary, double albedo, double theta_deg, double sigma) {
  widen(summary.albedo, summary.albedos++ == 0, {albedo, albedo});
  const EnergyRange here{1, {theta_deg, theta_deg}, {sigma, sigma}};
  if (albedo < kAlbedoMin) add_range(summary.loses, here);
  if (albedo > kAlbedoMax) add_range(summary.gains, here);
}

}  // namespace

void SelfCheck::add(const PointResult& result, const PointResult& again) {
  ++entries;
  const auto difference = [&](Quantity quantity) { return result[quantity] - again[quantity]; };
  if (promises_dolp(result.status)) {
    worst_ratio = std::max(worst_ratio, ratio(difference(Quantity::kDolp),
                                              result[Quantity::kErrorEstimate] + again[Quantity::kErrorEstimate]));
  }
  const double rho = rho_bound(result) + rho_bound(again);
  for (const Quantity quantity : {Quantity::kRhoI, Quantity::kRhoQ, Quantity::kRhoU})
    worst_ratio = std::max(worst_ratio, ratio(difference(quantity), rho));
}

void ModelChange::add(const PointResult& result) {
  if (promises_dolp(result.status))
    add({result.model_change, kPointsInAll * result.model_change_dolp, result.status & kModelInaccurate});
}

void ModelChange::add(const ModelChange& other) {
  i = std::max(i, other.i);
  dolp_points = std::max(dolp_points, other.dolp_points);
  status |= other.status;
}

void SelfCheck::add(const SelfCheck& other) {
  entries += other.entries;
  worst_ratio = std::max(worst_ratio, other.worst_ratio);
}

std::size_t checked_count(std::size_t moments) {
  return std::min(kMostChecked + kMostChecked * (moments / kManyMoments), moments / (kShare * kCostOfOne));
}

std::vector<std::size_t> sample_positions(std::size_t size, std::size_t count, std::uint64_t seed) {
  // Floyd's sampling (Bentley, Comm. ACM 30, 1987). The choice of std::sample depends on the standard library.
  std::mt19937_64 engine(seed);
  std::set<std::size_t> chosen;
  for (std::size_t last = size - std::min(count, size); last < size; ++last) {
    const std::size_t candidate = engine() % (last + 1);
    chosen.insert(chosen.contains(candidate) ? last : candidate);
  }
  return {chosen.begin(), chosen.end()};
}

void RunSummary::add(const SceneValues& scene, const SceneEntries& part, const RunResults& results) {
  std::vector<RunSummary> summaries((results.size() + kSummaryEntriesAtOnce - 1) / kSummaryEntriesAtOnce);
  parallel_ranges(results.size(), kSummaryEntriesAtOnce, [&](std::size_t first, std::size_t last) {
    RunSummary& summary = summaries[first / kSummaryEntriesAtOnce];
    summary.entries = last - first;
    for (std::size_t i = first; i < last; ++i) add_result(summary, results, i);
    const std::vector<double>& albedo_column = results[Quantity::kAlbedo];
    EntryReader reader(part);
    for (std::size_t i = first; i < last && !albedo_column.empty(); ++i) {
      const SceneEntry& entry = reader[i];
      if (!std::isnan(albedo_column[i]))
        add_albedo(summary, albedo_column[i], moment_zenith_deg(scene, entry), entry.shape.sigma);
    }
  });
  for (const RunSummary& summary : summaries) add(summary);
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
  model_change.add(other.model_change);
  check.add(other.check);
  response_basis_s += other.response_basis_s;
  radiometry_s += other.radiometry_s;
  check_s += other.check_s;
  work += other.work;
}

std::size_t RunSummary::count(std::uint32_t bit) const {
  return status[static_cast<std::size_t>(std::ranges::find(kStatusBits, bit, &StatusBit::mask) - kStatusBits.begin())];
}

std::string RunSummary::text() const {
  std::string text;
  for_each_number(*this, [&](const auto& number) {
    if constexpr (requires { number.value_or(-1.0); }) {
      text += fmt::format("{} ", number.value_or(-1.0));
    } else {
      text += fmt::format("{} ", number);
    }
  });
  return text + "end";
}

std::optional<RunSummary> RunSummary::from_text(const std::string& text) {
  RunSummary summary;
  std::istringstream words(text);
  std::string word;
  for_each_number(summary, [&](auto& number) {
    if constexpr (std::is_integral_v<std::remove_reference_t<decltype(number)>>) {
      words >> number;
    } else {
      words >> word;
      const double value = std::strtod(word.c_str(), nullptr);  // strtod also reads "inf"
      const bool is_none = std::is_same_v<decltype(number), std::optional<double>&> && !(value >= 0.0);
      if (!is_none) number = value;
    }
  });
  words >> word;
  return words && word == "end" ? std::optional(summary) : std::nullopt;
}

}  // namespace dolp
