#include "explore/ticks.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace dolp::explore {
namespace {

constexpr double kRounding = 1e-9;  // of a step: what an end may miss a tick by

std::vector<double> log_ticks_of(double low, double high, std::size_t a_decade) {
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

std::vector<double> linear_ticks(double low, double high, std::size_t most) {
  const double rough = (high - low) / static_cast<double>(most);
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = decade;
  std::vector<double> ticks;
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0}) {
    step = factor * decade;
    const double first = std::ceil(low / step - kRounding);
    const double last = std::floor(high / step + kRounding);
    if (last - first + 1.0 > static_cast<double>(most)) continue;
    for (double i = first; i <= last; i += 1.0) ticks.push_back(i * step + 0.0);
    break;
  }
  return ticks;
}

std::vector<double> log_ticks(double low, double high, std::size_t most) {
  std::vector<double> ticks = log_ticks_of(low, high, 3);
  if (ticks.size() > most) ticks = log_ticks_of(low, high, 1);
  std::vector<double> some;
  const std::size_t stride = (ticks.size() + most - 1) / most;
  for (std::size_t i = 0; i < ticks.size(); i += stride) some.push_back(ticks[i]);
  return some;
}

std::string tick_text(double value) { return fmt::format("{:.4g}", value == 0.0 ? 0.0 : value); }

}  // namespace dolp::explore
