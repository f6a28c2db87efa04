#include "run/drawn_entries.hpp"

#include <cmath>
#include <set>

namespace dolp {
namespace {

// Its multiples modulo 1 fill the interval evenly and do not resonate with the axes of a grid.
constexpr double kGoldenRatio = 0.6180339887498949;

}  // namespace

std::vector<std::size_t> drawn_positions(std::size_t size, std::size_t count) {
  std::set<std::size_t> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = std::fmod(static_cast<double>(i + 1) * kGoldenRatio, 1.0);
    positions.insert(static_cast<std::size_t>(part * static_cast<double>(size)));
  }
  return {positions.begin(), positions.end()};
}

SceneEntries drawn_entries(const SceneEntries& entries, std::size_t count) {
  if (entries.size() <= count) return entries;
  return entries.chosen(drawn_positions(entries.size(), count));
}

}  // namespace dolp
