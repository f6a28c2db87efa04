#include "explore/contours.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "explore/ticks.hpp"

namespace dolp::explore {
namespace {

struct Crossing {
  double x, y;
};

/// Corners of a square in turn, as offsets.
constexpr std::array<std::pair<std::size_t, std::size_t>, 4> kCorners = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

}  // namespace

std::vector<double> contour_levels(double low, double high, bool is_log) {
  constexpr std::size_t kMostLines = 7;
  if (!(low < high)) return {};
  return is_log ? log_ticks(low, high, kMostLines) : linear_ticks(low, high, kMostLines);
}

std::vector<Segment> contour(const MapField& field, double level) {
  std::vector<Segment> segments;
  const double last = static_cast<double>(field.count) - 1.0;
  for (std::size_t row = 0; row + 1 < field.count; ++row) {
    for (std::size_t column = 0; column + 1 < field.count; ++column) {
      std::array<double, 4> value{};
      bool good = true;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = (row + kCorners[i].second) * field.count + column + kCorners[i].first;
        value[i] = field.values[at] - level;
        good = good && field.is_good[at] != 0;
      }
      if (!good) continue;
      std::vector<Crossing> crossings;
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        if ((value[i] < 0.0) == (value[j] < 0.0)) continue;
        const double part = value[i] / (value[i] - value[j]);
        const auto between = [&](std::size_t a, std::size_t b) {
          return static_cast<double>(a) + part * (static_cast<double>(b) - static_cast<double>(a));
        };
        crossings.push_back({(static_cast<double>(column) + between(kCorners[i].first, kCorners[j].first)) / last,
                             (static_cast<double>(row) + between(kCorners[i].second, kCorners[j].second)) / last});
      }
      // Two crossings, or four around a saddle, joined in turn.
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        segments.push_back({crossings[i].x, crossings[i].y, crossings[i + 1].x, crossings[i + 1].y});
      }
    }
  }
  return segments;
}

}  // namespace dolp::explore
