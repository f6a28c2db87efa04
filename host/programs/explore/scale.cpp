#include "explore/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dolp::explore {
namespace {

constexpr double kRounding = 1e-9;  // relative tolerance: rounding errors may move a tick beyond the end of the range

std::vector<double> linear_ticks(double low, double high, std::size_t most) {
  const double rough = (high - low) / static_cast<double>(most);
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  std::vector<double> ticks;
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0}) {
    const double step = factor * decade;
    const double first = std::ceil(low / step - kRounding);
    const double count = std::floor(high / step + kRounding) - first + 1.0;
    if (!(count <= static_cast<double>(most))) continue;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      ticks.push_back((first + static_cast<double>(i)) * step + 0.0);
    break;
  }
  return ticks;
}

std::vector<double> log_ticks(double low, double high, std::size_t a_decade) {
  constexpr std::array kFactors = {1.0, 2.0, 5.0};
  std::vector<double> ticks;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (int decade = first; decade <= last; ++decade) {
    for (std::size_t i = 0; i < a_decade; ++i) {
      const double tick = kFactors[i] * std::pow(10.0, decade);
      if (tick >= low * (1.0 - kRounding) && tick <= high * (1.0 + kRounding)) ticks.push_back(tick);
    }
  }
  return ticks;
}

}  // namespace

std::string Scale::refusal() const {
  constexpr double kLeastSpan = 1e-9;  // least (to - from)/max(|from|, |to|); rounding errors spoil shorter axes
  if (!std::isfinite(to - from)) return "must be finite";
  if (!(from < to)) return "must be from < to";
  if (is_log && from <= 0.0) return "must be above 0 on a logarithmic axis";
  if (to - from < kLeastSpan * std::max(std::abs(from), std::abs(to)))
    return "must differ by more than 1e-9 of the ends";
  return {};
}

double Scale::value(double position) const {
  if (position == 1.0) return to;
  return is_log ? from * std::pow(to / from, position) : from + position * (to - from);
}

double Scale::rounded(double position) const {
  const double exact = value(position);
  // Rounds to four digits, so that saved scenes have short numbers.
  if (exact == 0.0) return exact;
  const double digit = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(exact))));
  return clamp(std::round(exact * digit) / digit);
}

std::vector<double> Scale::values(std::size_t count) const {
  std::vector<double> all(count, from);
  const double last = static_cast<double>(count - 1);
  for (std::size_t i = 1; i < count; ++i) {
    const double done = static_cast<double>(i);
    all[i] =
        is_log ? value(done / last) : ((last - done) * from + done * to) / last;  // gives 13, not 12.999999999999998
  }
  return all;
}

Scale Scale::with_log(bool wants_log) const {
  constexpr double kLeastPart = 1.0 / 180.0;
  return {wants_log && from <= 0.0 ? kLeastPart * to : from, to, wants_log};
}

std::vector<double> Scale::ticks(std::size_t most) const {
  if (!is_log) return linear_ticks(from, to, most);
  std::vector<double> all = log_ticks(from, to, 3);
  if (all.size() < 3) return linear_ticks(from, to, most);  // the range is shorter than a decade
  if (all.size() > most) all = log_ticks(from, to, 1);
  std::vector<double> some;
  const std::size_t stride = (all.size() + most - 1) / most;
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

Scale value_scale(std::vector<double> values, bool is_log) {
  std::erase_if(values, [&](double value) { return !std::isfinite(value) || (is_log && value <= 0.0); });
  if (values.empty()) values = {is_log ? 0.01 : 0.0, 1.0};
  if (!is_log) values.push_back(0.0);
  const auto [low, high] = std::ranges::minmax(values);
  if (is_log) {
    constexpr double kMostDecades = 1e6;
    constexpr double kRoom = 4.0;  // the axis ends at kRoom * largest value, so that a mark fits above the maximum
    return {std::max(low / 1.5, kRoom * high / kMostDecades), kRoom * high, true};
  }
  const double room = 0.06 * std::max(high - low, 1e-9);
  const Scale range{low < 0.0 ? low - room : 0.0, high > 0.0 ? high + 2.0 * room : 0.0};
  return range.to > range.from ? range : Scale{range.from, range.from + 1.0};
}

std::string tick_text(double value) { return fmt::format("{:.4g}", value == 0.0 ? 0.0 : value); }

}  // namespace dolp::explore
