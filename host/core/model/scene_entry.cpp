#include "model/scene_entry.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace dolp {
namespace {

/// A list cut into pieces of at most `most`.
std::vector<std::vector<SceneEntry>> cut(const std::vector<SceneEntry>& list, std::size_t most) {
  std::vector<std::vector<SceneEntry>> pieces;
  for (std::size_t first = 0; first < list.size(); first += most) {
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(first);
    pieces.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(std::min(most, list.size() - first)));
  }
  return pieces;
}

/// Points with the wavelengths that are among them alone.
SceneEntries with_own_wavelengths(std::vector<SceneEntry> points, const std::vector<double>& wavelength_um) {
  if (wavelength_um.empty()) return {std::move(points)};
  constexpr std::uint32_t kUnused = 0xffffffffU;
  std::vector<std::uint32_t> number(wavelength_um.size(), kUnused);
  std::vector<double> own;
  for (SceneEntry& point : points) {
    std::uint32_t& of_wavelength = number[point.wavelength];
    if (of_wavelength == kUnused) {
      of_wavelength = static_cast<std::uint32_t>(own.size());
      own.push_back(wavelength_um[point.wavelength]);
    }
    point.wavelength = of_wavelength;
  }
  return {std::move(points), std::move(own)};
}

// A direction of all wavelengths and indices stays together as long as it can: what it shares is computed once.
constexpr std::array kCuttingOrder = {Axis::kTheta, Axis::kWavelength, Axis::kN, Axis::kK, Axis::kSigma, Axis::kQ};

}  // namespace

PerAxis counts_of(const Grid& grid) {
  PerAxis counts;
  for (std::size_t i = 0; i < kGridAxes.size(); ++i) counts[i] = std::max<std::size_t>((grid.*kGridAxes[i]).size(), 1);
  return counts;
}

std::size_t size_of(const PerAxis& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{1}, std::multiplies<>());
}

SceneEntries SceneEntries::of_grid(Grid grid, const OpticalConstants& index) {
  SceneEntries entries;
  entries.is_grid_ = true;
  entries.counts_ = counts_of(grid);
  if (grid.theta_deg.empty() || grid.sigma.empty() || grid.q.empty()) entries.counts_ = {};
  entries.whole_ = entries.counts_;
  entries.whole_axes_ = std::make_shared<const Grid>(grid);
  entries.grid_ = std::move(grid);
  entries.index_ = index;
  return entries;
}

SceneEntries SceneEntries::grid(std::vector<double> theta_deg, std::vector<double> sigma, std::vector<double> q) {
  return of_grid({std::move(theta_deg), std::move(sigma), std::move(q), {}, {}, {}}, {});
}

PerAxis SceneEntries::place(std::size_t entry) const {
  PerAxis place = {};
  for (std::size_t i = counts_.size(); i-- > 0 && entry > 0;) {
    place[i] = entry % counts_[i];
    entry /= counts_[i];
  }
  return place;
}

OpticalConstants SceneEntries::index_at(const PerAxis& place) const {
  return {grid_.n.empty() ? index_.n : grid_.n[dolp::at(place, Axis::kN)],
          grid_.k.empty() ? index_.k : grid_.k[dolp::at(place, Axis::kK)]};
}

SceneEntry SceneEntries::operator[](std::size_t entry) const {
  if (!is_grid_) return points_[entry];
  const PerAxis at = place(entry);
  SceneEntry result;
  result.theta_deg = grid_.theta_deg[dolp::at(at, Axis::kTheta)];
  result.shape = {grid_.sigma[dolp::at(at, Axis::kSigma)], grid_.q[dolp::at(at, Axis::kQ)]};
  if (has_own_index()) result.index = index_at(at);
  result.wavelength = static_cast<std::uint32_t>(dolp::at(at, Axis::kWavelength));
  return result;
}

SceneEntries SceneEntries::part(const PerAxis& first, const PerAxis& count) const {
  SceneEntries part;
  part.is_grid_ = true;
  part.index_ = index_;
  part.counts_ = count;
  part.whole_ = whole_;
  part.whole_axes_ = whole_axes_;
  for (std::size_t i = 0; i < kGridAxes.size(); ++i) {
    part.first_[i] = first_[i] + first[i];
    const std::vector<double>& values = grid_.*kGridAxes[i];
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first[i]);
    if (!values.empty()) part.grid_.*kGridAxes[i] = {begin, begin + static_cast<std::ptrdiff_t>(count[i])};
  }
  return part;
}

std::optional<std::size_t> SceneEntries::position_of(std::size_t in_whole) const {
  PerAxis place = {};
  for (std::size_t i = whole_.size(); i-- > 0; in_whole /= whole_[i]) place[i] = in_whole % whole_[i];
  std::size_t position = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < first_[i] || place[i] >= first_[i] + counts_[i]) return std::nullopt;
    position = position * counts_[i] + place[i] - first_[i];
  }
  return position;
}

std::vector<SceneEntries> SceneEntries::parts(std::size_t most) const {
  if (empty()) return {};
  if (size() <= most) return {*this};
  std::vector<SceneEntries> parts;
  if (!is_grid_) {
    for (std::vector<SceneEntry>& points : cut(points_, most))
      parts.push_back(with_own_wavelengths(std::move(points), wavelength_um()));
    return parts;
  }
  const std::function<void(PerAxis, PerAxis, std::size_t)> cut_along = [&](PerAxis first, PerAxis count,
                                                                           std::size_t number) {
    const auto axis = static_cast<std::size_t>(kCuttingOrder[number]);
    const std::size_t of_one = size_of(count) / count[axis];
    const std::size_t fit = std::clamp<std::size_t>(most / of_one, 1, count[axis]);
    const std::size_t all = count[axis];
    for (std::size_t i = 0; i < all; i += fit) {
      first[axis] = i;
      count[axis] = std::min(fit, all - i);
      if (of_one > most && number + 1 < kCuttingOrder.size()) {
        cut_along(first, count, number + 1);
      } else {
        parts.push_back(part(first, count));
      }
    }
  };
  cut_along({}, counts_, 0);
  return parts;
}

void for_each_run(const PerAxis& first, const PerAxis& count, const PerAxis& whole,
                  const std::function<void(const GridRun&)>& use) {
  // A run goes over the fastest axes that the part has in full, and one more.
  std::size_t slowest = count.size() - 1;
  while (slowest > 0 && count[slowest] == whole[slowest]) --slowest;
  const auto from = static_cast<std::ptrdiff_t>(slowest);
  const std::size_t of_run = std::accumulate(count.begin() + from, count.end(), std::size_t{1}, std::multiplies<>());
  const std::size_t runs = size_of(count) / of_run;
  for (std::size_t run = 0; run < runs; ++run) {
    PerAxis at = first;
    for (std::size_t i = slowest, rest = run; i-- > 0;) {
      at[i] += rest % count[i];
      rest /= count[i];
    }
    std::size_t in_whole = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) in_whole = in_whole * whole[i] + at[i];
    use({run * of_run, in_whole, of_run});
  }
}

}  // namespace dolp
